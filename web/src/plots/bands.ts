// SPDX-License-Identifier: Apache-2.0
// Time chosen by pointer: a drag zooms, or selects. The selection has an edge on each side, which can be dragged.
import type uPlot from "uplot";
import { el, setShown } from "../panels/dom";
import { lengthOf, ordered, type Span, type TimeView } from "./time_view";

const kDrag = 5; // a shorter way is a press [px]
const kEdge = 8; // reach of the selection's edges [px]

export interface Bands {
  place(): void; // where the times are now
}

/// @param selects  whether a drag selects; otherwise it zooms. With Shift it always selects
export function bands(plot: uPlot, view: TimeView, selects: () => boolean): Bands {
  const selection = el("div", { class: "plot-selection", hidden: true }, el("i"), el("i"));
  const zoom = el("div", { class: "plot-zoom", hidden: true });
  const { over } = plot;
  over.append(selection, zoom);
  let drag: { readonly id: number; readonly left: number; readonly anchor: number; readonly selects: boolean; moved: boolean } | undefined;
  let zoomed: Span | undefined;

  function placeBand(band: HTMLElement, span: Span | undefined): void {
    setShown(band, span !== undefined);
    if (!span) return;
    const width = over.clientWidth;
    const inside = (time: number) => Math.min(width, Math.max(0, plot.valToPos(time, "x")));
    const [left, right] = [inside(span.from), inside(span.to)];
    band.style.left = `${left}px`;
    band.style.width = `${right - left}px`;
    setShown(band, right > 0 && left < width);
  }
  const place = () => {
    placeBand(selection, view.selection);
    placeBand(zoom, zoomed);
  };
  const leftOf = (event: PointerEvent) => event.clientX - over.getBoundingClientRect().left;
  const timeAt = (left: number) => plot.posToVal(Math.min(over.clientWidth, Math.max(0, left)), "x");
  /// The selection's other end, if the pointer is on an edge of it.
  function otherEnd(left: number): number | undefined {
    const { selection: span } = view;
    if (!span) return undefined;
    if (Math.abs(plot.valToPos(span.from, "x") - left) <= kEdge) return span.to;
    return Math.abs(plot.valToPos(span.to, "x") - left) <= kEdge ? span.from : undefined;
  }

  over.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    const left = leftOf(event);
    const other = otherEnd(left);
    const selecting = other !== undefined || event.shiftKey || selects();
    drag = { id: event.pointerId, left, anchor: other ?? timeAt(left), selects: selecting, moved: false };
    over.setPointerCapture?.(event.pointerId);
  });
  over.addEventListener("pointermove", (event) => {
    const left = leftOf(event);
    if (!drag || drag.id !== event.pointerId) {
      over.classList.toggle("on-edge", otherEnd(left) !== undefined);
      return;
    }
    if (!drag.moved && Math.abs(left - drag.left) < kDrag) return;
    if (!drag.moved) view.hold();
    drag.moved = true;
    const span = ordered(drag.anchor, timeAt(left));
    if (drag.selects) view.selection = span;
    else zoomed = span;
    place();
  });
  const end = (event: PointerEvent) => {
    if (!drag || drag.id !== event.pointerId) return;
    const { moved } = drag;
    drag = undefined;
    if (!moved) return;
    view.release();
    const span = zoomed;
    zoomed = undefined;
    if (span && event.type === "pointerup" && lengthOf(span) > 0) view.zoom = span;
    place();
  };
  over.addEventListener("pointerup", end);
  over.addEventListener("pointercancel", end);
  over.addEventListener("dblclick", () => (view.zoom = undefined));
  return { place };
}
