// SPDX-License-Identifier: Apache-2.0
// The picture symbols of patients: plain shapes in the colour of the text, so that they differ without colour. Their words stand beside them.
import { svg } from "../panels/dom";

/// Outlines in a square of 24 by 24, by the words of the station.
const outlines: Readonly<Record<string, string>> = {
  sun: "M12 7a5 5 0 1 0 0 10 5 5 0 0 0 0-10zM11 1h2v4h-2zM11 19h2v4h-2zM1 11h4v2H1zM19 11h4v2h-4zM3.5 5 5 3.500 7.800 6.300 6.300 7.800zM16.200 17.700l1.500-1.500L20.500 19 19 20.500zM19 3.500 20.500 5l-2.800 2.800-1.500-1.500zM6.300 16.200l1.500 1.500L5 20.500 3.500 19z",
  tree: "M12 1 5 10h3l-5 7h7v6h4v-6h7l-5-7h3z",
  boat: "M11 2h2v12h-2zM14 4l6 9h-6zM10 6v7H4zM2 16h20l-4 6H6z",
  star: "M12 1l3.200 7.400 8 .7-6 5.300 1.800 7.900L12 18.100 5 22.300l1.800-7.900-6-5.300 8-.7z",
  fish: "M1 6l5 4c2-3 5-4.500 8-4.500 4 0 7 3 9 6.500-2 3.500-5 6.500-9 6.500-3 0-6-1.500-8-4.500l-5 4 2-6zM17.500 9.500a1.500 1.500 0 1 0 0 3 1.500 1.500 0 0 0 0-3z",
  house: "M12 2 1 12h3v10h6v-7h4v7h6V12h3z",
  leaf: "M21 2C8 2 3 8 3 14c0 2 .600 3.600 1.500 5L2 21.500 3.500 23l2.600-2.600C7.600 21.400 9 22 11 22 18 22 22 15 21 2zM7 17C9 13 12 10 16 8c-3 3-5.500 6-7 10z",
  moon: "M15 1a11 11 0 1 0 8 15A9 9 0 0 1 15 1z",
  bird: "M2 13c3 0 5-1 7-4 1-2 3-4 6-4 2 0 4 1 4.500 3L23 9l-3.500 2c0 6-4 10-10 10H4l4-4c-3 0-5-1-6-4z",
  bell: "M10.500 2.500a1.500 1.500 0 0 1 3 0C17 3.500 19 6 19 10v5l2 3H3l2-3v-5c0-4 2-6.500 5.500-7.500zM9 19.500h6a3 3 0 0 1-6 0z",
  apple: "M13 6c0-2 1-4 4-5 0 3-1 4.500-4 5zM12 8c2-1.500 9-2 9 5 0 5-3.500 10-6 10-1.200 0-2-.500-3-.500S10.200 23 9 23c-2.500 0-6-5-6-10 0-7 7-6.500 9-5z",
  kite: "M12 1l7 8-7 8-7-8zM11 17h2c0 2-2 2-2 3.500s2 1 2 2.500h-2c0-1-2-1-2-2.500S11 18.500 11 17z",
};

/// @param symbol  a word of the station; an unknown one has an empty square
export function picture(symbol: string): SVGSVGElement {
  const drawn = svg("svg", { class: "symbol", viewBox: "0 0 24 24", "aria-hidden": "true", "data-symbol": symbol });
  drawn.append(svg("path", { d: outlines[symbol] ?? "M3 3h18v18H3zM5 5v14h14V5z", "fill-rule": "evenodd" }));
  return drawn;
}
