// SPDX-License-Identifier: Apache-2.0
// The scenes of exercises as cards with a picture. One press loads a scene. The last card opens an object of the user's own.
import type { SceneChoice } from "../gen/phalanx/cockpit_pb";
import { strings } from "../strings";
import { refusal, type App } from "./app";
import { button, el, section, setAttribute, setShown, setText } from "./dom";

const words = strings.scene;
const kExercise = "exercise"; // SceneChoice.purpose
const kFirst: readonly string[] = ["first_touch", "squeeze_ball", "grasp_mug", "pinch_key", "tripod_pen"]; // without "All scenes"
const kOnLowScreens = 2;

const pictures = import.meta.glob<string>("../pictures/*.webp", { eager: true, query: "?url", import: "default" });
const pictureOf = (scene: string): string | undefined => pictures[`../pictures/${scene}.webp`];

/// @returns the scene's name in plain words
export function sceneName(scene: string): string {
  return words.names[scene] ?? scene.replaceAll("_", " ");
}

/// @returns the kind of grasp in plain words; empty: not known
function graspWords(scene: SceneChoice): string {
  if (scene.grasp !== "") return words.hows[scene.grasp] ?? "";
  return words.names[scene.name] === undefined ? "" : words.oneFinger;
}

/// @returns the scenes that are offered as cards, the first ones of a new user first. A scene without smoothing, made to shake, is left out
/// where a device moves the hand: its force would shake a real hand.
export function offeredScenes(app: App): readonly SceneChoice[] {
  const place = (name: string) => (kFirst.includes(name) ? kFirst.indexOf(name) : kFirst.length);
  const simulated = app.store.state?.deviceSimulated ?? false;
  return (app.store.welcome?.scene ?? [])
    .filter((scene) => scene.purpose === kExercise && (simulated || scene.name !== kFirst[0]))
    .sort((a, b) => place(a.name) - place(b.name));
}

/// @param own  opens the dialog of an object of the user's own
export function sceneCards(app: App, own: () => void): HTMLElement {
  const list = el("div", { class: "cards", role: "group", "aria-label": words.title });
  const refused = el("p", { class: "refused", role: "alert", hidden: true });
  const more = button("", () => {
    all = !all;
    update();
  }, { class: "quiet", "aria-expanded": "false" });
  const ownCard = card(strings.object.own, words.ownHow, undefined, own);
  ownCard.classList.add("card-own");
  const cards = new Map<string, HTMLElement>();
  let all = false;
  let built = "";

  function card(name: string, how: string, picture: string | undefined, press: () => void): HTMLButtonElement {
    const image = picture ? el("img", { src: picture, alt: "", loading: "lazy", width: 192, height: 144 }) : el("span", { class: "card-blank", "aria-hidden": "true" });
    const made = button("", press, { class: "card" });
    made.append(image, el("span", { class: "card-name" }, name), el("span", { class: "card-how" }, how));
    return made;
  }
  async function load(name: string): Promise<void> {
    setShown(refused, false);
    setText(refused, refusal(await app.host.loadScene(name)));
    setShown(refused, refused.textContent !== "");
    if (refused.textContent === "") all = false; // stiffness and smoothing are near again
    update();
  }
  function update(): void {
    const scenes = offeredScenes(app);
    const wanted = scenes.map((scene) => scene.name).join();
    if (wanted !== built) {
      built = wanted;
      cards.clear();
      for (const scene of scenes) {
        const made = card(sceneName(scene.name), graspWords(scene), pictureOf(scene.name), () => void load(scene.name));
        made.title = scene.meaning;
        cards.set(scene.name, made);
      }
      list.replaceChildren(...cards.values(), ownCard);
    }
    const current = app.store.state?.scene ?? "";
    const kept = scenes.slice(0, kFirst.length).map((scene) => scene.name);
    const chosen = cards.has(current) && !kept.includes(current) ? [...kept.slice(0, -1), current] : kept; // the current one is always shown
    for (const [name, made] of cards) {
      setAttribute(made, "aria-pressed", String(name === current));
      setShown(made, all || chosen.includes(name));
      setAttribute(made, "data-optional", String(chosen.indexOf(name) >= kOnLowScreens && name !== current)); // on low screens
    }
    setAttribute(list, "data-all", String(all));
    setShown(more, scenes.length > kFirst.length);
    setText(more, all ? words.fewer : words.all(scenes.length));
    setAttribute(more, "aria-expanded", String(all));
  }
  app.store.on(["state", "connection"], update);
  update();
  const made = section(words.title, list, refused);
  made.classList.add("section-scenes");
  made.firstElementChild!.after(more);
  return made;
}
