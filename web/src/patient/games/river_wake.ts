// SPDX-License-Identifier: Apache-2.0
// What the boat leaves on the water: two faint lines that part behind it, along the way it has come.
import { BufferAttribute, BufferGeometry, DoubleSide, Mesh, ShaderMaterial } from "three";

const kPoints = 40;
const kSpacing = 0.22; // between two points of the way [m]
const kSpread = 0.16; // of the lines, sideways for each metre behind

const vertexShader = `
attribute vec2 place;
varying vec2 at;
void main() { at = place; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }`;
const fragmentShader = `
varying vec2 at;
uniform float strength;
void main() {
  float line = smoothstep(0.0, 0.5, at.x) * smoothstep(1.0, 0.5, at.x);
  gl_FragColor = vec4(1.0, 1.0, 1.0, 0.42 * strength * line * (1.0 - at.y) * smoothstep(0.0, 0.08, at.y));
}`;

export class Wake {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  private readonly way: { x: number; travel: number }[] = []; // the newest first

  constructor() {
    const geometry = new BufferGeometry();
    const count = 4 * kPoints;
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(3 * count), 3));
    geometry.setAttribute("place", new BufferAttribute(Float32Array.from({ length: 2 * count }, (_, i) => (i % 2 === 0 ? (i / 2) % 2 : Math.floor(i / 8) / (kPoints - 1))), 2));
    const strip = (line: number) => Array.from({ length: kPoints - 1 }, (_, i) => {
      const a = 4 * i + 2 * line;
      return [a, a + 1, a + 4, a + 1, a + 5, a + 4];
    }).flat();
    geometry.setIndex([...strip(0), ...strip(1)]);
    this.mesh = new Mesh(geometry, new ShaderMaterial({ vertexShader, fragmentShader, transparent: true, depthWrite: false, side: DoubleSide, uniforms: { strength: { value: 1 } } }));
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 1;
  }

  /// @param x, z  of the stern  @param travel  of the river  @param speed  [m/s]
  show(x: number, z: number, travel: number, speed: number): void {
    const newest = this.way[0];
    if (!newest || travel - newest.travel >= kSpacing) {
      this.way.unshift({ x, travel });
      if (this.way.length > kPoints) this.way.pop();
    }
    Object.assign(this.mesh.material.uniforms["strength"]!, { value: Math.min(1, speed / 2) });
    const position = this.mesh.geometry.getAttribute("position") as BufferAttribute;
    for (let i = 0; i < kPoints; ++i) {
      const point = i === 0 ? { x, travel } : (this.way[i - 1] ?? this.way.at(-1)!);
      const behind = travel - point.travel;
      const apart = 0.3 + kSpread * behind;
      const wide = 0.1 + 0.05 * behind;
      for (const line of [0, 1]) {
        const middle = point.x + (line === 0 ? -apart : apart);
        position.setXYZ(4 * i + 2 * line, middle - wide, 0.02, z + behind);
        position.setXYZ(4 * i + 2 * line + 1, middle + wide, 0.02, z + behind);
      }
    }
    position.needsUpdate = true;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}
