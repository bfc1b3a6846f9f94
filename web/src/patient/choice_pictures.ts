// SPDX-License-Identifier: Apache-2.0
// Pictures of the answers: two sponges with one and two dots, and the objects that a hand may hold.

const kNamespace = "http://www.w3.org/2000/svg";
const kSoft = "M14 62q-8-26 14-32q22-9 44 0q22 6 14 32q-3 18-36 18t-36-18z";

const objects: Readonly<Record<string, readonly (readonly [path: string, fill: string])[]>> = {
  "a ball": [["M50 14a36 36 0 1 0 0 72 36 36 0 0 0 0-72z", "#f2a98f"], ["M34 28q10-9 22-7q-16 4-20 18z", "#fbd3c4"]],
  "a cube": [["M50 12 84 28 50 44 16 28z", "#cfe3ee"], ["M16 28 50 44V88L16 70z", "#8fb9cf"], ["M84 28 50 44V88L84 70z", "#6d9bb5"]],
  "a cylinder": [["M22 26v46q0 14 28 14t28-14V26z", "#a9c99a"], ["M22 26q0 13 28 13t28-13q0-13-28-13t-28 13z", "#d3e8c8"]],
};

/// @param choice  in the station's words  @param place  from 0
export function choicePicture(choice: string, place: number): SVGElement {
  const svg = document.createElementNS(kNamespace, "svg");
  for (const [name, value] of Object.entries({ viewBox: "0 0 100 100", class: "choice-picture", "aria-hidden": "true" })) svg.setAttribute(name, value);
  const add = (tag: string, attributes: Readonly<Record<string, string | number>>) => {
    const part = document.createElementNS(kNamespace, tag);
    for (const [name, value] of Object.entries(attributes)) part.setAttribute(name, String(value));
    svg.append(part);
  };
  const edge = { stroke: "#20323d", "stroke-width": 3, "stroke-linejoin": "round" };
  const parts = objects[choice];
  if (parts) for (const [d, fill] of parts) add("path", { d, fill, ...(fill.startsWith("#fbd") ? {} : edge) });
  else {
    add("path", { d: kSoft, fill: "#ffe0a6", ...edge });
    for (let i = 0; i <= place; ++i) add("circle", { cx: 50 + 18 * (i - place / 2), cy: 55, r: 6, fill: "#20323d" });
  }
  return svg;
}
