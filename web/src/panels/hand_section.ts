// SPDX-License-Identifier: Apache-2.0
// The hand: size, side, and what moves it.
import { HandSource } from "../gen/phalanx/cockpit_pb";
import type { Store } from "../state/store";
import { quote, unquote } from "../state/toml";
import { strings } from "../strings";
import type { Change } from "../wire/host";
import { change, refusal, type App } from "./app";
import { ChoiceBox } from "./choice_box";
import { el, section, setShown, setSwitch, setText, switchButton } from "./dom";
import { jointSliders } from "./joint_sliders";
import { choiceRow, row } from "./setting_controls";

const words = strings.hand;

/// The simulated patient, and without it what the user moves the hand with. A device moves the hand itself.
function patientRow(app: App): HTMLElement {
  const error = el("p", { class: "refused", role: "alert", hidden: true });
  const hint = el("p", { class: "hint" }, words.deviceHint);
  const patient = switchButton(words.patient, (on) => void choose(on ? HandSource.HAND_PATIENT : HandSource.HAND_SLIDERS), { "aria-label": words.patient });
  const made = row(words.patientHint, patient);
  made.element.classList.add("row-switch");
  async function choose(source: HandSource): Promise<void> {
    setText(error, refusal(await app.host.setSource(source)));
    setShown(error, error.textContent !== "");
    update();
  }
  const update = () => {
    const source = app.store.state?.source;
    setSwitch(patient, source === HandSource.HAND_PATIENT);
    setShown(made.element, source !== HandSource.HAND_DEVICE);
    setShown(hint, source === HandSource.HAND_DEVICE);
  };
  app.store.on(["state"], update);
  update();
  return el("div", {}, made.element, hint, error);
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

export function handSection(app: App): HTMLElement {
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
    box.setChoices([{ value: "", text: words.noProfile }, ...profiles.map((one) => ({ value: one.name, text: words.profiles[one.name] ?? one.name, title: one.meaning }))]);
    box.value = unquote(app.store.value(profile));
    setShown(side, box.value === "");
    setShown(profileSide, box.value !== "" && app.store.geometry !== undefined);
    setText(profileSide, words.profileSide[app.store.geometry?.left ? "left" : "right"]);
  };
  app.store.on(["state", "own", "connection", "geometry"], update);
  update();
  return section(words.title, made.element, side, profileSide, patientRow(app), jointSliders(app));
}
