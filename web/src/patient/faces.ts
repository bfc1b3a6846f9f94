// SPDX-License-Identifier: Apache-2.0
// Drawn faces for ratings. They differ by mouth, brows and eyes, so that neither words nor colours are needed.
import type { Rating } from "./game";

const kNamespace = "http://www.w3.org/2000/svg";
const kWidest = 10;

function shape(tag: string, attributes: Readonly<Record<string, string | number>>): SVGElement {
  const element = document.createElementNS(kNamespace, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  return element;
}

const kGlad = [255, 226, 150];
const kMiddle = [250, 204, 150];
const kPain = [240, 160, 140];
const kTired = [176, 190, 218];

function skin(kind: Rating, share: number): string {
  const end = kind === "pain" ? kPain : kTired;
  const [one, other, part] = share < 0.5 ? [kGlad, kMiddle, 2 * share] : [kMiddle, end, 2 * share - 1];
  return `rgb(${one.map((value, i) => Math.round(value + (other[i]! - value) * part)).join(" ")})`;
}

/// @param value  0 .. 10
export function face(kind: Rating, value: number): SVGElement {
  const share = value / kWidest;
  const line = { fill: "none", stroke: "#3a2a20", "stroke-width": 4, "stroke-linecap": "round", "stroke-linejoin": "round" };
  const svg = shape("svg", { viewBox: "0 0 100 100", class: "face", "aria-hidden": "true" });
  svg.append(shape("circle", { cx: 50, cy: 50, r: 45, fill: skin(kind, share), stroke: "#3a2a20", "stroke-width": 3 }));
  const tight = kind === "pain" ? share : 0;
  const droop = kind === "tired" ? share : 0;
  const shut = kind === "pain" ? share > 0.75 : share > 0.85;
  for (const side of [-1, 1]) {
    const x = 50 + side * 17;
    const eye = 41 + 3 * droop;
    if (shut) svg.append(shape("path", { ...line, d: kind === "pain" ? `M${x - 7} ${eye - 4}l14 4-14 5` : `M${x - 8} ${eye}q8 7 16 0`, transform: kind === "pain" && side > 0 ? `translate(${2 * x} 0) scale(-1 1)` : "" }));
    else {
      const open = Math.max(0.22, 1 - 0.75 * droop - 0.35 * tight);
      svg.append(shape("ellipse", { cx: x, cy: eye, rx: 4.6, ry: 6.6 * open, fill: "#3a2a20" }));
      if (droop > 0.25) svg.append(shape("path", { ...line, d: `M${x - 8} ${eye - 6 * open - 1}q8 ${-3 + 5 * droop} 16 0` }));
    }
    const inner = 27 - 3 * tight; // brows: their inner ends rise with pain, as in a sad face
    const outer = 27 + 6 * tight + 4 * droop;
    svg.append(shape("path", { ...line, "stroke-width": 3.4, d: `M${50 + side * 9} ${inner}Q${x + side * 1} ${(inner + outer) / 2 - 4.5 + 4 * share} ${x + side * 9} ${outer}` }));
  }
  const smile = 13 * (1 - 2.1 * share) - (kind === "pain" ? 4 * share : 0);
  const y = 66 + 5 * share;
  if (kind === "pain" && share > 0.9) svg.append(shape("path", { ...line, fill: "#7a3b34", d: "M34 78q16-20 32 0q-16 5-32 0z" }));
  else if (kind === "tired" && share > 0.7) svg.append(shape("ellipse", { cx: 50, cy: 73, rx: 7 + 4 * (share - 0.7), ry: 6 + 14 * (share - 0.7), fill: "#7a4a44", stroke: "#3a2a20", "stroke-width": 3 }));
  else svg.append(shape("path", { ...line, d: `M32 ${y - smile / 3}Q50 ${y + smile} 68 ${y - smile / 3}` }));
  if (kind === "pain" && share > 0.75) svg.append(shape("path", { d: "M27 54q-7 10 0 13q7-3 0-13z", fill: "#6fb4dc", stroke: "#3a2a20", "stroke-width": 2 }));
  return svg;
}
