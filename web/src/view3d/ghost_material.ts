// SPDX-License-Identifier: Apache-2.0
// The measured hand as a ghost. Its mesh is that of the shown hand on other bones, so each vertex knows how far it is from where it is
// shown: where both hands agree the ghost fades out, and nothing fights for the same depth.
import { Color, EqualStencilFunc, NotEqualStencilFunc, ShaderMaterial } from "three";
import type { StencilFunc } from "three";
import type { DataTexture } from "three";
import { withCentresOfRotation } from "./skinning";

const kFadesFrom = 0.3e-3; // [m] apart: unseen up to here
const kFadesTo = 2.0e-3; // fully seen from here

const vertexShader = withCentresOfRotation(`
#include <common>
#include <skinning_pars_vertex>
uniform highp sampler2D shownBones;
varying vec3 vNormal;
varying vec3 vToEye;
varying float vApart;
void main() {
  #include <beginnormal_vertex>
  #include <skinbase_vertex>
  #include <skinnormal_vertex>
  #include <begin_vertex>
  #include <skinning_vertex>
  vApart = distance(transformed, movedBy(blendedBones(shownBones), position));
  vec4 seen = viewMatrix * vec4(transformed, 1.0);
  vNormal = mat3(viewMatrix) * objectNormal;
  vToEye = -seen.xyz;
  gl_Position = projectionMatrix * seen;
}`);

const fragmentShader = `
uniform vec3 colour;
uniform float fill;
varying vec3 vNormal;
varying vec3 vToEye;
varying float vApart;
void main() {
  float apart = smoothstep(${kFadesFrom.toExponential()}, ${kFadesTo.toExponential()}, vApart);
  if (apart < 0.02) discard;
  float rim = pow(1.0 - abs(dot(normalize(vNormal), normalize(vToEye))), 2.2);
  gl_FragColor = vec4(colour, apart * mix(fill, 0.92, rim));
  #include <colorspace_fragment>
}`;

/// In the stencil where the shown hand is what one sees.
export const handStencil = 1;
const kFill = 0.2; // opacity in the middle of the ghost, inside the object or in the open
const kFillOverHand = 0.03; // over the shown hand only its outline counts

const kFillEverywhere = 0.1;

/// Materials for the same mesh: the first writes only depth, the others draw the one layer that is left.
export class GhostMaterials {
  private readonly colour = new Color();
  readonly depth: ShaderMaterial;
  readonly layers: readonly [ShaderMaterial, ShaderMaterial, ShaderMaterial]; // over the hand, elsewhere, everywhere

  constructor(shownBones: DataTexture) {
    const made = (fill: number): ShaderMaterial => {
      const uniforms = { shownBones: { value: shownBones }, colour: { value: this.colour }, fill: { value: fill } };
      return new ShaderMaterial({ vertexShader, fragmentShader, uniforms, transparent: true });
    };
    const layer = (fill: number, stencilFunc: StencilFunc): ShaderMaterial =>
      Object.assign(made(fill), { stencilWrite: true, stencilRef: handStencil, stencilFunc });
    this.depth = Object.assign(made(0), { colorWrite: false });
    this.layers = [layer(kFillOverHand, EqualStencilFunc), layer(kFill, NotEqualStencilFunc), made(kFillEverywhere)];
  }

  setColour(colour: string): void {
    this.colour.set(colour);
  }

  dispose(): void {
    this.depth.dispose();
    for (const layer of this.layers) layer.dispose();
  }
}
