// SPDX-License-Identifier: Apache-2.0
// The one thing that the screen says now, in the patient's words.
import type { ExerciseStrings } from "../strings/exercise_en";
import type { PatientStrings } from "../strings/patient_en";
import type { ExerciseNow } from "./game";
import type { Known } from "./state";

type Told = Pick<ExerciseStrings, "goals" | "moves" | "fingers">;

/// Kinds of screen. play: a game, with its goal above it; rating: faces; answer: pictures to choose from.
export type Screen = "wait" | "greet" | "ready" | "play" | "rest" | "rating" | "answer" | "break" | "done";

export interface Goal {
  readonly screen: Screen;
  readonly text: string;
  readonly more: string; // a smaller line; empty: none
  readonly picture: "" | "symbol" | "hand" | "second" | "cup" | "stop" | "helper" | "pain" | "tired" | "line" | "lights"; // beside the words
}

/// The finger that an instruction ends with: "Move only this finger (ring)".
const fingers = ["thumb", "index", "middle", "ring", "little"];
const named = /^(.*?) \((thumb|index|middle|ring|little)\)$/;
const held = /^Stop, and hold it\.$/;
const second = /^Let go\. The second/;

/// Whether the station asks to keep what the hand does now.
export const holdsStill = ({ phase, instruction }: Pick<ExerciseNow, "phase" | "instruction">): boolean => phase === "trial" && held.test(instruction);
const only = /^(Straighten|Bend) only the (thumb|index|middle|ring|little) finger\.$/;

/// The instruction of a trial in the language of `texts`. An exercise file's own words stay as they are.
export function instructionText(now: { readonly instruction: string; readonly measure: string; readonly target: { readonly kind: string } }, texts: Told): string {
  const { instruction, target, measure } = now;
  const single = only.exec(instruction);
  if (single) {
    const finger = texts.fingers[fingers.indexOf(single[2]!)]!;
    return single[1]!.startsWith("B") ? texts.moves.bend(finger) : texts.moves.straighten(finger);
  }
  if (target.kind === "open") return measure === "squeeze_release" ? texts.moves.letGo : texts.moves.open;
  if (target.kind === "close") return texts.moves.close;
  if (held.test(instruction)) return texts.moves.hold;
  const parts = named.exec(instruction);
  const said = parts?.[1] ?? instruction;
  const goal = texts.goals[said] ?? said.replace(/\.$/, "");
  if (!parts) return goal;
  const finger = texts.fingers[fingers.indexOf(parts[2]!)]!;
  return target.kind === "touch" ? texts.moves.touch(finger) : texts.moves.with(goal, finger);
}

export function choiceText(choice: string, texts: Pick<ExerciseStrings, "choices">): string {
  return texts.choices[choice] ?? choice.charAt(0).toUpperCase() + choice.slice(1);
}

function runningGoal(now: ExerciseNow, texts: PatientStrings): Goal {
  const { screen } = texts;
  switch (now.phase) {
    case "ready":
      return { screen: "ready", text: screen.ready, more: `${texts.hands[now.side]}. ${screen.readyMore}`, picture: "symbol" };
    case "warm_up":
      return { screen: "rest", text: screen.warmUp, more: "", picture: "" };
    case "rating":
      return { screen: "rating", text: now.asks === "tired" ? texts.rating.tired : texts.rating.pain, more: texts.rating.more, picture: now.asks ?? "pain" };
    case "rest":
      return second.test(now.instruction) ? { screen: "rest", text: screen.second, more: "", picture: "second" } : { screen: "rest", text: screen.rest, more: "", picture: "hand" };
    case "trial":
      return { screen: "play", text: instructionText(now, texts), more: "", picture: "" };
    case "answer":
      return { screen: "answer", text: now.measure === "feel_and_find" ? screen.softer : screen.which, more: screen.answerMore, picture: "" };
    case "paused":
      return { screen: "break", text: screen.paused, more: screen.pausedMore, picture: "cup" };
    case "done":
      return { screen: "done", text: screen.closing, more: screen.doneMore, picture: "lights" };
  }
}

/// @param ownBreak  the patient has asked for this pause
export function goalOf(known: Known, texts: PatientStrings, ownBreak = false): Goal {
  const { screen } = texts;
  const wait = (text: string, more: string, picture: Goal["picture"] = ""): Goal => ({ screen: "wait", text, more, picture });
  switch (known.connected) {
    case "replaced":
      return wait(screen.elsewhere, screen.elsewhereMore, "helper");
    case "expired":
      return wait(screen.expired, screen.expiredMore, "helper");
    case "mismatch":
      return wait(screen.mismatch, screen.mismatchMore, "helper");
    case "open":
      break;
    default:
      return known.ever ? wait(screen.lost, screen.lostMore, "line") : wait(screen.connecting, screen.connectingMore, "line");
  }
  const now = known.exercise;
  if (!now || now.stage === "none") return { screen: "greet", text: screen.waiting, more: screen.waitingMore, picture: "hand" };
  switch (now.stage) {
    case "opening":
      return { screen: "greet", text: screen.opening, more: `${texts.hands[now.side]}. ${screen.openingMore}`, picture: "symbol" };
    case "closing":
      return { screen: "done", text: screen.closing, more: screen.doneMore, picture: "lights" };
    case "ended":
      if (now.trouble !== "" && now.trial === 0) return wait(screen.trouble, screen.troubleMore, "helper");
      return { screen: "done", text: screen.done, more: screen.doneMore, picture: "lights" };
    default:
      break;
  }
  if (known.fault && now.phase !== "done") return { screen: "break", text: screen.fault, more: screen.faultMore, picture: "helper" };
  if (known.stopped && now.phase === "paused" && !ownBreak) return { screen: "break", text: screen.stopped, more: screen.stoppedMore, picture: "stop" };
  return runningGoal(now, texts);
}
