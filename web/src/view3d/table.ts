// SPDX-License-Identifier: Apache-2.0
// A table top of wood that fades into the background, with the shadows of hand and object on it.
import {
  CircleGeometry, Color, DataTexture, Group, LinearFilter, LinearMipmapLinearFilter, Mesh, RedFormat, RepeatWrapping,
  ShaderMaterial, ShadowMaterial, Vector3,
} from "three";
import type { Box3 } from "three";
import type { Theme } from "../theme";
import { ContactShadow } from "./contact_shadow";
import type { Capsule } from "./object_material";
import { kShadowEdge, squareAround, type Underside } from "./underside";

const kBelow = 0.0006; // of the object's lowest point [m]
const kClear = 0.012; // below a hand that reaches lower than the object [m]
const kRadius = 0.46; // [m]
const kGrain = 256; // texels of the wood, a square
const kGrainLength = 0.55; // of that square [m]
const kMoved = 0.0005; // of the hand before its shadow is cast again [m]

const vertexShader = `
varying vec2 vPlace;
varying vec2 vDisc;
uniform vec3 square;
varying vec2 vShadow;
void main() {
  vDisc = position.xy;
  vec4 place = modelMatrix * vec4(position, 1.0);
  vPlace = place.xy;
  vShadow = (place.xy - square.xy) / square.z;
  gl_Position = projectionMatrix * viewMatrix * place;
}`;

const fragmentShader = `
uniform vec3 ground;
uniform sampler2D shadows;
varying vec2 vDisc;
varying vec2 vShadow;
#ifdef GRAIN
uniform sampler2D grain;
varying vec2 vPlace;
#endif
void main() {
  float far = dot(vDisc, vDisc);
  float fade = 1.0 - smoothstep(0.12, 1.0, far);
  vec3 colour = ground;
  #ifdef GRAIN
  colour *= 0.9 + 0.2 * texture2D(grain, vPlace.yx * ${(1 / kGrainLength).toFixed(3)}).r;
  #endif
  colour *= 1.0 - texture2D(shadows, vShadow).r;
  gl_FragColor = vec4(colour, fade);
  #include <colorspace_fragment>
}`;

export class Table {
  readonly group = new Group();
  private readonly disc = new CircleGeometry(1, 96);
  private readonly ground = new Color();
  private readonly square = new Vector3(0, 0, 1);
  private readonly contact = new ContactShadow();
  private readonly shadows = new DataTexture(this.contact.texels, kShadowEdge, kShadowEdge, RedFormat);
  private readonly grain = new DataTexture(grainTexels(), kGrain, kGrain, RedFormat);
  private readonly paint: ShaderMaterial;
  private readonly shadow = new ShadowMaterial({ opacity: 0.3, depthWrite: false });
  private cast: readonly Capsule[] = [];

  constructor() {
    this.shadows.magFilter = this.shadows.minFilter = LinearFilter;
    this.grain.wrapS = this.grain.wrapT = RepeatWrapping;
    this.grain.magFilter = LinearFilter;
    this.grain.minFilter = LinearMipmapLinearFilter;
    this.grain.generateMipmaps = true;
    this.grain.needsUpdate = true;
    this.paint = new ShaderMaterial({
      vertexShader,
      fragmentShader,
      uniforms: { ground: { value: this.ground }, square: { value: this.square }, shadows: { value: this.shadows }, grain: { value: this.grain } },
      transparent: true,
      depthWrite: false,
    });
    const painted = new Mesh(this.disc, this.paint);
    painted.renderOrder = -2;
    const caught = new Mesh(this.disc, this.shadow);
    caught.receiveShadow = true;
    caught.renderOrder = -1;
    caught.position.z = 1e-4;
    this.shadow.onBeforeCompile = (shader) => {
      shader.vertexShader = shader.vertexShader
        .replace("#include <common>", "#include <common>\nvarying vec2 vDisc;")
        .replace("#include <begin_vertex>", "#include <begin_vertex>\nvDisc = position.xy;");
      shader.fragmentShader = shader.fragmentShader
        .replace("#include <common>", "#include <common>\nvarying vec2 vDisc;")
        .replace("#include <tonemapping_fragment>", "gl_FragColor.a *= 1.0 - smoothstep(0.12, 1.0, dot(vDisc, vDisc));");
    };
    this.group.add(painted, caught);
  }

