// SPDX-License-Identifier: Apache-2.0
// Tones of the shown hand's skin, from light to dark. The palm is lighter and differs less from tone to tone, as it does in people.

export interface SkinTone {
  readonly skin: string;
  readonly palm: string;
  readonly flush: string; // of fingertips and knuckles
  readonly nail: string;
}

export const kSkinTones = ["porcelain", "light", "tan", "olive", "brown", "deep"] as const;
export type SkinToneName = (typeof kSkinTones)[number];
export const kUsualTone: SkinToneName = "light";

export const skinTones: Readonly<Record<SkinToneName, SkinTone>> = {
  porcelain: { skin: "#ecd0bd", palm: "#f1d5c8", flush: "#e3a391", nail: "#f0c6b8" },
  light: { skin: "#dab8a2", palm: "#e6c2ab", flush: "#cf8b72", nail: "#e9bda8" },
  tan: { skin: "#c4936c", palm: "#d9ad8c", flush: "#b06d4f", nail: "#dba98c" },
  olive: { skin: "#a5764e", palm: "#cb9c78", flush: "#8c5439", nail: "#cf9c7e" },
  brown: { skin: "#7a5137", palm: "#b98a6a", flush: "#5f3a2a", nail: "#c19379" },
  deep: { skin: "#4f3425", palm: "#a0755a", flush: "#3c2620", nail: "#ad8069" },
};
