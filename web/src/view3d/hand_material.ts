// SPDX-License-Identifier: Apache-2.0
// The shown hand: skin and nails, each bone with the tint of its force, strongest around the contact and blended over the skin by the bones'
// weights; light that bleeds over the terminator and at the rim, as through skin. In detail it has creases and wrinkles, as a height that
// bends the normal.
import { Color, Matrix4, MeshDepthMaterial, MeshStandardMaterial, ReplaceStencilOp, RGBADepthPacking, Vector4 } from "three";
import { forceTint } from "./force_colour";
import { handStencil } from "./ghost_material";
import { kPalmLines, type PalmLine } from "./palm_lines";
import { kSegments } from "./segments";
import { withCentresOfRotation } from "./skinning";
import type { SkinTone } from "./skin_tones";

const kReach = 0.018; // of the full tint around a contact [m], one standard deviation
const kElsewhere = 0.45; // share of the tint on the rest of the segment

const tinting = `
attribute vec4 skinDetail;
uniform vec3 plainColour;
uniform vec3 palmColour;
uniform vec3 flushColour;
uniform vec3 nailColour;
uniform vec3 segmentColour[${kSegments}];
uniform vec4 segmentTouch[${kSegments}]; // where, and share of the tint
varying vec3 vSegmentColour;
varying float vNail;
#ifdef SKIN_DETAIL
uniform mat4 palmFromBind;
varying vec3 vDetail;
varying vec3 vPalm;
#endif
vec3 ownColour() {
  if (skinDetail.w > 0.5) {
    float root = 1.0 - smoothstep(0.1, 0.3, skinDetail.x + 0.12 * skinDetail.y * skinDetail.y);
    float edge = smoothstep(0.8, 0.9, skinDetail.x - 0.08 * skinDetail.y * skinDetail.y);
    return mix(nailColour, nailColour * 0.45 + 0.5, max(0.35 * root, 0.7 * edge));
  }
  return mix(mix(plainColour, palmColour, smoothstep(0.0, 0.85, skinDetail.y)), flushColour, 0.6 * skinDetail.z);
}
vec3 tinted(const in vec3 own, const in int segment, const in vec3 place) {
  vec3 away = place - segmentTouch[segment].xyz;
  float near = exp(-dot(away, away) * ${(0.5 / (kReach * kReach)).toFixed(1)});
  return mix(own, segmentColour[segment], segmentTouch[segment].w * mix(${kElsewhere.toFixed(2)}, 1.0, near));
}`;

const placing = `
vec3 own = ownColour();
vSegmentColour = skinWeight.x * tinted(own, int(skinIndex.x), transformed) + skinWeight.y * tinted(own, int(skinIndex.y), transformed)
               + skinWeight.z * tinted(own, int(skinIndex.z), transformed) + skinWeight.w * tinted(own, int(skinIndex.w), transformed);
vNail = skinDetail.w;
#ifdef SKIN_DETAIL
vDetail = skinDetail.xyz;
vPalm = (palmFromBind * vec4(position, 1.0)).xyz;
#endif`;

