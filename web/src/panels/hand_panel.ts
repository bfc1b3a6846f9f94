// SPDX-License-Identifier: Apache-2.0
// The hand: side, profile, and what moves it.
import { HandSource } from "../gen/phalanx/cockpit_pb";
import type { Store } from "../state/store";
import { quote, unquote } from "../state/toml";
import { strings } from "../strings";
import type { Change } from "../wire/host";
import { change, refusal, type App } from "./app";
import { ChoiceBox } from "./choice_box";
import { button, el, section, setAttribute, setShown, setText } from "./dom";
import { jointSliders } from "./joint_sliders";
import { choiceRow, guarded, row } from "./setting_controls";

const words = strings.hand;

function sourceSection(app: App): HTMLElement {
  const error = el("p", { class: "refused", role: "alert", hidden: true });
  const hint = el("p", { class: "hint" }, words.deviceHint);
  const choices = [HandSource.HAND_PATIENT, HandSource.HAND_SLIDERS].map((source) =>
    button(words.sources[source] ?? "", () => void choose(source), { "aria-pressed": "false", "data-source": source }),
  );
  async function choose(source: HandSource): Promise<void> {
    setText(error, refusal(await app.host.setSource(source)));
    setShown(error, error.textContent !== "");
  }
  const group = el("div", { class: "segmented", role: "group", "aria-label": words.source }, ...choices);
  const update = () => {
    const source = app.store.state?.source;
    for (const choice of choices) setAttribute(choice, "aria-pressed", String(Number(choice.dataset["source"]) === source));
    const device = source === HandSource.HAND_DEVICE;
    setShown(group, !device);
    setShown(hint, device);
  };
  app.store.on(["state"], update);
  update();
  return section(words.source, group, hint, error);
}

const statedSide = (store: Store) => unquote(store.value("hand.side")) || "right";

function currentSide(store: Store): string {
  const mirrored = store.value("mirror") === "true";
  return (statedSide(store) === "left") !== mirrored ? "left" : "right";
}

const takenBack = (store: Store, settings: readonly string[]): readonly Change[] => settings.filter((one) => store.changed(one)).map((one) => [one, ""]);

/// The other hand is the whole scene in a mirror: its objects lie where they lay, seen from the hand.
function sideChanges(store: Store, wanted: string): readonly Change[] {
  const own = store.changed("hand.side") ? "right" : statedSide(store);
  return [...takenBack(store, ["hand.side"]), ["mirror", String(wanted !== own)]];
}

function handSection(app: App): HTMLElement {
  const box = new ChoiceBox(() => choose());
  const made = row(words.profile, box);
  const profile = "hand.profile";
  const side = choiceRow(app, "hand.side", words.side, { right: words.right, left: words.left }, (wanted) => sideChanges(app.store, wanted), () => currentSide(app.store));
  const profileSide = el("p", { class: "hint" });
  function choose(): void {
    made.refuse("");
    if (box.value === unquote(app.store.value(profile))) return;
    // A profile states the side of its hand.
    const changes: readonly Change[] = box.value === "" ? [[profile, ""]] : [...takenBack(app.store, ["hand.side", "hand.file", "mirror"]), [profile, quote(box.value)]];
    void change(app, changes).then((refused) => {
      made.refuse(refused);
      update();
    });
  }
  const update = () => {
    const profiles = app.store.welcome?.profile ?? [];
    box.setChoices([{ value: "", text: words.noProfile }, ...profiles.map((one) => ({ value: one.name, text: one.name, title: one.meaning }))]);
    box.value = unquote(app.store.value(profile));
    setShown(side, box.value === "");
    setShown(profileSide, box.value !== "" && app.store.geometry !== undefined);
    setText(profileSide, words.profileSide[app.store.geometry?.left ? "left" : "right"]);
  };
  app.store.on(["state", "own", "connection", "geometry"], update);
  update();
  return section(words.title, made.element, side, profileSide);
}

export function handPanel(app: App): HTMLElement {
  return el("div", {}, guarded(app, sourceSection(app), handSection(app), jointSliders(app)));
}

