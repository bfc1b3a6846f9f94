// SPDX-License-Identifier: Apache-2.0
// The shown hand: each bone has the colour of its force, strongest around the contact and blended over the skin by the bones' weights, and
// light that seems to come through at its rim.
import { Color, MeshDepthMaterial, MeshStandardMaterial, ReplaceStencilOp, RGBADepthPacking, Vector3 } from "three";
import { forceColour } from "./force_colour";
import { handStencil } from "./ghost_material";
import { kSegments } from "./segments";
import { withCentresOfRotation } from "./skinning";

const kReach = 0.018; // of the full colour around a contact [m], one standard deviation
const kElsewhere = 0.45; // share of the colour on the rest of the segment

const tinting = `
uniform vec3 plainColour;
uniform vec3 segmentColour[${kSegments}];
uniform vec3 segmentTouch[${kSegments}];
varying vec3 vSegmentColour;
vec3 tinted(const in int segment, const in vec3 place) {
  vec3 away = place - segmentTouch[segment];
  float near = exp(-dot(away, away) * ${(0.5 / (kReach * kReach)).toFixed(1)});
  return mix(plainColour, segmentColour[segment], mix(${kElsewhere.toFixed(2)}, 1.0, near));
}`;

export class HandMaterial extends MeshStandardMaterial {
  private readonly colours = Array.from({ length: kSegments }, () => new Color());
  private readonly rim = { value: 1 };
  private plain = "#ffffff";
  private alive = true;
  private presses: readonly Press[] = [];
  private readonly plainColour = new Color();
  private readonly touches = Array.from({ length: kSegments }, () => new Vector3());

  constructor() {
    super({ roughness: 0.62, metalness: 0, stencilWrite: true, stencilRef: handStencil, stencilZPass: ReplaceStencilOp });
  }

  override onBeforeCompile: MeshStandardMaterial["onBeforeCompile"] = (shader) => {
    shader.uniforms["segmentColour"] = { value: this.colours };
    shader.uniforms["segmentTouch"] = { value: this.touches };
    shader.uniforms["plainColour"] = { value: this.plainColour };
    shader.uniforms["rimLight"] = this.rim;
    shader.vertexShader = withCentresOfRotation(shader.vertexShader
      .replace("#include <common>", `#include <common>\n${tinting}`)
      .replace(
        "#include <skinning_vertex>",
        `#include <skinning_vertex>
        vSegmentColour = skinWeight.x * tinted(int(skinIndex.x), transformed) + skinWeight.y * tinted(int(skinIndex.y), transformed)
                       + skinWeight.z * tinted(int(skinIndex.z), transformed) + skinWeight.w * tinted(int(skinIndex.w), transformed);`,
      ));
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", "#include <common>\nuniform float rimLight;\nvarying vec3 vSegmentColour;")
      .replace("#include <color_fragment>", "diffuseColor.rgb = vSegmentColour;")
      .replace(
        "#include <opaque_fragment>",
        `float facing = saturate(dot(normal, normalize(vViewPosition)));
        outgoingLight += rimLight * vSegmentColour * vec3(0.30, 0.19, 0.15) * pow(1.0 - facing, 2.5);
        #include <opaque_fragment>`,
      );
  };

  /// The hand without force, and whether it is alive: if not, all of it has that colour, and no light comes through.
  setSkin(colour: string, alive: boolean): void {
    this.plain = colour;
    this.alive = alive;
    this.rim.value = alive ? 1 : 0.3;
    this.plainColour.set(colour);
    this.setPresses(this.presses);
  }

  /// Which segments press, where and how hard; of several contacts of one segment the hardest counts.
  setPresses(presses: readonly Press[]): void {
    this.presses = presses;
    for (const colour of this.colours) colour.set(this.plain);
    if (!this.alive) return;
    for (const press of [...presses].sort((a, b) => a.force - b.force)) {
      if (!(press.force > 0)) continue;
      this.colours[press.segment]?.set(forceColour(press.force));
      this.touches[press.segment]?.set(...press.point);
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
  readonly force: number; // [N]
}
