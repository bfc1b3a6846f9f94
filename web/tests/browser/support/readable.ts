// SPDX-License-Identifier: Apache-2.0
// Whether the text on a page can be read: none is cut off, all stands out from what is behind it, and Stop is never covered.
import { expect } from "vitest";
import type { CockpitPage } from "./cockpit_page";
import { shoot } from "./pictures";

export interface Unreadable {
  readonly cut: readonly string[];
  readonly faint: readonly string[];
  readonly sideways: number; // pixels that the page is too wide
}

/// Runs in the page. Contrast as WCAG 2 has it: 4.5 : 1, 3 : 1 for large type; controls that are switched off are exempt there.
function lookAtText(): Unreadable {
  const kContrast = 4.5;
  const kLargeContrast = 3;
  const canvas = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true })!;
  const rgba = (colour: string): [number, number, number, number] => {
    canvas.clearRect(0, 0, 1, 1);
    canvas.fillStyle = colour;
    canvas.fillRect(0, 0, 1, 1);
    const [r, g, b, a] = canvas.getImageData(0, 0, 1, 1).data;
    return [r!, g!, b!, a! / 255];
  };
  const over = (top: readonly number[], below: readonly number[]) => [0, 1, 2].map((i) => top[i]! * top[3]! + below[i]! * (1 - top[3]!));
  const luminance = (colour: readonly number[]) => {
    const [r, g, b] = colour.map((value) => (value / 255 <= 0.04045 ? value / 255 / 12.92 : ((value / 255 + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r! + 0.7152 * g! + 0.0722 * b!;
  };
  const ancestors = (element: Element): Element[] => {
    const all: Element[] = [];
    for (let at: Element | null = element; at; at = at.parentElement) all.push(at);
    return all;
  };
  /// What is behind a text; null: a picture or a gradient, whose colour no style tells.
  const behind = (element: Element): number[] | null => {
    const layers: [number, number, number, number][] = [];
    for (const at of ancestors(element)) {
      const style = getComputedStyle(at);
      if (style.backgroundImage !== "none") return null;
      const colour = rgba(style.backgroundColor);
      if (colour[3] > 0) layers.push(colour);
      if (colour[3] === 1) break;
      if (at.matches(".view-frame")) return null;
    }
    return layers.reverse().reduce<number[]>((below, layer) => over(layer, below), [255, 255, 255]);
  };
  const off = (element: Element) =>
    ancestors(element).some((at) => at.matches(":disabled, [aria-disabled=true]") || (at instanceof HTMLFieldSetElement && at.disabled)) ||
    (element.closest("label") as HTMLLabelElement | null)?.control?.matches(":disabled") === true;

  const cut: string[] = [];
  const faint: string[] = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const text = (node.textContent ?? "").trim();
    const element = node.parentElement;
    if (text === "" || !element || element.closest(".visually-hidden, noscript, script, style, [aria-hidden=true], option, canvas")) continue;
    if (!element.checkVisibility({ opacityProperty: true, visibilityProperty: true })) continue;
    const range = document.createRange();
    range.selectNodeContents(node);
    const rects = [...range.getClientRects()].filter((rect) => rect.width > 1 && rect.height > 1);
    if (rects.length === 0) continue;
    const name = `"${text.slice(0, 50)}" in ${element.tagName.toLowerCase()}.${element.className}`;
    for (const at of ancestors(element)) {
      const style = getComputedStyle(at);
      const box = at.getBoundingClientRect();
      // What can be scrolled to is not cut off, nor what the whole of it is told by a title.
      const scrolls = style.overflowY === "auto" || style.overflowY === "scroll" || style.overflowX === "auto" || style.overflowX === "scroll";
      if (scrolls || (style.textOverflow === "ellipsis" && (at.getAttribute("title") ?? "") !== "")) break;
      const clips = (overflow: string) => overflow === "hidden" || overflow === "clip";
      const wide = clips(style.overflowX) && rects.some((rect) => rect.right > box.right + 1.5 || rect.left < box.left - 1.5);
      const high = clips(style.overflowY) && rects.some((rect) => rect.bottom > box.bottom + 3 || rect.top < box.top - 3);
      if (wide || high) {
        cut.push(`${name}: beyond ${at.tagName.toLowerCase()}.${at.className}`);
        break;
      }
    }
    const below = behind(element);
    if (below && !off(element)) {
      const style = getComputedStyle(element);
      const colour = rgba(style.color);
      const opacity = ancestors(element).reduce((product, at) => product * Number(getComputedStyle(at).opacity), 1);
      const seen = over([colour[0], colour[1], colour[2], colour[3] * opacity], below);
      const [light, dark] = [luminance(seen), luminance(below)].sort((a, b) => b - a);
      const contrast = (light! + 0.05) / (dark! + 0.05);
      const size = parseFloat(style.fontSize);
      const large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
      if (contrast < (large ? kLargeContrast : kContrast)) faint.push(`${name}: contrast ${contrast.toFixed(2)}`);
    }
  }
  for (const field of document.querySelectorAll<HTMLElement>("button, input[type=text]")) {
    const told = field instanceof HTMLInputElement && field.title === field.value; // by its title
    if (!told && field.checkVisibility() && !field.closest(".visually-hidden") && field.scrollWidth > field.clientWidth + 1) {
      cut.push(`the ${field.tagName.toLowerCase()} "${field.getAttribute("aria-label") ?? field.innerText}" is ${field.scrollWidth - field.clientWidth} px too narrow`);
    }
  }
  const root = document.scrollingElement!;
  return { cut: [...new Set(cut)], faint: [...new Set(faint)], sideways: Math.max(0, root.scrollWidth - root.clientWidth) };
}

/// Takes the picture, then asks whether all of it can be read.
export async function shootReadable(cockpit: CockpitPage, name: string): Promise<void> {
  await shoot(cockpit.page, name);
  const found = await cockpit.page.evaluate(lookAtText);
  expect.soft(found, name).toEqual({ cut: [], faint: [], sideways: 0 });
  await expectStopInSight(cockpit, name);
}

async function expectStopInSight(cockpit: CockpitPage, name: string): Promise<void> {
  const hit = await cockpit.stopButton.evaluate((button) => {
    const box = button.getBoundingClientRect();
    const inside = box.top >= -1 && box.left >= -1 && box.bottom <= innerHeight + 1 && box.right <= innerWidth + 1;
    const points = [0.2, 0.5, 0.8].map((share) => document.elementFromPoint(box.left + share * box.width, box.top + box.height / 2));
    return inside && points.every((element) => element !== null && button.contains(element));
  });
  expect.soft(hit, `${name}: Stop is in sight and nothing lies over it`).toBe(true);
}
