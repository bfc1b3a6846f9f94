// SPDX-License-Identifier: Apache-2.0
// The hand: side, profile, and what moves it.
import { HandSource } from "../gen/phalanx/cockpit_pb";
import { quote, unquote } from "../state/toml";
import { strings } from "../strings";
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

function handSection(app: App): HTMLElement {
  const box = new ChoiceBox(() => choose());
  const made = row(words.profile, box);
  const profile = "hand.profile";
  const side = choiceRow(app, "hand.side", words.side, { right: words.right, left: words.left });
  function choose(): void {
    made.refuse("");
    if (box.value === unquote(app.store.value(profile))) return;
    void change(app, [[profile, box.value === "" ? "" : quote(box.value)]]).then((refused) => {
      made.refuse(refused);
      update();
    });
  }
  const update = () => {
    const profiles = app.store.welcome?.profile ?? [];
    box.setChoices([{ value: "", text: words.noProfile }, ...profiles.map((one) => ({ value: one.name, text: one.name, title: one.meaning }))]);
    box.value = unquote(app.store.value(profile));
  };
  app.store.on(["state", "own", "connection"], update);
  update();
  return section(words.title, side, made.element);
}

export function handPanel(app: App): HTMLElement {
  return el("div", {}, guarded(app, sourceSection(app), handSection(app), jointSliders(app)));
}

