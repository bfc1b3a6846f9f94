// SPDX-License-Identifier: Apache-2.0
// What is wrong with the places of things on a page, and the sizes of screens that people have.

export const kSizes: readonly (readonly [width: number, height: number])[] = [
  [1920, 1080], [1440, 900], [1366, 768], [1280, 720], [1150, 760], [1024, 768], [768, 1024], [390, 844],
  [720, 450], [960, 540], [683, 384], // 1440 x 900, 1920 x 1080 and 1366 x 768 at 200 %
];

/// Runs in the page. @returns what is wrong there, in words; nothing: all is well
export function faultsOfLayout(): string[] {
  const kSlack = 1; // [px], for fractions
  const faults: string[] = [];
  const say = (what: string) => faults.push(what);
  const nameOf = (element: Element) => `${element.tagName.toLowerCase()} "${(element.getAttribute("aria-label") ?? element.textContent ?? "").trim().slice(0, 30)}"`;
  const within = (inner: DOMRect, outer: { left: number; right: number; top: number; bottom: number }) =>
    inner.left >= outer.left - kSlack && inner.right <= outer.right + kSlack && inner.top >= outer.top - kSlack && inner.bottom <= outer.bottom + kSlack;
  const screen = { left: 0, top: 0, right: innerWidth, bottom: innerHeight };
  const shown = (element: Element) => element.checkVisibility({ visibilityProperty: true }) && element.getBoundingClientRect().width > 1;
  /// Nothing but the element itself is at its middle and near its left and right ends.
  const uncovered = (element: Element) => {
    const box = element.getBoundingClientRect();
    return [0.1, 0.5, 0.9].every((share) => {
      const hit = document.elementFromPoint(box.left + share * box.width, box.top + box.height / 2);
      return hit !== null && (element.contains(hit) || hit.contains(element));
    });
  };

  const root = document.scrollingElement!;
  root.scrollTo(0, 0);
  root.scrollTo(10_000, 10_000);
  if (root.scrollLeft !== 0 || root.scrollTop !== 0) say(`the document scrolls by ${root.scrollLeft}, ${root.scrollTop}`);
  root.scrollTo(0, 0);
  for (const scroller of document.querySelectorAll(".tab-panels, .content, .dock, .dialog-body")) {
    if (scroller.scrollWidth <= scroller.clientWidth + kSlack || !shown(scroller)) continue;
    const edge = scroller.getBoundingClientRect().right;
    const beyond = [...scroller.querySelectorAll("*")].filter((inner) => shown(inner) && inner.getBoundingClientRect().right > edge + kSlack).map(nameOf);
    say(`.${scroller.className} is ${scroller.scrollWidth - scroller.clientWidth} px too wide: ${beyond.slice(0, 4).join(", ")}`);
  }
  const question = document.querySelector(".dialogs:not([hidden])"); // what it lies over waits for the answer
  for (const control of document.querySelectorAll("button:enabled, input:enabled:not([type=file]), summary, [role=option]")) {
    if (!shown(control) || control.closest("fieldset:disabled") || (question && !control.closest(".dialog, .dock"))) continue;
    control.scrollIntoView({ block: "nearest", inline: "nearest" });
    const box = control.getBoundingClientRect();
    const around = control.closest(".view-parts-list, .view-frame, .tab-panels, .stop-box, .plots, .toasts, .header, .tabs, .dialog, .calibration, .role-strip, .openings, .story");
    if (!around || !within(box, around.getBoundingClientRect())) say(`${nameOf(control)} is not inside .${around?.className}`);
    if (!within(box, screen)) say(`${nameOf(control)} is not on the screen`);
    if (!uncovered(control)) say(`${nameOf(control)} is covered`);
  }
  const host = document.querySelector(".view-host")!;
  host.scrollIntoView({ block: "nearest" });
  const view = host.getBoundingClientRect();
  for (const over of document.querySelectorAll(".view-cameras, .toasts, .stop-box")) {
    const box = over.getBoundingClientRect();
    if (shown(over) && box.left < view.right && box.right > view.left && box.top < view.bottom - kSlack && box.bottom > view.top + kSlack) say(`.${over.className} lies over the hand`);
  }
  const note = document.querySelector(".silent-digits:has(p:not(:empty))");
  if (note) {
    note.scrollIntoView({ block: "nearest" });
    if (!within(note.getBoundingClientRect(), screen) || (!question && !uncovered(note))) say("which digits are silent is not wholly in sight");
    if (note.scrollWidth > note.clientWidth + kSlack || note.scrollHeight > note.clientHeight + kSlack) say("which digits are silent is cut off");
  }
  const stop = document.querySelector(".stop")!;
  for (const scroller of document.querySelectorAll(".dock, .dock *")) scroller.scrollTop = scroller.scrollHeight; // as a hand may have left it
  if (!within(stop.getBoundingClientRect(), screen) || !uncovered(stop)) say("STOP is not wholly in sight");
  return faults;
}

/// Runs in the page. @returns the place of Stop, rounded [px]
export function placeOfStop(): readonly number[] {
  for (const scroller of document.querySelectorAll(".dock, .dock *")) scroller.scrollTop = scroller.scrollHeight;
  const box = document.querySelector(".stop")!.getBoundingClientRect();
  return [box.left, box.top, box.right, box.bottom].map(Math.round);
}

/// Runs in the page. @returns pairs of texts in sight that lie over each other
export function overlappingTexts(): string[] {
  const kSlack = 2; // [px] of glyphs' boxes
  const kSparse = 0.25; // of a line that is empty above and below its glyphs
  interface Seen {
    readonly text: string;
    readonly element: Element;
    readonly box: { left: number; right: number; top: number; bottom: number };
  }
  const seen: Seen[] = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const text = (node.textContent ?? "").trim();
    const element = node.parentElement;
    if (text === "" || !element?.checkVisibility({ opacityProperty: true, visibilityProperty: true }) || element.closest(".visually-hidden, noscript, script, style")) continue;
    const range = document.createRange();
    range.selectNodeContents(node);
    for (const rect of range.getClientRects()) {
      let box = { left: rect.left, right: rect.right, top: rect.top, bottom: rect.bottom };
      for (let at: Element | null = element; at; at = at.parentElement) {
        const style = getComputedStyle(at);
        if (style.overflowX === "visible" && style.overflowY === "visible") continue;
        const frame = at.getBoundingClientRect();
        box = { left: Math.max(box.left, frame.left), right: Math.min(box.right, frame.right), top: Math.max(box.top, frame.top), bottom: Math.min(box.bottom, frame.bottom) };
      }
      if (box.right - box.left <= kSlack || box.bottom - box.top <= kSlack) continue;
      const hit = document.elementFromPoint((box.left + box.right) / 2, (box.top + box.bottom) / 2);
      if (hit && (element.contains(hit) || hit.contains(element))) seen.push({ text: text.slice(0, 40), element, box });
    }
  }
  const found = new Set<string>();
  seen.forEach((one, i) => {
    for (const other of seen.slice(i + 1)) {
      if (one.element === other.element) continue;
      const wide = Math.min(one.box.right, other.box.right) - Math.max(one.box.left, other.box.left);
      const high = Math.min(one.box.bottom, other.box.bottom) - Math.max(one.box.top, other.box.top);
      const least = Math.min(one.box.bottom - one.box.top, other.box.bottom - other.box.top);
      if (wide > kSlack && high > Math.max(kSlack, kSparse * least)) found.add(`"${one.text}" and "${other.text}"`);
    }
  });
  return [...found];
}
