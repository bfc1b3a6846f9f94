// SPDX-License-Identifier: Apache-2.0
// How the hand is shown: its skin tone, and how many views are side by side.
import { strings } from "../strings";
import { kMostViews } from "../view3d/panes";
import { kSkinTones, kUsualTone, skinTones, type SkinToneName } from "../view3d/skin_tones";
import { radioGroup, type RadioGroup } from "./radio_group";

const words = strings.view;

export function skinToneChoice(picked: (tone: SkinToneName) => void): RadioGroup<SkinToneName> {
  const options = kSkinTones.map((value) => ({ value, name: words.skinTones[value], colour: skinTones[value].skin }));
  return radioGroup("phalanx.skin", words.skinTone, "skin-tones", options, kUsualTone, picked);
}

export function viewCountChoice(picked: (count: number) => void): RadioGroup<number> {
  const counts = Array.from({ length: kMostViews }, (_, i) => i + 1);
  const options = counts.map((value) => ({ value, name: words.viewCount(value), text: String(value) }));
  return radioGroup("phalanx.views", words.views, "view-counts", options, 1, picked);
}
