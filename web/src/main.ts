// SPDX-License-Identifier: Apache-2.0
// The start of the page: it makes the panels and connects them.
import type { State } from "./gen/phalanx/cockpit_pb";
import type { Tick } from "./gen/phalanx/tick_pb";
import type { App } from "./panels/app";
import { calibrationDialog } from "./panels/calibration_dialog";
import { confirmDialog } from "./panels/dialog";
import { devicePanel } from "./panels/device_panel";
import { el } from "./panels/dom";
import { expertPanel } from "./panels/expert_panel";
import { faultCard } from "./panels/fault_card";
import { header, keysDialog } from "./panels/header";
import { listenToKeys } from "./panels/keyboard";
import { Look } from "./panels/look";
import { lostBand } from "./panels/lost_band";
import { notLoaded } from "./panels/not_loaded";
import { openings } from "./panels/openings";
import { pastHand } from "./panels/past_hand";
import { dropPlace, ownObject } from "./panels/own_object";
import { kNameKey, peoplePanel } from "./panels/people_panel";
import { readouts } from "./panels/readouts";
import { operatorName, roleStrip } from "./panels/role_strip";
import { stopBox } from "./panels/stop_box";
import { storyRibbon } from "./panels/story_ribbon";
import { tabs } from "./panels/tabs";
import { toasts } from "./panels/toasts";
import { touchPanel } from "./panels/touch_panel";
import { troubleCard } from "./panels/trouble_card";
import { viewFrame } from "./panels/view_frame";
import type { PlotPanel } from "./plots/plot_panel";
import { GeometryLoader } from "./state/geometry_loader";
import { calibratedHands } from "./state/calibrated_hands";
import { mayCalibrate } from "./state/roles";
import { Store } from "./state/store";
import { strings } from "./strings";
import type { ViewProbe } from "./view3d/hand_view";
import type { MeshPreviewProbe } from "./view3d/mesh_preview";
import { makeShapes } from "./view3d/shape_maker";
import { tellCalibration, wantedDialog } from "./wire/calibration_channel";
import { Connection, type Socket } from "./wire/connection";
import { Host } from "./wire/host";
import { fetchGeometry, linkExpired, postStop, streamUrl, uploadMesh } from "./wire/http";
import { lasting, session } from "./wire/memory";

declare global {
  interface Window {
    /// The page's state, for tests and inspection; changes nothing.
    phalanx: {
      view: () => ViewProbe | undefined;
      preview: () => MeshPreviewProbe | undefined;
      tick: () => Tick | undefined;
      state: () => State | undefined;
      lost: () => boolean;
      page: () => number;
      history: () => { readonly seconds: number; readonly end: number; readonly samples: number };
      newest: (channel: number) => number;
    };
  }
}

const kSecret = "phalanx.secret";
const kReloaded = "phalanx.reloaded";
const kReadoutMs = 80; // the rate at which figures can be read
const kPaintPatienceMs = 800;
const kPlotMs = 33;
const kPlotRest = 4; // times as long as drawing took

const store = new Store();
const secret = { get: () => session.get(kSecret), set: (value: string) => session.set(kSecret, value) };
const connection = new Connection({
  openSocket: () => new WebSocket(streamUrl(location.href)) as unknown as Socket,
  secret,
  name: () => lasting.get(kNameKey),
  onPhase: (phase) => {
    store.setPhase(phase);
    // The page has another version than the station. Reload it once; the session's memory of this prevents a loop.
    if (phase === "mismatch" && session.get(kReloaded) !== "yes") {
      if (session.set(kReloaded, "yes")) location.reload();
    } else if (phase === "open") {
      session.set(kReloaded, "");
    }
  },
  onMessage: (message) => store.receive(message),
  linkExpired,
});
const host = new Host(connection, () => postStop(secret.get()));

const dialogs = el("div", { class: "dialogs", hidden: true });
const app: App = {
  store,
  host,
  dialogs,
  upload: (file, sizeMm, unit, signal) => uploadMesh(secret.get(), file, sizeMm, unit, signal),
  takeControl: () => {
    const words = strings.role;
    const text = store.role === "other" ? words.confirmOther(operatorName(app)) : words.confirmNobody;
    confirmDialog(app, words.confirmTitle, text, words.confirm, () => void host.takeControl());
  },
};

let plots: PlotPanel | undefined;
const band = lostBand(store);
const numbers = readouts(store, openings(app));
/// What reads recordings is brought in when it is needed.
const past = pastHand(app, async (name) => {
  const [{ LookBack }, { stationSource }, { pageFetch }] = await Promise.all([import("./replay/look_back"), import("./replay/source"), import("./wire/shared_session")]);
  return new LookBack((until) => stationSource(name, pageFetch(false), until), makeShapes);
});
const frame = viewFrame(store, [past.element, band.element, faultCard(app), troubleCard(app)]);
past.attach(frame);
const own = ownObject(app);
const look = new Look((theme) => {
  frame.setTheme(theme);
  own.setTheme(theme);
  plots?.setTheme(theme);
  window.dispatchEvent(new Event("resize"));
});
const stop = stopBox(app);
numbers.element.append(storyRibbon(app));
frame.element.append(dropPlace(app, frame.element, own));
const calibration = calibrationDialog(app, (shown) => {
  document.documentElement.dataset["calibrating"] = shown;
  frame.setCalibrating(shown === "on");
  window.dispatchEvent(new Event("resize"));
});
const panels = tabs([
  { name: "touch", text: strings.tabs.touch, panel: touchPanel(app, own) },
  { name: "expert", text: strings.tabs.expert, panel: expertPanel(app, own) },
  { name: "device", text: strings.tabs.device, panel: devicePanel(app, calibration, () => frame.view()?.probe().framesPerSecond) },
  { name: "people", text: strings.tabs.people, panel: peoplePanel(app) },
]);
const plotPlace = el("div", { class: "plot-slot" });

