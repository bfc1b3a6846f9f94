// SPDX-License-Identifier: Apache-2.0
// The object: matte; darker where fingers are near, and coloured by force around the points that they touch.
import { Color, MeshStandardMaterial, ReplaceStencilOp, Vector3, Vector4 } from "three";
import { forceColour } from "./force_colour";

const kContacts = 16;
const kFingers = 15; // capsules that darken, one a segment without the palm

export interface Touch {
  readonly point: readonly [number, number, number]; // W [m]
  readonly force: number; // [N]
}

const declarations = `
varying vec3 vPlace;
uniform vec4 touch[${kContacts}];
uniform vec3 touchColour[${kContacts}];
uniform int touches;
#ifdef FINGER_SHADE
uniform vec4 fingerFrom[${kFingers}];
uniform vec3 fingerTo[${kFingers}];
uniform int fingers;
float fingerShade(vec3 place, vec3 outward) {
  float open = 1.0;
  for (int i = 0; i < ${kFingers}; ++i) {
    if (i >= fingers) break;
    vec3 along = fingerTo[i] - fingerFrom[i].xyz;
    vec3 from = place - fingerFrom[i].xyz;
    vec3 away = from - along * clamp(dot(from, along) / max(dot(along, along), 1e-9), 0.0, 1.0);
    float far = length(away);
    float radius = fingerFrom[i].w;
    float covered = clamp(0.35 - dot(outward, away) / max(far, 1e-6), 0.0, 1.0) * pow(radius / max(far, radius), 2.0);
    open *= 1.0 - 0.62 * covered;
  }
  return open;
}
#endif`;

const colouring = `
{
  #ifdef FINGER_SHADE
  diffuseColor.rgb *= fingerShade(vPlace, normalize(vOutward));
  #endif
  for (int i = 0; i < ${kContacts}; ++i) {
    if (i >= touches) break;
    float near = 1.0 - smoothstep(0.35, 1.0, distance(vPlace, touch[i].xyz) / touch[i].w);
    diffuseColor.rgb = mix(diffuseColor.rgb, touchColour[i], 0.8 * near);
  }
}`;

export class ObjectMaterial extends MeshStandardMaterial {
  private readonly touch = Array.from({ length: kContacts }, () => new Vector4());
  private readonly touchColour = Array.from({ length: kContacts }, () => new Color());
  private readonly touches = { value: 0 };
  private readonly fingerFrom = Array.from({ length: kFingers }, () => new Vector4());
  private readonly fingerTo = Array.from({ length: kFingers }, () => new Vector3());
  private readonly fingers = { value: 0 };

  constructor() {
    super({ roughness: 0.82, metalness: 0, stencilWrite: true, stencilRef: 0, stencilZPass: ReplaceStencilOp }); // it hides the hand
  }

  override onBeforeCompile: MeshStandardMaterial["onBeforeCompile"] = (shader) => {
    shader.uniforms["touch"] = { value: this.touch };
    shader.uniforms["touchColour"] = { value: this.touchColour };
    shader.uniforms["touches"] = this.touches;
    shader.uniforms["fingerFrom"] = { value: this.fingerFrom };
    shader.uniforms["fingerTo"] = { value: this.fingerTo };
    shader.uniforms["fingers"] = this.fingers;
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", "#include <common>\nvarying vec3 vPlace;\nvarying vec3 vOutward;")
      .replace("#include <begin_vertex>", "#include <begin_vertex>\nvPlace = position;\nvOutward = normal;");
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", `#include <common>\nvarying vec3 vOutward;${declarations}`)
      .replace("#include <color_fragment>", colouring);
  };

  /// @param radius  how far around the point the colour reaches [m]
  setTouches(touches: readonly Touch[], radius: number): void {
    const shown = touches.slice(0, kContacts);
    this.touches.value = shown.length;
    shown.forEach((at, i) => {
      this.touch[i]!.set(at.point[0], at.point[1], at.point[2], radius);
      this.touchColour[i]!.set(forceColour(at.force));
    });
  }

  /// Which fingers darken it: each a capsule from `from` to `to` [m], W.
  setFingers(capsules: readonly Capsule[]): void {
    const shown = capsules.slice(0, kFingers);
    this.fingers.value = shown.length;
    shown.forEach((capsule, i) => {
      this.fingerFrom[i]!.set(capsule.from[0], capsule.from[1], capsule.from[2], capsule.radius);
      this.fingerTo[i]!.set(capsule.to[0], capsule.to[1], capsule.to[2]);
    });
  }

  setOcclusion(on: boolean): void {
    if (on === ("FINGER_SHADE" in (this.defines ?? {}))) return;
    this.defines = on ? { STANDARD: "", FINGER_SHADE: "" } : { STANDARD: "" };
    this.needsUpdate = true;
  }
}

export interface Capsule {
  readonly from: readonly [number, number, number];
  readonly to: readonly [number, number, number];
  readonly radius: number; // [m]
}
