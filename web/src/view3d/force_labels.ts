// SPDX-License-Identifier: Apache-2.0
// Figures at the arrows' tips, as text over the picture. Those that would overlap move down.
import { Vector3 } from "three";
import type { Camera } from "three";

export interface ForceLabel {
  readonly text: string;
  readonly tip: readonly [number, number, number]; // W [m]
  readonly felt: boolean;
}

const kHeight = 17; // of a label [pixels of the style sheet]
const kBreadth = 7; // of a letter
const kAside = 6; // from the tip

interface Placed {
  readonly left: number;
  readonly top: number;
  readonly width: number;
}

/// Free places for labels that want to be at these; earlier ones stay where they are.
export function apart(wanted: readonly Placed[]): Placed[] {
  const placed: Placed[] = [];
  for (const { left, width, top } of wanted) {
    let at = top;
    const beside = placed.filter((other) => left < other.left + other.width && other.left < left + width).sort((a, b) => a.top - b.top);
    for (const other of beside) if (at < other.top + kHeight && other.top < at + kHeight) at = other.top + kHeight;
    placed.push({ left, top: at, width });
  }
  return placed;
}

/// A label in the picture, from its upper left corner [pixels of the style sheet].
export interface PlacedLabel {
  readonly label: ForceLabel;
  readonly left: number;
  readonly top: number;
}

/// @param width, height  of the picture [pixels of the style sheet]
export function placedLabels(labels: readonly ForceLabel[], camera: Camera, width: number, height: number): PlacedLabel[] {
  const tip = new Vector3();
  const seen = labels.flatMap((label) => {
    tip.set(...label.tip).project(camera);
    if (!(Math.abs(tip.x) < 1 && Math.abs(tip.y) < 1 && tip.z < 1)) return [];
    const breadth = kBreadth * label.text.length;
    const left = Math.min(((tip.x + 1) / 2) * width + kAside, width - breadth);
    return [{ label, at: { left, top: Math.max(0, ((1 - tip.y) / 2) * height - kHeight / 2), width: breadth } }];
  });
  const places = apart(seen.map(({ at }) => at));
  return seen.map(({ label }, i) => ({ label, left: places[i]!.left, top: places[i]!.top }));
}

export class ForceLabels {
  readonly element = document.createElement("div");
  private readonly spans: HTMLElement[] = [];

  constructor() {
    this.element.className = "force-labels";
    this.element.ariaHidden = "true"; // the figures above the view say it
  }

  show(seen: readonly PlacedLabel[]): void {
    while (this.spans.length < seen.length) this.spans.push(this.element.appendChild(document.createElement("span")));
    this.spans.forEach((span, i) => {
      const one = seen[i];
      span.hidden = one === undefined;
      if (!one) return;
      if (span.textContent !== one.label.text) span.textContent = one.label.text;
      span.dataset["felt"] = String(one.label.felt);
      span.style.transform = `translate(${one.left.toFixed(1)}px, ${one.top.toFixed(1)}px)`;
    });
  }
}
