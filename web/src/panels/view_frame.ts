// SPDX-License-Identifier: Apache-2.0
// The place of the 3D view: its buttons, its keys, and the text that replaces it if it cannot be shown.
import type { PastHand } from "../replay/look_back";
import { notFelt } from "../state/channels";
import type { Shown } from "../state/shown";
import { strings } from "../strings";
import type { ThemeName } from "../theme";
import { forceScale } from "../view3d/force_scale";
import type { CameraPreset, HandView, Pane, ShownParts } from "../view3d/hand_view";
import type { Shapes } from "../view3d/shapes";
import type { ViewTrouble } from "../view3d/view";
import { button, el, setShown, setSwitch, setText, switchButton } from "./dom";
import { reloadButton } from "./not_loaded";
import { savedMark, savedName, saveFile } from "./saving";
import { skinToneChoice, viewCountChoice } from "./view_choices";
import { viewKey } from "./view_key";

export const kZoomStep = 1.15;
const kOrbitStep = 0.08; // [rad] for a key
const words = strings.view;
type Part = keyof ShownParts;

export interface ViewFrame {
  readonly element: HTMLElement;
  view(): HandView | undefined;
  load(theme: ThemeName): Promise<void>; // brings in the renderer
  setTheme(theme: ThemeName): void;
  camera(preset: CameraPreset): void;
  zoom(factor: number): void;
  setCalibrating(on: boolean): void; // the hand alone, with a ghost where it is to go
  showPast(hand: PastHand | undefined): void; // in the place of the source's; undefined: that one again
}

export function viewFrame(source: Shown, over: readonly HTMLElement[]): ViewFrame {
  let view: HandView | undefined;
  let calibrating = false;
  const partsNow = (): ShownParts => (calibrating ? { ...parts, ghost: true, arrows: false, object: false, cones: false } : parts);
  let parts: Record<Part, boolean> = { skin: true, ghost: true, arrows: true, object: true, cones: false };
  const host = el("div", { class: "view-host", tabindex: 0, role: "application", "aria-label": words.label });
  const said = el("p", {}, words.loading);
  const reload = reloadButton();
  const wait = el("div", { class: "view-wait", role: "status" }, said, reload);
  /// @param helps  a reload may bring the view back
  function explain(why: string, helps: boolean): void {
    setText(said, why);
    setShown(reload, helps);
    setShown(wait, why !== "");
  }
  explain(words.loading, false);

  const camera = (preset: CameraPreset) => view?.camera(preset);
  const zoom = (factor: number) => view?.zoom(factor);
  const presets = (Object.keys(words.presets) as CameraPreset[]).map((preset, i) =>
    button(words.presets[preset], () => camera(preset), { title: String(i + 1), "aria-keyshortcuts": String(i + 1) }),
  );
  function partSwitch(part: Part): HTMLElement {
    const control = switchButton(words.parts[part], (on) => {
      parts = { ...parts, [part]: on };
      setSwitch(control, on);
      view?.setParts(partsNow());
    });
    setSwitch(control, parts[part]);
    return control;
  }
  const cones = partSwitch("cones");
  const switches = [...(["skin", "ghost", "arrows", "object"] as const).map(partSwitch), cones];
  const showCones = () => setShown(cones, source.slides);
  source.on(["state", "connection"], showCones);
  showCones();
  const picture = button(words.picture, () => view && saveFile(`${savedName(source)}.png`, view.picture(savedMark(source))));
  const cameras = el(
    "div",
    { class: "view-cameras", role: "toolbar", "aria-label": words.camera },
    ...presets,
    button("+", () => zoom(kZoomStep), { class: "view-zoom", "aria-label": words.nearer, title: words.nearer }),
    button("−", () => zoom(1 / kZoomStep), { class: "view-zoom", "aria-label": words.farther, title: words.farther }),
  );
  const tones = skinToneChoice((tone) => view?.setSkinTone(tone));
  const views = viewCountChoice((count) => view?.setViews(count));
  const shown = el("div", { class: "view-parts-list" }, ...switches, views.element, tones.element, picture);
  const menu = el("details", { class: "view-parts" }, el("summary", {}, words.partsMenu), shown);

  const labels = el("div", { class: "view-labels", "aria-hidden": "true" });
  function label(panes: readonly Pane[]): void {
    labels.replaceChildren(
      ...(panes.length === 1 ? [] : panes).map(({ preset, left, width }) => {
        const one = el("span", {}, preset ? words.presets[preset] : words.own);
        one.style.left = `${100 * left}%`;
        one.style.width = `${100 * width}%`;
        return one;
      }),
    );
  }

  host.addEventListener("keydown", (event) => {
    const turn: Readonly<Record<string, readonly [number, number]>> = {
      ArrowLeft: [-kOrbitStep, 0],
      ArrowRight: [kOrbitStep, 0],
      ArrowUp: [0, kOrbitStep],
      ArrowDown: [0, -kOrbitStep],
    };
    const step = turn[event.key];
    if (!step || event.target !== host) return;
    view?.orbit(step[0], step[1]);
    event.preventDefault();
  });

  function say(trouble: ViewTrouble): void {
    if (trouble === "context-restored") explain("", false);
    else if (trouble === "context-lost") explain(words.contextLost, true);
    else explain(words.failed, false);
  }

  let felt: readonly boolean[] = []; // of each digit; empty: not known
  source.on(["state"], () => (felt = notFelt(source).map((unfelt) => !unfelt)));
  const showForces = () => view?.setForces(forceScale(source.digitLimit), felt);

  let past: PastHand | undefined;
  let shapes: Shapes | undefined; // that the view has
  function showShapes(): void {
    const next = past?.geometry ?? source.geometry;
    if (!view || !next || next === shapes) return;
    shapes = next;
    view.setGeometry(next);
  }
  function showHand(): void {
    const tick = past?.tick ?? source.tick;
    if (tick) view?.show(tick);
  }

  async function load(theme: ThemeName): Promise<void> {
    try {
      const { createHandView } = await import("../view3d/view");
      view = createHandView(host, { onTrouble: say, onPanes: label });
    } catch (reason) {
      console.error(reason);
      explain(words.notLoaded, true);
      return;
    }
    if (said.textContent === words.loading) explain("", false);
    view.setTheme(theme);
    view.setParts(partsNow());
    view.setSkinTone(tones.value);
    view.setViews(views.value);
    view.setObjectKind(source.objectKind);
    showForces();
    view.setCovered(key.offsetTop + key.offsetHeight);
    view.setLost(source.viewDead);
    showShapes();
    showHand();
    source.on(["state", "connection"], () => {
      view?.setObjectKind(source.objectKind);
      showForces();
    });
    source.on(["geometry"], showShapes);
    source.on(["tick"], () => past ?? showHand());
  }
  const key = viewKey(source);
  new ResizeObserver(() => view?.setCovered(key.offsetTop + key.offsetHeight)).observe(key);
  const element = el("div", { class: "view-frame" }, host, wait, labels, key, el("div", { class: "view-tools" }, cameras, menu), ...over);
  return {
    element,
    view: () => view,
    load,
    setTheme: (theme) => view?.setTheme(theme),
    camera,
    zoom,
    setCalibrating(on) {
      calibrating = on;
      view?.setParts(partsNow());
    },
    showPast(hand) {
      past = hand;
      element.classList.toggle("view-past", hand !== undefined);
      showShapes();
      showHand();
    },
  };
}