/// Depths in millimetres.
const relief = `
uniform float rimLight;
varying vec3 vSegmentColour;
varying float vNail;
#ifdef SKIN_DETAIL
varying vec3 vDetail;
varying vec3 vPalm;
uniform vec4 palmCircle[${kPalmLines}];
uniform vec4 palmReach[${kPalmLines}];
float hashOf(vec3 cell) {
  return fract(sin(dot(cell, vec3(12.9898, 78.233, 37.719))) * 43758.5453);
}
float noiseAt(vec3 place) {
  vec3 cell = floor(place);
  vec3 t = fract(place);
  t *= t * (3.0 - 2.0 * t);
  vec4 low = vec4(hashOf(cell), hashOf(cell + vec3(1, 0, 0)), hashOf(cell + vec3(0, 1, 0)), hashOf(cell + vec3(1, 1, 0)));
  vec4 high = vec4(hashOf(cell + vec3(0, 0, 1)), hashOf(cell + vec3(1, 0, 1)), hashOf(cell + vec3(0, 1, 1)), hashOf(cell + vec3(1, 1, 1)));
  vec4 flat4 = mix(low, high, t.z);
  return mix(mix(flat4.x, flat4.y, t.x), mix(flat4.z, flat4.w, t.x), t.y);
}
float groove(float away, float width) {
  return exp(-away * away / (width * width));
}
float creaseDepth(float rough) {
  float palmar = smoothstep(0.05, 0.5, vDetail.y);
  float back = smoothstep(0.1, 0.6, -vDetail.y);
  float nearest = floor(vDetail.x + 0.5);
  float away = 24.0 * (vDetail.x - nearest) + 1.0 * (rough - 0.5);
  float onDigit = step(0.75, abs(vDetail.x));
  float onJoint = max(step(1.6, vDetail.x), step(0.75, -vDetail.x));
  float joint = groove(away, 0.55) + 0.6 * groove(away - 2.1, 0.5) + 0.35 * groove(away + 1.9, 0.45);
  float depth = 0.55 * palmar * onDigit * joint;
  float wrinkles = 0.5 + 0.5 * cos(2.7 * away + 5.0 * rough);
  depth += 0.2 * back * onJoint * wrinkles * groove(away, 4.6);
  for (int i = 0; i < ${kPalmLines}; ++i) {
    vec2 place = vPalm.xz;
    float off = 1000.0 * (distance(place, palmCircle[i].xy) - palmCircle[i].z) + 1.1 * (rough - 0.5);
    float along = dot(place - palmReach[i].xy, palmReach[i].zw);
    float within = smoothstep(-0.02, 0.12, along) * (1.0 - smoothstep(0.82, 1.05, along));
    depth += 0.5 * palmar * within * (1.0 - onDigit) * groove(off, 0.7);
  }
  return depth;
}
#endif`;

const bending = `
#ifdef SKIN_DETAIL
float rough = noiseAt(vPalm * 190.0);
float pores = noiseAt(vPalm * 1900.0);
float crease = (1.0 - vNail) * creaseDepth(rough);
{
  float height = -0.0008 * crease + (1.0 - vNail) * 0.000022 * pores;
  vec3 sigmaX = dFdx(vViewPosition);
  vec3 sigmaY = dFdy(vViewPosition);
  vec3 r1 = cross(sigmaY, normal);
  vec3 r2 = cross(normal, sigmaX);
  float det = dot(sigmaX, r1);
  vec3 slope = sign(det) * (dFdx(height) * r1 + dFdy(height) * r2);
  normal = normalize(abs(det) * normal + slope);
  diffuseColor.rgb *= mix(vec3(1.0), vec3(0.66, 0.5, 0.44), clamp(crease, 0.0, 1.0));
  diffuseColor.rgb *= 0.955 + 0.09 * rough;
  roughnessFactor += (1.0 - vNail) * 0.14 * (rough - 0.5);
}
#endif`;

/// Red light bleeds into the shade beside the key light's edge.
const bleeding = `
float facing = saturate(dot(normal, normalize(vViewPosition)));
float sun = dot(normal, directionalLights[0].direction);
float bleed = saturate(0.72 * sun + 0.28) - saturate(sun);
vec3 through = rimLight * vSegmentColour * (vec3(0.26, 0.16, 0.13) * pow(1.0 - facing, 2.5)
             + max(bleed, 0.0) * directionalLights[0].color * vec3(0.30, 0.09, 0.05));
outgoingLight += through;
#include <opaque_fragment>`;

