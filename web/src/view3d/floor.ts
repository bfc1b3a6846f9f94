// SPDX-License-Identifier: Apache-2.0
// A disc under the object that fades out: a faint grid of 5 cm, the painted shadow of what stands on it, and the key light's shadow.
import { Box3, BufferGeometry, CircleGeometry, Color, Group, Mesh, ShaderMaterial, ShadowMaterial, Vector3, Vector4 } from "three";
import type { Theme } from "../theme";

const kBelow = 0.0006; // of the object's lowest point [m]
const kStands = 0.012; // what of the object is within this height of its lowest point throws the painted shadow [m]
const kRadius = 0.42; // [m]

const vertexShader = `
varying vec2 vPlace;
varying vec2 vDisc;
void main() {
  vDisc = position.xy;
  vec4 place = modelMatrix * vec4(position, 1.0);
  vPlace = place.xy;
  gl_Position = projectionMatrix * viewMatrix * place;
}`;

const fragmentShader = `
uniform vec3 ground;
uniform vec3 line;
uniform vec4 blot; // centre x y and radii of what stands here
uniform float darkness;
varying vec2 vPlace;
varying vec2 vDisc;
void main() {
  float radius = length(vDisc);
  float fade = 1.0 - smoothstep(0.25, 1.0, radius);
  vec2 cell = vPlace / 0.05;
  vec2 width = fwidth(cell);
  vec2 near = abs(fract(cell - 0.5) - 0.5) / max(width, 1e-6);
  float onLine = (1.0 - min(min(near.x, near.y), 1.0)) * (1.0 - smoothstep(0.15, 0.5, max(width.x, width.y)));
  vec3 colour = mix(ground, line, 0.55 * onLine);
  float out2 = dot((vPlace - blot.xy) / blot.zw, (vPlace - blot.xy) / blot.zw);
  float shadow = darkness * exp(-0.9 * out2);
  gl_FragColor = vec4(colour * (1.0 - shadow), fade * max(0.92, shadow));
  #include <colorspace_fragment>
}`;

export class Floor {
  readonly group = new Group();
  private readonly disc = new CircleGeometry(1, 96);
  private readonly ground = new Color();
  private readonly line = new Color();
  private readonly blot = new Vector4(0, 0, 1, 1);
  private readonly darkness = { value: 0.5 };
  private readonly paint: ShaderMaterial;
  private readonly shadow = new ShadowMaterial({ opacity: 0.3, depthWrite: false });

  constructor() {
    this.paint = new ShaderMaterial({
      vertexShader,
      fragmentShader,
      uniforms: { ground: { value: this.ground }, line: { value: this.line }, blot: { value: this.blot }, darkness: this.darkness },
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
        .replace("#include <tonemapping_fragment>", "gl_FragColor.a *= 1.0 - smoothstep(0.25, 1.0, length(vDisc));");
    };
    this.group.add(painted, caught);
  }

  /// Under an object; without one under the hand, and without either it is not there.
  standUnder(object: BufferGeometry | null, hand: Box3): void {
    const box = object?.boundingBox ?? hand;
    this.group.visible = !box.isEmpty();
    if (!this.group.visible) return;
    const centre = box.getCenter(new Vector3());
    const size = box.getSize(new Vector3());
    this.group.position.set(centre.x, centre.y, box.min.z - (object ? kBelow : 0.02));
    this.group.scale.set(1, 1, 1).multiplyScalar(Math.max(kRadius, 1.6 * Math.max(size.x, size.y)));
    this.darkness.value = object ? 0.55 : 0;
    if (object) this.paintShadow(object, box);
  }

  setTheme(theme: Theme, dark: boolean): void {
    this.ground.set(theme.floor);
    this.line.set(theme.grid);
    this.shadow.opacity = dark ? 0.42 : 0.24;
  }

  dispose(): void {
    this.disc.dispose();
    this.paint.dispose();
    this.shadow.dispose();
  }

  private paintShadow(object: BufferGeometry, box: Box3): void {
    const stands = new Box3();
    const point = new Vector3();
    const position = object.getAttribute("position");
    for (let i = 0; i < position.count; ++i) {
      point.fromBufferAttribute(position, i);
      if (point.z < box.min.z + kStands) stands.expandByPoint(point);
    }
    const centre = stands.getCenter(new Vector3());
    const size = stands.getSize(new Vector3());
    this.blot.set(centre.x, centre.y, 0.55 * size.x + 0.008, 0.55 * size.y + 0.008);
  }
}
