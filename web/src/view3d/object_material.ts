// SPDX-License-Identifier: Apache-2.0
// The object: of the material of its kind; darker where fingers are near, and tinted by force around the points that they touch.
import { Color, MeshPhysicalMaterial, ReplaceStencilOp, Vector3, Vector4 } from "three";
import type { Box3 } from "three";
import { forceTint } from "./force_colour";
import { lookOf } from "./object_looks";

const kContacts = 16;
const kFingers = 15; // capsules that darken, one a segment without the palm

export interface Touch {
  readonly point: readonly [number, number, number]; // W [m]
  readonly share: number; // of the scale of forces
}

const declarations = `
varying vec3 vPlace;
uniform vec4 touch[${kContacts}];
uniform vec4 touchColour[${kContacts}];
uniform int touches;
#ifdef WOOD
uniform vec3 grainAlong;
uniform vec3 grainCentre;
vec3 wood(vec3 colour, vec3 place) {
  vec3 from = place - grainCentre;
  float along = dot(from, grainAlong);
  vec3 off = from - along * grainAlong + vec3(0.031, 0.047, 0.023) * (1.0 - grainAlong);
  float ring = length(off) * 300.0 + 1.1 * sin(along * 21.0 + off.x * 60.0) + 0.5 * sin(along * 57.0 + off.y * 90.0);
  float late = fract(ring);
  float dark = smoothstep(0.45, 0.95, late) * (1.0 - smoothstep(0.95, 1.0, late));
  float fibre = sin(dot(off, vec3(2900.0, 3300.0, 2500.0)) + 3.0 * sin(along * 40.0));
  return colour * (1.06 - 0.3 * dark) * (1.0 + 0.035 * fibre);
}
#endif
#ifdef SKYLINE
uniform vec3 skyAbove;
uniform vec3 skyBelow;
#endif
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
float bare = 1.0; // of the touched places' tint
{
  #ifdef WOOD
  diffuseColor.rgb = wood(diffuseColor.rgb, vPlace);
  #endif
  #ifdef FINGER_SHADE
  diffuseColor.rgb *= fingerShade(vPlace, normalize(vOutward));
  #endif
  for (int i = 0; i < ${kContacts}; ++i) {
    if (i >= touches) break;
    float near = 1.0 - smoothstep(0.35, 1.0, distance(vPlace, touch[i].xyz) / touch[i].w);
    float share = 0.85 * near * touchColour[i].w;
    diffuseColor.rgb = mix(diffuseColor.rgb, touchColour[i].rgb, share);
    bare *= 1.0 - share;
  }
}`;

/// Without an environment: what a shiny surface mirrors is bright above the horizon and dark below.
const mirroring = `
metalnessFactor *= bare;
#include <lights_physical_fragment>`;
const skyline = `
#ifdef SKYLINE
{
  vec3 mirrored = reflect(-normalize(vViewPosition), normal);
  float up = dot(mirrored, vec3(viewMatrix[2])); // z of W in the eye's frame
  float glancing = pow(1.0 - saturate(dot(normal, normalize(vViewPosition))), 4.0);
  vec3 sky = mix(skyBelow, skyAbove, smoothstep(-0.25, 0.35, up)) * (1.0 + 0.8 * smoothstep(0.78, 0.9, up));
  outgoingLight += sky * mix(material.specularColor, vec3(1.0), 0.6 * glancing) * (1.0 - 0.7 * roughnessFactor);
}
#endif
#include <opaque_fragment>`;

export class ObjectMaterial extends MeshPhysicalMaterial {
  private readonly touch = Array.from({ length: kContacts }, () => new Vector4());
  private readonly touchColour = Array.from({ length: kContacts }, () => new Vector4());
  private readonly touches = { value: 0 };
  private readonly fingerFrom = Array.from({ length: kFingers }, () => new Vector4());
  private readonly fingerTo = Array.from({ length: kFingers }, () => new Vector3());
  private readonly fingers = { value: 0 };
  private readonly grainAlong = new Vector3(1, 0, 0);
  private readonly grainCentre = new Vector3();
  private readonly sky = { above: new Color(), below: new Color() };
  private look = lookOf("");
  private rich = false;