document.title = strings.title;
document.getElementById("opening")?.remove(); // what was painted until now
document.getElementById("page")?.append(
  el(
    "div",
    { class: "content" },
    header(app, look),
    el("main", { class: "scene" }, numbers.element, frame.element, plotPlace),
    el("aside", { class: "side", "aria-label": strings.tabs.label }, roleStrip(app), panels),
  ),
  calibration.element,
  dialogs,
  el("div", { class: "dock" }, toasts(store), stop.element),
);

listenToKeys(window, {
  stop: () => stop.stop(),
  pause: () => store.setPaused(!store.paused),
  help: () => keysDialog(app),
  camera: (preset) => frame.camera(preset),
  zoom: (factor) => frame.zoom(factor),
});

/// The page of patients binds the station's calibration to a patient.
const tell = tellCalibration();
store.on(["state"], () => store.state && tell({ calibration: store.state.calibration, range: store.state.range }));

/// A therapist who comes from the page of patients finds the dialog open, as soon as this page may calibrate.
const kWantedMs = 60_000; // later the person has something else in mind
let wanted = wantedDialog(location.search);
if (wanted !== "") {
  const address = new URL(location.href); // a reload does not ask again
  address.searchParams.delete("open");
  history.replaceState(history.state, "", address);
  setTimeout(() => (wanted = ""), kWantedMs);
}
store.on(["state", "connection"], () => {
  if (wanted === "" || store.state?.wizard || !mayCalibrate(store.role, store.state)) return;
  if (wanted === "range") calibration.askRange();
  else calibration.askDevice();
  wanted = "";
});

const geometry = new GeometryLoader(async (revision) => makeShapes(await fetchGeometry(revision)), (loaded, revision) => store.setGeometry(loaded, revision));
store.on(["state"], () => store.state && geometry.want(store.state.geometry));
store.on(["connection"], () => {
  if (!store.connected) geometry.forget(); // another station counts its revisions from the beginning
});

/// While a calibration is on there are no steps: the hand and its ghost are those of the calibration.
store.on(["state"], () => {
  const hands = calibratedHands(store.state?.wizard);
  if (hands) frame.view()?.show(hands);
});

let readAt = 0;
let plotAt = 0;
let wasLost: boolean | undefined;
let wasDead: boolean | undefined; // the view

/// Updates the parts that depend on the clock, not on messages: silence must be displayed, too.
function heartbeat(now: number): void {
  store.freshness.beat(now);
  const lost = store.lost;
  if (lost !== wasLost) {
    wasLost = lost;
    document.documentElement.dataset["lost"] = String(lost);
    numbers.update();
  }
  const dead = store.viewDead;
  if (dead !== wasDead) {
    wasDead = dead;
    document.documentElement.dataset["view"] = dead ? "dead" : "live";
    frame.view()?.setLost(dead);
  }
  band.update(now);
  plots?.update();
}
function onFrame(now: number): void {
  requestAnimationFrame(onFrame); // first: whatever goes wrong below, the page goes on
  heartbeat(performance.now());
  if (now - readAt >= kReadoutMs) {
    readAt = now;
    numbers.update();
    stop.update();
  }
  if (!store.paused && plots && now >= plotAt) {
    const began = performance.now();
    plots.draw();
    // If drawing is slow, the plots wait: view and controls have precedence.
    plotAt = now + Math.max(kPlotMs, kPlotRest * (performance.now() - began));
  }
}
store.on(["connection", "geometry", "state"], () => heartbeat(performance.now()));

window.phalanx = {
  view: () => frame.view()?.probe(),
  preview: own.preview,
  tick: () => store.tick,
  state: () => store.state,
  lost: () => store.lost,
  page: () => store.welcome?.page ?? 0,
  history: () => {
    const time = store.history.time();
    const end = time.at(-1) ?? 0;
    return { seconds: end - (time[0] ?? 0), end, samples: store.history.length };
  },
  newest: (channel) => store.history.channel(channel).at(-1) ?? NaN,
};

connection.start();
requestAnimationFrame(onFrame);
/// When the page has been seen for the first time, or soon in any case: hidden pages are not painted.
function painted(): Promise<void> {
  return new Promise((resolve) => {
    setTimeout(resolve, kPaintPatienceMs);
    if (!PerformanceObserver.supportedEntryTypes?.includes("paint")) return;
    new PerformanceObserver((entries) => {
      if (entries.getEntriesByName("first-contentful-paint").length > 0) resolve();
    }).observe({ type: "paint", buffered: true });
  });
}

/// The page is there first; the renderer and the plots, which take the processor for a while, follow.
async function bringIn(): Promise<void> {
  await painted();
  const view = frame.load(look.theme);
  try {
    const { plotPanel } = await import("./plots/plot_panel");
    plots = plotPanel(store, look.theme, store, (time) => past.point(time));
    plotPlace.append(plots.element);
  } catch (reason) {
    console.error(reason);
    plotPlace.append(notLoaded(strings.plots.notLoaded));
  }
  await view;
  wasDead = undefined; // the view has not heard yet
}
void bringIn();
