// SPDX-License-Identifier: Apache-2.0
// Digits that began inside the object: which they are, what to do, and their opening, which the operator confirms.
import { type Opening, Opening_Phase, SafetyState } from "../gen/phalanx/tick_pb";
import { mayChange } from "../state/roles";
import { strings } from "../strings";
import { refusal, type App } from "./app";
import { openDialog } from "./dialog";
import { button, el, setShown, setText } from "./dom";
import type { Readouts } from "./readouts";

const words = strings.openings;
const joined = new Intl.ListFormat(strings.locale);

/// The sentences about these digits; empty: all digits feel.
export function openingsText(openings: readonly Opening[]): string {
  const sentence = (phase: Opening_Phase, one: (digit: string) => string, several: (digits: string) => string) => {
    const names = openings.filter((opening) => opening.phase === phase).flatMap((opening) => words.digits[opening.digit] ?? []);
    if (names.length === 0) return [];
    return [(names.length === 1 ? one : several)(joined.format(names))];
  };
  return [
    ...sentence(Opening_Phase.CONFIRMED, words.confirmed.one, words.confirmed.several),
    ...sentence(Opening_Phase.NOT_FOLLOWED, words.notFollowed.one, words.notFollowed.several),
    ...sentence(Opening_Phase.UNCONFIRMED, words.unconfirmed.one, words.unconfirmed.several),
  ].join(" ");
}

/// While forces are on, the operator has a button. It asks with the digits that wait and with their ways, which the person then reads.
export function openings(app: App): Readouts {
  const line = el("p", { role: "status" });
  const error = el("p", { class: "refused", role: "alert", hidden: true });
  const say = (text: string) => {
    setText(error, text);
    setShown(error, text !== "");
  };
  const now = () => (app.store.lost ? [] : (app.store.tick?.opening ?? []));
  const waiting = () => now().filter((opening) => opening.phase !== Opening_Phase.CONFIRMED && words.digits[opening.digit] !== undefined);
  const ask = () => {
    const choices = waiting().map((seen) =>
      button(words.choice(words.digits[seen.digit] ?? "", (1000 * seen.way).toFixed(0)), () => {
        dialog.close();
        void app.host.openDigit(seen).then((answer) => say(refusal(answer)));
      }));
    const cancel = button(strings.role.cancel, () => dialog.close());
    const dialog = openDialog(app, words.title, [el("p", {}, words.ask), el("div", { class: "opening-choices" }, ...choices), el("div", { class: "buttons" }, cancel)]);
    cancel.focus();
  };
  const open = button(words.open, ask, { hidden: true });
  const element = el("div", { class: "openings" }, el("div", { class: "silent-digits" }, line, open), error);
  const update = () => {
    setText(line, openingsText(now()));
    if (now().length === 0) say("");
    const may = mayChange(app.store.role) && app.store.state?.rendersTorque === true && app.store.tick?.state === SafetyState.SAFETY_RUNNING;
    setShown(open, may && waiting().length > 0);
  };
  update();
  return { element, update };
}