  constructor() {
    super({ stencilWrite: true, stencilRef: 0, stencilZPass: ReplaceStencilOp }); // it hides the hand
    this.apply();
  }

  override onBeforeCompile: MeshPhysicalMaterial["onBeforeCompile"] = (shader) => {
    shader.uniforms["touch"] = { value: this.touch };
    shader.uniforms["touchColour"] = { value: this.touchColour };
    shader.uniforms["touches"] = this.touches;
    shader.uniforms["fingerFrom"] = { value: this.fingerFrom };
    shader.uniforms["fingerTo"] = { value: this.fingerTo };
    shader.uniforms["fingers"] = this.fingers;
    shader.uniforms["grainAlong"] = { value: this.grainAlong };
    shader.uniforms["grainCentre"] = { value: this.grainCentre };
    shader.uniforms["skyAbove"] = { value: this.sky.above };
    shader.uniforms["skyBelow"] = { value: this.sky.below };
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", "#include <common>\nvarying vec3 vPlace;\nvarying vec3 vOutward;")
      .replace("#include <begin_vertex>", "#include <begin_vertex>\nvPlace = position;\nvOutward = normal;");
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", `#include <common>\nvarying vec3 vOutward;${declarations}`)
      .replace("#include <color_fragment>", colouring)
      .replace("#include <lights_physical_fragment>", mirroring)
      .replace("#include <opaque_fragment>", skyline);
  };

  /// @param radius  how far around the point the colour reaches [m]
  setTouches(touches: readonly Touch[], radius: number): void {
    const shown = touches.slice(0, kContacts);
    this.touches.value = shown.length;
    shown.forEach((at, i) => {
      this.touch[i]!.set(at.point[0], at.point[1], at.point[2], radius);
      const { colour, share } = forceTint(at.share);
      tint.set(colour);
      this.touchColour[i]!.set(tint.r, tint.g, tint.b, share);
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

  /// Of which kind the object is.
  setKind(kind: string): void {
    this.look = lookOf(kind);
    this.apply();
  }

  /// @param box  of the object: wood grows along its longest side
  setGrain(box: Box3): void {
    const { x, y, z } = box.getSize(new Vector3());
    const most = Math.max(x, y, z);
    this.grainAlong.set(x === most ? 1 : 0, x !== most && y === most ? 1 : 0, x !== most && y !== most ? 1 : 0);
    box.getCenter(this.grainCentre);
  }

  /// @param rich  an environment lights it, glaze is a layer of its own, glass lets light through, and fingers darken it
  setRich(rich: boolean): void {
    this.rich = rich;
    this.apply();
  }

  setSky(above: string, below: string): void {
    this.sky.above.set(above);
    this.sky.below.set(below);
  }

  private apply(): void {
    const { colour, roughness, metalness, coat, grain, opacity } = this.look;
    const { rich } = this;
    this.color.set(colour);
    // The simple kind has one layer: the glaze's polish is the surface's.
    this.roughness = rich ? roughness : roughness * (1 - 0.4 * coat);
    this.metalness = rich ? metalness : 0.55 * metalness;
    this.clearcoat = rich ? coat : 0;
    this.clearcoatRoughness = 0.12;
    this.transparent = rich && opacity < 1;
    this.opacity = rich ? opacity : 1;
    const defines: Record<string, string> = { STANDARD: "" };
    if (rich) Object.assign(defines, { PHYSICAL: "", FINGER_SHADE: "" });
    else if (roughness < 0.5) defines["SKYLINE"] = "";
    if (grain) defines["WOOD"] = "";
    this.defines = defines;
    this.needsUpdate = true;
  }
}

const tint = new Color();

export interface Capsule {
  readonly from: readonly [number, number, number];
  readonly to: readonly [number, number, number];
  readonly radius: number; // [m]
}
