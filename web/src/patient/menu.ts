// SPDX-License-Identifier: Apache-2.0
// The therapist's choices for this screen, behind a button in a corner.
import { el, setShown, setSwitch, switchButton } from "../panels/dom";
import { linePicture } from "./pictures";
import type { Options } from "./options";
import { languageCode, patientLanguages, words } from "./words";

export interface Menu {
  readonly opener: HTMLElement;
  readonly element: HTMLElement;
  /// What is behind the open menu cannot be reached. @param behind  elements that are
  hold(behind: readonly HTMLElement[]): void;
  update(options: Options): void;
  /// Offers to sign this screen in.
  offerSignIn(offered: boolean): void;
  /// Closes it, if it is open.
  close(): void;
}

type Flag = "aphasia" | "numbers" | "sound" | "speech" | "calm" | "contrast";

/// A row of choices of which one holds.
function choice(label: string, names: readonly (readonly [string, string])[], choose: (value: string) => void): { element: HTMLElement; set(value: string): void } {
  const buttons = names.map(([value, text]) => {
    const button = el("button", { type: "button", class: "choice", "aria-pressed": "false", "data-value": value }, text);
    button.addEventListener("click", () => choose(value));
    return button;
  });
  const element = el("div", { class: "menu-row", role: "group", "aria-label": label }, el("p", {}, label), el("div", { class: "menu-choices" }, ...buttons));
  return { element, set: (value) => buttons.forEach((button) => button.setAttribute("aria-pressed", String(button.dataset["value"] === value))) };
}

/// @param change  takes what was chosen  @param signIn  opens the form
export function menu(change: (options: Partial<Options>) => void, signIn: () => void): Menu {
  const flags: readonly Flag[] = ["aphasia", "numbers", "sound", "speech", "calm", "contrast"];
  const switches = new Map<Flag, HTMLElement>(flags.map((flag) => [flag, switchButton(words.menu[flag], (on) => change({ [flag]: on }), { class: "switch menu-switch" })]));
  switches.get("aphasia")!.append(el("small", {}, words.menu.aphasiaMore));
  const language = choice(words.menu.language, Object.keys(patientLanguages).map((code) => [code, words.languages[code] ?? code]), (code) => change({ language: code }));
  const sides = [["left", words.menu.left], ["centre", words.menu.centre], ["right", words.menu.right]] as const;
  const cues = choice(words.menu.cues, sides, (side) => change({ cues: side as Options["cues"] }));
  const title = el("h2", { id: "menu-title" }, words.menu.title);
  const close = el("button", { type: "button", class: "soft menu-close" }, words.menu.close);
  const enter = el("button", { type: "button", class: "soft menu-sign-in", hidden: true }, words.signIn.title);
  // It is not modal: the bar beside it, with STOP, stays in reach of screen readers, too.
  const panel = el(
    "div",
    { class: "menu-panel", role: "dialog", "aria-modal": "false", "aria-labelledby": "menu-title" },
    el("div", { class: "menu-head" }, title, close), enter, language.element, cues.element,
    el("div", { class: "menu-switches" }, ...switches.values()), el("p", { class: "menu-note" }, words.menu.note),
  );
  const element = el("div", { class: "menu", hidden: true }, panel);
  const opener = el("button", { type: "button", class: "menu-opener", "aria-label": words.menu.open, title: words.menu.open, "aria-expanded": "false" });
  opener.append(linePicture("menu"));
  let others: readonly HTMLElement[] = [];
  const show = (open: boolean) => {
    element.hidden = !open;
    opener.setAttribute("aria-expanded", String(open));
    for (const other of others) other.inert = open;
    (open ? close : opener).focus();
  };
  opener.addEventListener("click", () => show(true));
  close.addEventListener("click", () => show(false));
  enter.addEventListener("click", () => {
    show(false);
    signIn();
  });
  return {
    opener,
    element,
    hold: (behind) => void (others = behind),
    offerSignIn: (offered) => setShown(enter, offered),
    close() {
      if (!element.hidden) show(false);
    },
    update(options) {
      language.set(languageCode);
      cues.set(options.cues);
      for (const [flag, button] of switches) setSwitch(button, options[flag]);
    },
  };
}
