// SPDX-License-Identifier: Apache-2.0
// The axes of a mesh file as they lie in the picture: three lines from one point, with letters, over the picture.
import { Vector3 } from "three";
import type { Camera } from "three";
import { upAxes, type UpAxis } from "../state/up_axis";
import { strings } from "../strings";
import { rotationTo } from "./preview_scene";

const words = strings.object;
const kSize = 84; // of the square that it takes [pixels of the style sheet]
const kLine = 24; // of an axis
const kLetter = 33; // from the point to a letter's middle
const kSvg = "http://www.w3.org/2000/svg";

function svg<K extends keyof SVGElementTagNameMap>(tag: K, attributes: Readonly<Record<string, string>> = {}): SVGElementTagNameMap[K] {
  const element = document.createElementNS(kSvg, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return element;
}

export class AxisCross {
  readonly element = svg("svg", {
    class: "axis-cross", width: String(kSize), height: String(kSize), viewBox: [-kSize / 2, -kSize / 2, kSize, kSize].join(" "), "aria-hidden": "true",
  });
  private readonly axes = upAxes.map((axis) => {
    const group = svg("g");
    const line = svg("line");
    const letter = svg("text", { "text-anchor": "middle", "dominant-baseline": "central" });
    group.append(line, letter);
    this.element.append(group);
    return { axis, group, line, letter };
  });

  /// @param up  the file's axis that points up
  show(camera: Camera, up: UpAxis): void {
    const turn = rotationTo(up);
    const seen = this.axes.map((one, i) => {
      const direction = new Vector3().setComponent(i, 1).applyMatrix4(turn).applyQuaternion(camera.quaternion.clone().invert());
      return { ...one, direction };
    });
    for (const { axis, group, line, letter, direction } of seen.sort((a, b) => a.direction.z - b.direction.z)) {
      const { x, y } = direction;
      line.setAttribute("x2", (kLine * x).toFixed(1));
      line.setAttribute("y2", (-kLine * y).toFixed(1));
      letter.setAttribute("x", (kLetter * x).toFixed(1));
      letter.setAttribute("y", (-kLetter * y).toFixed(1));
      letter.textContent = axis === up ? words.upward(words.axes[axis]) : words.axes[axis];
      group.dataset["up"] = String(axis === up);
      this.element.append(group); // the nearest last, over the others
    }
  }
}
