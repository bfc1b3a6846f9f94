// SPDX-License-Identifier: Apache-2.0
// The lights of the river: the lane that the boat should be in, floating lanterns on both of its edges, and lanterns that rise to the sky.
import {
  BufferAttribute, BufferGeometry, CanvasTexture, Color, CylinderGeometry, DoubleSide, Group, InstancedMesh, Matrix4, Mesh, MeshBasicMaterial,
  Quaternion, ShaderMaterial, Sprite, SpriteMaterial, Vector3, type Texture,
} from "three";

const kNear = 2.4; // ends of the lane along the river, from the boat [m]
const kFar = -17;
const kSegments = 56;
const kPairs = 6; // of floating lanterns
const kSpacing = 3.6;
const kRise = 7; // time that a lantern takes to its place in the sky [s]

/// Middle and half width of the lane at a distance from the boat; negative is ahead.
export type Lane = (z: number) => { readonly x: number; readonly half: number };

function glowTexture(): Texture | null {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 64;
  const pen = canvas.getContext("2d");
  if (!pen) return null;
  const glow = pen.createRadialGradient(32, 32, 0, 32, 32, 32);
  glow.addColorStop(0, "rgba(255,238,196,1)");
  glow.addColorStop(0.22, "rgba(255,214,140,0.62)");
  glow.addColorStop(0.55, "rgba(255,190,104,0.2)");
  glow.addColorStop(1, "rgba(255,180,90,0)");
  pen.fillStyle = glow;
  pen.fillRect(0, 0, 64, 64);
  return new CanvasTexture(canvas);
}

const laneVertex = `
attribute vec2 place;
varying vec2 at;
void main() { at = place; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }`;
const laneFragment = `
varying vec2 at;
uniform float strength; uniform float inside; uniform float time; uniform vec3 colour; uniform float contrast;
void main() {
  float across = abs(at.x);
  float ends = smoothstep(0.0, 0.12, at.y) * smoothstep(1.0, 0.55, at.y);
  float pool = mix(0.34, 0.62, inside) * (0.82 + 0.18 * cos(1.57 * across));
  float edge = smoothstep(0.80, 0.93, across) * smoothstep(1.0, 0.96, across);
  float shimmer = 0.94 + 0.06 * sin(40.0 * at.y + 1.3 * time + 5.0 * at.x);
  float a = strength * ends * shimmer * (pool * smoothstep(1.0, 0.9, across) + edge * mix(0.75, 0.95, inside));
  gl_FragColor = vec4(mix(colour, vec3(1.0, 0.97, 0.86), 0.45 * edge + 0.35 * inside * (1.0 - across)), a * mix(1.0, 1.25, contrast));
}`;

interface Rising {
  readonly sprite: Sprite;
  readonly from: Vector3;
  readonly to: Vector3;
  age: number; // [s]
}

export class RiverLights {
  readonly group = new Group();
  private readonly lane: Mesh<BufferGeometry, ShaderMaterial>;
  private readonly bodies: InstancedMesh;
  private readonly glows: Sprite[] = [];
  private readonly shines: Sprite[] = [];
  private readonly glow = glowTexture();
  private readonly glowMaterial: SpriteMaterial;
  private readonly skyMaterial: SpriteMaterial;
  private readonly rising: Rising[] = [];
  private strength = 0;
  private inside = 0;

  constructor() {
    const lane = new BufferGeometry();
    lane.setAttribute("position", new BufferAttribute(new Float32Array(6 * (kSegments + 1)), 3));
    lane.setAttribute("place", new BufferAttribute(Float32Array.from({ length: 4 * (kSegments + 1) }, (_, i) => (i % 2 === 0 ? (i % 4 === 0 ? -1 : 1) : Math.floor(i / 4) / kSegments)), 2));
    lane.setIndex(Array.from({ length: kSegments }, (_, i) => [2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 1, 2 * i + 3, 2 * i + 2]).flat());
    this.lane = new Mesh(
      lane,
      new ShaderMaterial({
        vertexShader: laneVertex, fragmentShader: laneFragment, transparent: true, depthWrite: false, side: DoubleSide,
        uniforms: { strength: { value: 0 }, inside: { value: 0 }, time: { value: 0 }, contrast: { value: 0 }, colour: { value: new Vector3(1, 0.83, 0.52) } },
      }),
    );
    this.lane.frustumCulled = false;
    this.lane.renderOrder = 1;
    this.bodies = new InstancedMesh(new CylinderGeometry(0.15, 0.12, 0.3, 8), new MeshBasicMaterial({ color: new Color("#ffdf9e"), transparent: true }), 2 * kPairs);
    this.bodies.frustumCulled = false;
    this.bodies.renderOrder = 4;
    const sprite = (opacity: number) => new SpriteMaterial({ map: this.glow, depthWrite: false, transparent: true, opacity, fog: false });
    this.glowMaterial = sprite(0.8);
    this.skyMaterial = sprite(0.95);
    for (let i = 0; i < 2 * kPairs; ++i) {
      const [glow, shine] = [new Sprite(this.glowMaterial), new Sprite(this.glowMaterial)];
      glow.scale.setScalar(1.15);
      shine.scale.set(0.7, 0.9, 1);
      glow.renderOrder = shine.renderOrder = 5;
      this.glows.push(glow);
      this.shines.push(shine);
    }
    this.group.add(this.lane, this.bodies, ...this.glows, ...this.shines);
  }

