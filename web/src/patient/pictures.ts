// SPDX-License-Identifier: Apache-2.0
// Line pictures of buttons and waiting screens, in the colour of the text.

const kNamespace = "http://www.w3.org/2000/svg";

/// Outlines in a square of 24 by 24.
const outlines = {
  stop: "M8 2.500h8L21.500 8v8L16 21.500H8L2.500 16V8z",
  pause: "M4 8h12v6a5 5 0 0 1-5 5H9a5 5 0 0 1-5-5zM16 9h2a3 3 0 0 1 0 6h-2M8 2.500q-1.500 1.500 0 3M12 2.500q-1.500 1.500 0 3M3 21.500h14",
  pain: "M13 2 5 13.500h6L10 22l9-12.500h-6.500z",
  tired: "M15.500 3a9.500 9.500 0 1 0 5.500 13A8 8 0 0 1 15.500 3zM17 4h4l-4 4.500h4",
  menu: "M4 7h9M19 7h1M4 17h1M11 17h9M16 4.500a2.500 2.500 0 1 0 0 5 2.500 2.500 0 0 0 0-5zM8 14.500a2.500 2.500 0 1 0 0 5 2.500 2.500 0 0 0 0-5z",
  helper: "M12 3.500a4 4 0 1 0 0 8 4 4 0 0 0 0-8zM3.500 21.500v-1a6.500 6.500 0 0 1 6.500-6.500h4a6.500 6.500 0 0 1 6.500 6.500v1",
  eye: "M2 12q10-12 20 0q-10 12-20 0zM12 9a3 3 0 1 0 0 6 3 3 0 0 0 0-6z",
  hand: "M7 12V6a1.500 1.500 0 0 1 3 0v5V4a1.500 1.500 0 0 1 3 0v7V5a1.500 1.500 0 0 1 3 0v7V8a1.500 1.500 0 0 1 3 0v7q0 7-6.500 7T6 18l-3-5.500q1.500-2 3.500.500z",
  right: "M4 13l5 5L20 6",
  lantern: "M9 3h6M12 1v2M8 6h8l2 6-2 7H8l-2-7zM9 6v13M15 6v13M12 19v4",
} as const;
export type LinePicture = keyof typeof outlines;

export function linePicture(name: LinePicture): SVGSVGElement {
  const svg = document.createElementNS(kNamespace, "svg");
  for (const [key, value] of Object.entries({ class: "line-picture", viewBox: "0 0 24 24", "aria-hidden": "true", "data-picture": name })) svg.setAttribute(key, value);
  const path = document.createElementNS(kNamespace, "path");
  path.setAttribute("d", outlines[name]);
  svg.append(path);
  return svg;
}