  /// Under an object; without one under the hand, and without either there is no table. A hand that reaches below the object's foot
  /// would go through the table: then it is below the hand.
  /// @param foot  the object's box  @param underside  of the object  @param hand  what the hand has reached so far
  standUnder(foot: Box3 | null, underside: Underside | null, hand: Box3): void {
    const box = foot ?? hand;
    this.group.visible = !box.isEmpty();
    if (!this.group.visible) return;
    const centre = box.getCenter(new Vector3());
    const size = box.getSize(new Vector3());
    const stands = foot !== null && (hand.isEmpty() || hand.min.z >= foot.min.z - kBelow);
    const height = stands ? foot.min.z - kBelow : (hand.isEmpty() ? box : hand).min.z - kClear;
    this.group.position.set(centre.x, centre.y, height);
    this.group.scale.set(1, 1, 1).multiplyScalar(Math.max(kRadius, 1.8 * Math.max(size.x, size.y)));
    const square = underside?.square ?? squareAround(box);
    this.square.set(square.x, square.y, square.edge);
    this.contact.lay(square, height, underside?.lowest ?? null);
    this.cast = [];
    this.shadows.needsUpdate = true;
  }

  /// The lowest place that is not inside the table [m]; -Infinity: there is none.
  get height(): number {
    return this.group.visible ? this.group.position.z : -Infinity;
  }

  castHand(hand: readonly Capsule[]): void {
    if (!this.group.visible || !hasMoved(this.cast, hand)) return;
    this.cast = hand;
    this.contact.cast(hand);
    this.shadows.needsUpdate = true;
  }

  setTheme(theme: Theme, dark: boolean): void {
    this.ground.set(theme.table);
    this.shadow.opacity = dark ? 0.5 : 0.3;
  }

  setGrain(on: boolean): void {
    if (on === ("GRAIN" in this.paint.defines)) return;
    this.paint.defines = on ? { GRAIN: "" } : {};
    this.paint.needsUpdate = true;
  }

  dispose(): void {
    this.disc.dispose();
    this.paint.dispose();
    this.shadow.dispose();
    this.shadows.dispose();
    this.grain.dispose();
  }
}

function hasMoved(before: readonly Capsule[], now: readonly Capsule[]): boolean {
  if (before.length !== now.length) return true;
  const away = (a: Capsule["from"], b: Capsule["from"]): number => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  return now.some((capsule, i) => away(capsule.from, before[i]!.from) > kMoved || away(capsule.to, before[i]!.to) > kMoved);
}

let wood: Uint8Array | undefined; // the same for every table

/// Wood along the second axis: long fibres over broad, wavy bands. The square joins itself at its borders.
function grainTexels(): Uint8Array {
  if (wood) return wood;
  wood = new Uint8Array(kGrain * kGrain);
  const layers = [{ of: lattice(128, 8, 1), share: 0.3 }, { of: lattice(64, 4, 2), share: 0.25 }, { of: lattice(16, 2, 3), share: 0.2 }];
  const bend = lattice(4, 4, 4);
  for (let i = 0; i < wood.length; ++i) {
    const [column, row] = [i % kGrain, Math.floor(i / kGrain)];
    const wave = 0.5 + 0.5 * Math.sin(2 * Math.PI * ((9 * column) / kGrain + 1.3 * bend(column, row)));
    let value = 0.25 * wave;
    for (const { of, share } of layers) value += share * of(column, row);
    wood[i] = Math.round(255 * value);
  }
  return wood;
}

/// Values of a lattice over the square that repeats, smooth between its points.
function lattice(columns: number, rows: number, seed: number): (column: number, row: number) => number {
  const values = Float32Array.from({ length: columns * rows }, (_, i) => {
    const hash = Math.imul((i + 1) * 374761393 + seed * 668265263, 1274126177);
    return (Math.imul(hash ^ (hash >>> 15), 2246822519) >>> 0) / 4294967296;
  });
  const ease = (t: number): number => t * t * (3 - 2 * t);
  return (column, row) => {
    const [x, y] = [(column * columns) / kGrain, (row * rows) / kGrain];
    const [i, j] = [Math.floor(x), Math.floor(y)];
    const [s, t] = [ease(x - i), ease(y - j)];
    const [right, down] = [(i + 1) % columns, ((j + 1) % rows) * columns];
    const above = values[j * columns + i]! * (1 - s) + values[j * columns + right]! * s;
    return above * (1 - t) + (values[down + i]! * (1 - s) + values[down + right]! * s) * t;
  };
}
