// SPDX-License-Identifier: Apache-2.0
// Every state of the patient's screen, for tests and for looking at it.
import { Feel_Kind } from "../../src/gen/phalanx/cockpit_pb";
import * as exercises from "./patient_host";
import type { PatientHost } from "./patient_host";

export interface ScreenState {
  readonly name: string;
  readonly set: (host: PatientHost) => void;
  readonly query?: string; // of the page's address
  readonly press?: string; // a button that is pressed then
  readonly then?: (host: PatientHost) => void; // happens when the station has heard of that press
  readonly shown?: string; // value of data-screen that is waited for
}

const ready = { instruction: "Begin when you are ready." };
export const screenStates: readonly ScreenState[] = [
  { name: "greet", set: (host) => host.idle() },
  { name: "ready", set: (host) => host.show(ready) },
  { name: "warm_up", set: (host) => host.play(exercises.warming) },
  { name: "rest", set: (host) => host.play(exercises.resting) },
  { name: "river_tracking", set: (host) => host.play((t) => exercises.tracking(t)) },
  { name: "river_late", set: (host) => host.play((t) => exercises.tracking(t, 17)), query: "numbers=1" },
  { name: "river_press", set: (host) => host.play(exercises.pressing) },
  { name: "river_squeeze", set: (host) => host.play(exercises.squeezing) },
  { name: "range", set: (host) => host.play(exercises.ranging) },
  { name: "melody", set: (host) => host.play(exercises.opposing) },
  { name: "feel", set: (host) => host.play(exercises.feeling) },
  { name: "answer", set: (host) => host.show(exercises.answering) },
  { name: "answer_objects", set: (host) => host.show(exercises.naming) },
  { name: "pain", set: (host) => host.show(exercises.asking(Feel_Kind.PAIN)) },
  { name: "tired", set: (host) => host.show(exercises.asking(Feel_Kind.TIRED)) },
  { name: "pain_numbers", set: (host) => host.show(exercises.asking(Feel_Kind.PAIN)), query: "numbers=1" },
  { name: "pain_aphasia", set: (host) => host.show(exercises.asking(Feel_Kind.PAIN)), query: "aphasia=1" },
  { name: "pain_tapped", set: (host) => host.play((t) => exercises.tracking(t)), press: ".bar-pain" },
  { name: "paused", set: (host) => host.show(exercises.paused) },
  { name: "stopped", set: (host) => host.play((t) => exercises.tracking(t)), press: ".bar-stop" },
  { name: "fault", set: (host) => { host.fault = true; host.say(); host.show(exercises.paused); } },
  { name: "done", set: (host) => host.show(exercises.ended) },
  { name: "practice_watch", set: (host) => host.play(exercises.warming), query: "aphasia=1" },
  { name: "aphasia_trial", set: (host) => host.play(exercises.ranging), query: "aphasia=1" },
  { name: "cues_left", set: (host) => host.play((t) => exercises.tracking(t)), query: "cues=left" },
  { name: "cues_right", set: (host) => host.play((t) => exercises.tracking(t)), query: "cues=right" },
  { name: "contrast", set: (host) => host.play((t) => exercises.tracking(t)), query: "contrast=1" },
  { name: "menu", set: (host) => host.idle(), press: ".menu-opener" },
  { name: "left_hand", set: (host) => host.show({ ...ready, side: "left", symbol: "sun" }) },
  { name: "sign_in", set: (host) => { host.accounts = true; host.idle(); } },
  { name: "sign_in_playing", set: (host) => { host.accounts = true; host.play((t) => exercises.tracking(t)); }, shown: "play" },
  { name: "sign_in_answer", set: (host) => { host.accounts = true; host.show(exercises.naming); }, shown: "answer" },
  { name: "menu_playing", set: (host) => host.play((t) => exercises.tracking(t)), press: ".menu-opener", shown: "play" },
  { name: "went_on", set: (host) => host.play((t) => exercises.tracking(t)), press: ".bar-pain", then: (host) => host.goOn((t) => exercises.tracking(t)), shown: "play" },
  { name: "tired_in_pain", set: (host) => host.show(exercises.asking(Feel_Kind.PAIN)), press: ".bar-tired", shown: "rating" },
  { name: "rest_aphasia", set: (host) => host.play(exercises.resting), query: "aphasia=1", shown: "rest" },
  { name: "second_aphasia", set: (host) => host.play((t) => ({ ...exercises.feeling(t), ...exercises.lettingGo })), query: "aphasia=1", shown: "rest" },
  { name: "feel_aphasia", set: (host) => host.play(exercises.feeling), query: "aphasia=1", shown: "play" },
  { name: "trouble", set: (host) => host.show(exercises.troubled), shown: "wait" },
  { name: "lost", set: (host) => { host.show(ready); void host.cut(); }, shown: "wait" },
  { name: "lost_playing", set: (host) => { host.play((t) => exercises.tracking(t)); void host.cut(); }, shown: "wait" },
  { name: "expired", set: (host) => { host.expired = true; void host.cut(); }, shown: "wait" },
  { name: "replaced", set: (host) => host.replace(), shown: "wait" },
];
