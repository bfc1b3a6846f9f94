// SPDX-License-Identifier: Apache-2.0
// The room that lights the scene and is mirrored in it: a bright ceiling with two lamps, walls, and a table's warm shine from below. It
// exists as a texture of the renderer, blurred for each roughness.
import {
  BackSide, Color, DoubleSide, Mesh, MeshBasicMaterial, PlaneGeometry, PMREMGenerator, Scene, ShaderMaterial, SphereGeometry, Vector3,
} from "three";
import type { Texture, WebGLRenderer, WebGLRenderTarget } from "three";

const kBlur = 0.035; // [rad]

interface Lamp {
  readonly at: readonly [number, number, number];
  readonly width: number;
  readonly height: number;
  readonly shine: number;
}
const kLamps: readonly Lamp[] = [
  { at: [-3, -2.4, 4.6], width: 3.2, height: 2.2, shine: 9 },
  { at: [4.4, 2, 2.6], width: 1.2, height: 3.6, shine: 4 },
  { at: [0.5, 4.8, 1.8], width: 3.4, height: 1, shine: 2.2 },
];

const vertexShader = `
varying vec3 vDirection;
void main() {
  vDirection = position;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;
const fragmentShader = `
uniform vec3 above;
uniform vec3 around;
uniform vec3 below;
varying vec3 vDirection;
void main() {
  float up = normalize(vDirection).z;
  gl_FragColor = vec4(up > 0.0 ? mix(around, above, smoothstep(0.0, 0.8, up)) : mix(around, below, smoothstep(0.0, 0.35, -up)), 1.0);
}`;

export class Surroundings {
  private target: WebGLRenderTarget | null = null;

  /// Made once for a renderer, and again after `release`.
  texture(renderer: WebGLRenderer): Texture {
    this.target ??= drawn(renderer);
    return this.target.texture;
  }

  release(): void {
    this.target?.dispose();
    this.target = null;
  }
}

function drawn(renderer: WebGLRenderer): WebGLRenderTarget {
  const room = new Scene();
  const walls = new ShaderMaterial({
    vertexShader, fragmentShader, side: BackSide, depthWrite: false,
    uniforms: { above: { value: new Color(0.95, 0.98, 1.05) }, around: { value: new Color(0.42, 0.44, 0.48) }, below: { value: new Color(0.5, 0.45, 0.4) } },
  });
  const sphere = new SphereGeometry(8, 32, 24);
  const pane = new PlaneGeometry(1, 1);
  room.add(new Mesh(sphere, walls));
  const lamps = kLamps.map(({ at, width, height, shine }) => {
    const glow = new MeshBasicMaterial({ color: new Color(shine, shine * 0.97, shine * 0.92), side: DoubleSide });
    const lamp = new Mesh(pane, glow);
    lamp.position.set(...at);
    lamp.up.set(0, 0, 1);
    lamp.lookAt(new Vector3());
    lamp.scale.set(width, height, 1);
    room.add(lamp);
    return glow;
  });
  const generator = new PMREMGenerator(renderer);
  const target = generator.fromScene(room, kBlur, 0.1, 20);
  generator.dispose();
  for (const one of [sphere, pane, walls, ...lamps]) one.dispose();
  return target;
}
