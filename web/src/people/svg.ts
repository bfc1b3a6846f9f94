// SPDX-License-Identifier: Apache-2.0
// Elements of drawings in short.

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
