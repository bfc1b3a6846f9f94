// SPDX-License-Identifier: Apache-2.0
// What an object of a kind is made of.

export interface ObjectLook {
  readonly colour: string;
  readonly roughness: number; // 0 a mirror .. 1 matt
  readonly metalness: number;
  readonly coat: number; // of clear glaze or varnish, 0 .. 1
  readonly grain: boolean; // wood
  readonly opacity: number; // below 1 where the quality allows it
}

const matt: ObjectLook = { colour: "#98a1ab", roughness: 0.82, metalness: 0, coat: 0, grain: false, opacity: 1 };
const ceramic: ObjectLook = { ...matt, colour: "#cdd6d4", roughness: 0.32, coat: 0.9 };
const rubber: ObjectLook = { ...matt, colour: "#3d7f8c", roughness: 0.68 };
const wood: ObjectLook = { ...matt, colour: "#b98a58", roughness: 0.6, coat: 0.15, grain: true };
const steel: ObjectLook = { ...matt, colour: "#bfc5cb", roughness: 0.3, metalness: 1 };
const glass: ObjectLook = { ...matt, colour: "#b5d3cf", roughness: 0.12, coat: 0.6, opacity: 0.62 };

/// By kinds as scenes name them.
const looks: Readonly<Record<string, ObjectLook>> = {
  teapot: ceramic,
  mug: { ...ceramic, colour: "#5f86a8" },
  cup: { ...ceramic, colour: "#ece6d8" },
  sphere: rubber,
  therapy_ball: { ...rubber, colour: "#6d7fb3" },
  box: wood,
  peg: wood,
  cylinder: wood,
  key: { ...steel, colour: "#c9b98a" },
  tap_handle: steel,
  torus: steel,
  bottle: glass,
  jar: { ...glass, colour: "#cfd8d2" },
  pen: { ...matt, colour: "#2f4f8a", roughness: 0.36, coat: 0.4 },
  putty_bar: { ...matt, colour: "#b7a4c4", roughness: 0.95 },
};

/// A mesh of one's own, and what is not known, is matt and of no colour.
export function lookOf(kind: string): ObjectLook {
  return looks[kind] ?? matt;
}