  /// @param on      the lane is to be followed  @param inside  the boat is in it  @param z  of the boat  @param travel  of the river [m]
  show(lane: Lane, on: boolean, inside: boolean, boatZ: number, travel: number, time: number, dt: number, contrast: boolean): void {
    // Both change slowly, so that a boat at the edge makes no flicker.
    this.strength += (Number(on) - this.strength) * (1 - Math.exp(-dt / 0.5));
    this.inside += (Number(on && inside) - this.inside) * (1 - Math.exp(-dt / 0.55));
    const { uniforms } = this.lane.material;
    Object.assign(uniforms["strength"]!, { value: this.strength });
    Object.assign(uniforms["inside"]!, { value: this.inside });
    Object.assign(uniforms["time"]!, { value: time });
    Object.assign(uniforms["contrast"]!, { value: Number(contrast) });
    this.group.visible = this.strength > 0.01 || this.rising.length > 0;
    this.lane.visible = this.strength > 0.01;
    const position = this.lane.geometry.getAttribute("position") as BufferAttribute;
    for (let i = 0; i <= kSegments; ++i) {
      const z = kNear + ((kFar - kNear) * i) / kSegments;
      const { x, half } = lane(z);
      position.setXYZ(2 * i, x - half, 0.03, boatZ + z);
      position.setXYZ(2 * i + 1, x + half, 0.03, boatZ + z);
    }
    position.needsUpdate = true;
    const [matrix, at, turn, size] = [new Matrix4(), new Vector3(), new Quaternion(), new Vector3()];
    for (let pair = 0; pair < kPairs; ++pair) {
      const z = kNear - 1 - ((((pair * kSpacing - travel) % (kPairs * kSpacing)) + kPairs * kSpacing) % (kPairs * kSpacing));
      const fade = this.strength * Math.min(1, Math.max(0, (kNear - 1 - z) / 1.6)) * Math.min(1, Math.max(0, (z - kFar + 1) / 4));
      const { x, half } = lane(z);
      for (const side of [0, 1]) {
        const i = 2 * pair + side;
        const bob = 0.03 * Math.sin(1.4 * time + 2.1 * i);
        at.set(x + (side === 0 ? -1 : 1) * (half + 0.16), 0.16 + bob, boatZ + z);
        this.bodies.setMatrixAt(i, matrix.compose(at, turn, size.setScalar(Math.max(1e-3, fade))));
        this.glows[i]!.position.copy(at);
        this.glows[i]!.scale.setScalar(1.3 * fade + 1e-3);
        this.shines[i]!.position.set(at.x, -0.12, at.z);
        this.shines[i]!.scale.set(0.5 * fade + 1e-3, 0.9 * fade + 1e-3, 1);
      }
    }
    this.bodies.instanceMatrix.needsUpdate = true;
    for (const one of this.rising) {
      one.age += dt;
      const share = Math.min(1, one.age / kRise);
      const eased = 1 - (1 - share) ** 3;
      one.sprite.position.lerpVectors(one.from, one.to, eased);
      one.sprite.position.x += 0.35 * Math.sin(0.5 * one.age + one.to.x) * eased;
      one.sprite.scale.setScalar((1.1 + 0.6 * eased) * Math.min(1, one.age / 0.8));
    }
  }

  /// A lantern rises from the boat to its place among the others. @param count  lanterns that are there with it  @param at once  without the way
  rise(count: number, from: Vector3, atOnce = false): void {
    const sprite = new Sprite(this.skyMaterial);
    const golden = (count * 0.618034) % 1;
    const to = new Vector3(-15 + 30 * golden, 6.6 + 4.4 * ((count * 0.41421) % 1), -26 - 6 * ((count * 0.7321) % 1));
    sprite.renderOrder = 6;
    this.rising.push({ sprite, from: from.clone(), to, age: atOnce ? kRise : 0 });
    this.group.add(sprite);
  }

  get risen(): number {
    return this.rising.length;
  }

  dispose(): void {
    this.lane.geometry.dispose();
    this.lane.material.dispose();
    this.bodies.geometry.dispose();
    (this.bodies.material as MeshBasicMaterial).dispose();
    this.bodies.dispose();
    this.glowMaterial.dispose();
    this.skyMaterial.dispose();
    this.glow?.dispose();
  }
}