export class HandMaterial extends MeshStandardMaterial {
  private readonly colours = Array.from({ length: kSegments }, () => new Color());
  private readonly touches = Array.from({ length: kSegments }, () => new Vector4());
  private readonly rim = { value: 1 };
  private readonly tone = { skin: new Color(), palm: new Color(), flush: new Color(), nail: new Color() };
  private readonly palmFromBind = new Matrix4();
  private readonly palmCircles = Array.from({ length: kPalmLines }, () => new Vector4());
  private readonly palmReaches = Array.from({ length: kPalmLines }, () => new Vector4());

  constructor() {
    super({ roughness: 0.58, metalness: 0, stencilWrite: true, stencilRef: handStencil, stencilZPass: ReplaceStencilOp });
  }

  override onBeforeCompile: MeshStandardMaterial["onBeforeCompile"] = (shader) => {
    Object.assign(shader.uniforms, {
      segmentColour: { value: this.colours },
      segmentTouch: { value: this.touches },
      plainColour: { value: this.tone.skin },
      palmColour: { value: this.tone.palm },
      flushColour: { value: this.tone.flush },
      nailColour: { value: this.tone.nail },
      palmFromBind: { value: this.palmFromBind },
      palmCircle: { value: this.palmCircles },
      palmReach: { value: this.palmReaches },
      rimLight: this.rim,
    });
    shader.vertexShader = withCentresOfRotation(shader.vertexShader
      .replace("#include <common>", `#include <common>\n${tinting}`)
      .replace("#include <skinning_vertex>", `#include <skinning_vertex>\n${placing}`));
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", `#include <common>\n${relief}`)
      .replace("#include <color_fragment>", "diffuseColor.rgb = vSegmentColour;")
      .replace("#include <normal_fragment_maps>", `roughnessFactor = mix(roughnessFactor, 0.28, vNail);\n${bending}`)
      .replace("#include <opaque_fragment>", bleeding);
  };

  /// Creases, wrinkles and pores: for graphics cards.
  setDetail(on: boolean): void {
    if (on === ("SKIN_DETAIL" in (this.defines ?? {}))) return;
    this.defines = on ? { STANDARD: "", SKIN_DETAIL: "" } : { STANDARD: "" };
    this.needsUpdate = true;
  }

  /// @param palmFromBind  X_SB of the palm
  setPalm(palmFromBind: Matrix4, lines: readonly PalmLine[]): void {
    this.palmFromBind.copy(palmFromBind);
    lines.forEach(({ circle, reach }, i) => {
      this.palmCircles[i]!.copy(circle);
      this.palmReaches[i]!.copy(reach);
    });
  }

  /// The hand without force.
  setTone(tone: SkinTone): void {
    this.rim.value = 1;
    for (const part of ["skin", "palm", "flush", "nail"] as const) this.tone[part].set(tone[part]);
  }

  /// A hand that is not that of this moment: all of it has one colour, and hardly any light comes through.
  setLost(colour: string): void {
    this.rim.value = 0.3;
    for (const part of ["skin", "palm", "flush", "nail"] as const) this.tone[part].set(colour);
  }

  /// Which segments press, where and how hard; of several contacts of one segment the hardest counts.
  setPresses(presses: readonly Press[]): void {
    for (const touch of this.touches) touch.w = 0;
    for (const press of [...presses].sort((a, b) => a.share - b.share)) {
      if (!(press.share > 0)) continue;
      const { colour, share } = forceTint(press.share);
      this.colours[press.segment]?.set(colour);
      this.touches[press.segment]?.set(...press.point, share);
    }
  }
}

/// What the hand's shadow is drawn with.
export class HandShadowMaterial extends MeshDepthMaterial {
  constructor() {
    super({ depthPacking: RGBADepthPacking });
  }

  override onBeforeCompile: MeshDepthMaterial["onBeforeCompile"] = (shader) => {
    shader.vertexShader = withCentresOfRotation(shader.vertexShader);
  };
}

export interface Press {
  readonly segment: number;
  readonly point: readonly [number, number, number]; // W [m]
  readonly share: number; // of the scale of forces
}
