// SPDX-License-Identifier: Apache-2.0
// Curves that leave the plot at its upper edge: a mark there at each peak, and how high the highest goes. Figures have the same marks.
import uPlot from "uplot";
import { strings } from "../strings";
import type { Theme } from "../theme";
import type { Curve } from "./plot_kinds";
import { peaksBeyond } from "./value_range";

const kMark = 5; // half a mark's width, and its height [px]

/// @param font  in canvas pixels
export function drawCutOff(plot: uPlot, curves: readonly Curve[], unit: string, colours: Theme, font: () => string): void {
  const top = plot.scales["y"]?.max ?? Infinity;
  const { ctx, bbox } = plot;
  const size = kMark * uPlot.pxRatio;
  let highest = -Infinity;
  ctx.save();
  curves.forEach((curve, i) => {
    const values = plot.data[i + 1] ?? [];
    for (const peak of peaksBeyond(values, top)) {
      const x = plot.valToPos(plot.data[0][peak]!, "x", true);
      if (x < bbox.left) continue; // before what is shown
      highest = Math.max(highest, Number(values[peak]));
      ctx.fillStyle = curve.colour;
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x - size, bbox.top + size);
      ctx.lineTo(x + size, bbox.top + size);
      ctx.fill();
    }
  });
  if (highest > top) {
    const text = strings.plots.beyond(highest.toFixed(1), unit);
    ctx.font = font();
    ctx.textAlign = "right";
    ctx.textBaseline = "top";
    const right = bbox.left + bbox.width - size;
    const at = bbox.top + 1.5 * size;
    ctx.fillStyle = colours.panel;
    ctx.fillRect(right - ctx.measureText(text).width - size, at - size / 2, ctx.measureText(text).width + 2 * size, 4 * size);
    ctx.fillStyle = colours.text;
    ctx.fillText(text, right, at);
  }
  ctx.restore();
}
