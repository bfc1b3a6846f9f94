// SPDX-License-Identifier: Apache-2.0
// Elements in short.

export type Child = Node | string | null | undefined;
export type Attributes = Readonly<Record<string, string | number | boolean | undefined>>;

/// An element with attributes (true: present, false or undefined: absent) and children.
export function el<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: readonly Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === false) continue;
    element.setAttribute(name, value === true ? "" : String(value));
  }
  for (const child of children) if (child !== null && child !== undefined) element.append(child);
  return element;
}

export function button(text: string, press: () => void, attributes: Attributes = {}): HTMLButtonElement {
  const element = el("button", { type: "button", ...attributes }, text);
  element.addEventListener("click", press);
  return element;
}

/// Writes only what differs: screen readers and layout are left in peace.
export function setText(node: Node, text: string): void {
  if (node.textContent !== text) node.textContent = text;
}

export function setShown(element: HTMLElement, shown: boolean): void {
  if (element.hidden === shown) element.hidden = !shown;
}

export function setAttribute(element: Element, name: string, value: string | null): void {
  if (element.getAttribute(name) === value) return;
  if (value === null) element.removeAttribute(name);
  else element.setAttribute(name, value);
}

/// A switch: a button, since Space means Stop on this page and Enter has to be enough.
export function switchButton(text: string, press: (on: boolean) => void, attributes: Attributes = {}): HTMLButtonElement {
  const element = el("button", { type: "button", role: "switch", "aria-checked": "false", class: "switch", ...attributes }, text);
  element.addEventListener("click", () => press(element.getAttribute("aria-checked") !== "true"));
  return element;
}

export function setSwitch(element: HTMLElement, on: boolean): void {
  setAttribute(element, "aria-checked", String(on));
}

let ids = 0;
export const newId = (what: string) => `${what}-${++ids}`;

/// A section with a heading.
export function section(title: string, ...children: readonly Child[]): HTMLElement {
  const id = newId("section");
  return el("section", { class: "section", "aria-labelledby": id }, el("h2", { id }, title), ...children);
}

// ---- drawings

const kNamespace = "http://www.w3.org/2000/svg";

export function svg<K extends keyof SVGElementTagNameMap>(tag: K, attributes: Readonly<Record<string, string | number>>): SVGElementTagNameMap[K] {
  const element = document.createElementNS(kNamespace, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  return element;
}

export function svgText(text: string, attributes: Readonly<Record<string, string | number>>): SVGTextElement {
  const element = svg("text", attributes);
  element.textContent = text;
  return element;
}
