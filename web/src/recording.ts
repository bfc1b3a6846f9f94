// SPDX-License-Identifier: Apache-2.0
// The start of the page that shows recordings. It has no connection to a station's device: it reads files and sends nothing.
import type { Tick } from "./gen/phalanx/tick_pb";
import { helpDialog, openDialog } from "./panels/dialog";
import { button, el, setShown, setText } from "./panels/dom";
import { unreviewedMark } from "./panels/language_choice";
import { Look, lookSwitches } from "./panels/look";
import { threadDecoder } from "./replay/decoder";
import { openRecording, type Recording } from "./replay/recording";
import { listenToReplayKeys } from "./replay/replay_keys";
import { replayView, type ReplayView, type Workshop } from "./replay/replay_view";
import { fileSource, stationSource, type Source } from "./replay/source";
import { startPanel } from "./replay/start_panel";
import { fetchList } from "./replay/station_list";
import { momentText } from "./panels/as_text";
import { troubleText } from "./replay/trouble";
import { strings } from "./strings";
import type { ViewProbe } from "./view3d/hand_view";
import { makeShapes } from "./view3d/shape_maker";
import { pageFetch } from "./wire/shared_session";

declare global {
  interface Window {
    /// The recording's state, for tests and inspection; changes nothing.
    phalanxReplay: {
      view: () => ViewProbe | undefined;
      tick: () => Tick | undefined;
      position: () => number;
      loading: () => boolean;
      surveyed: () => number; // share of the recording that the overview has read
      history: () => { readonly begin: number; readonly end: number; readonly samples: number };
    };
  }
}

const words = strings.replay;
const workshop: Workshop = { decoder: (layout) => threadDecoder(layout), shapes: (bytes) => makeShapes(bytes), plots: () => import("./plots/plot_panel") };
const kNoStopMs = 8000; // so long the words on Stop can be read
const kRemember = 400; // the address follows the displayed moment, at most so often [ms]

let view: ReplayView | undefined;
let opening = 0; // number of the newest recording that was to be opened

document.documentElement.lang = strings.locale;
document.documentElement.dataset["page"] = "recording";
const dialogs = el("div", { class: "dialogs", hidden: true });
const content = el("div", { class: "content" });
const what = el("h1", { class: "band-what" });
const look = new Look((theme) => {
  view?.setTheme(theme);
  window.dispatchEvent(new Event("resize"));
});
const others = button(words.link, () => leave());
const help = () => helpDialog({ dialogs }, words.keys.title, words.keys.rows, words.keys.note);
const noStop = el("strong", { role: "alert" });
let noStopTimer: ReturnType<typeof setTimeout> | undefined;

/// A person who presses Esc may mean Stop, which is on another page.
function escape(): void {
  dialogs.querySelector(".dialog")?.dispatchEvent(new Event("phalanx-close"));
  clearTimeout(noStopTimer);
  setText(noStop, words.noStop);
  noStopTimer = setTimeout(() => setText(noStop, ""), kNoStopMs);
}

const band = el(
  "header",
  { class: "header band" },
  what,
  el("span", { class: "band-note" }, words.notLive, " ", noStop),
  unreviewedMark(),
  el("div", { class: "header-tools" }, others, ...lookSwitches(look).elements, button("?", help, { "aria-label": strings.look.help, title: strings.look.help })),
);
const start = startPanel({
  list: () => fetchList(pageFetch(true)),
  openListed: (name) => void open(stationSource(name, pageFetch(false)), undefined, name),
  openFile: (file) => void open(fileSource(file)),
});
document.getElementById("opening")?.remove(); // what was painted until now
document.getElementById("page")?.append(band, content, dialogs);

function show(recording: Recording | undefined): void {
  const when = recording && momentText(Number(recording.layout.begin) / 1e9);
  document.title = when ? words.title(when) : words.titleNone;
  setText(what, when ? words.band(when) : words.open);
  setShown(others, recording !== undefined);
  document.documentElement.dataset["open"] = String(recording !== undefined);
}

/// The address of this page with another recording.
function address(name: string | undefined, time = 0): string {
  const query = new URLSearchParams();
  if (name !== undefined) query.set("file", name);
  if (name !== undefined && time > 0) query.set("t", time.toFixed(2));
  return `${location.pathname}${query.size > 0 ? `?${query.toString()}` : ""}`;
}

function close(): void {
  view?.close();
  view = undefined;
}

/// Back to the choice.
function leave(trouble = ""): void {
  ++opening;
  close();
  history.replaceState(null, "", address(undefined));
  show(undefined);
  start.say(trouble);
  content.replaceChildren(start.element);
  void start.look();
}

let listed: string | undefined; // name of the open recording, if the station lists it

/// @param time  the displayed moment; absent: that of the first pose
/// @param name  as the station lists it; absent: a file of this computer
async function open(source: Source, time?: number, name?: string): Promise<void> {
  const mine = ++opening;
  start.say("");
  try {
    const recording = await openRecording(source);
    if (mine !== opening) return;
    close();
    listed = name;
    history.replaceState(null, "", address(name, time));
    view = replayView(recording, look.theme, workshop);
    content.replaceChildren(...view.content);
    content.after(view.dock);
    show(recording);
    if (time === undefined) void view.player.seekFirst();
    else view.player.seek(time);
  } catch (reason) {
    if (mine !== opening) return;
    const why = troubleText(reason, source.name);
    if (view) openDialog({ dialogs }, words.refused(source.name), [el("p", { role: "alert" }, why)]); // the open recording stays
    else leave(why);
  }
}

// ---- files that are dropped on the page

const drop = el("p", { class: "drop", hidden: true }, words.drop);
document.body.append(drop);
window.addEventListener("dragover", (event) => {
  event.preventDefault();
  setShown(drop, event.dataTransfer?.types.includes("Files") ?? false);
});
window.addEventListener("dragleave", (event) => event.relatedTarget === null && setShown(drop, false));
window.addEventListener("drop", (event) => {
  event.preventDefault();
  setShown(drop, false);
  const file = event.dataTransfer?.files[0];
  if (file) void open(fileSource(file));
});

listenToReplayKeys(window, {
  isOpen: () => view !== undefined,
  escape,
  toggle: () => view?.toggle(),
  skip: (seconds) => view?.skip(seconds),
  pose: (direction) => void view?.player.step(direction),
  event: (direction) => view?.event(direction),
  goTo: (end) => view?.player.seek(end === "begin" ? 0 : view.player.recording.seconds),
  faster: (steps) => view?.player.playhead.faster(steps),
  help,
  camera: (preset) => view?.frame.camera(preset),
  zoom: (factor) => view?.frame.zoom(factor),
});

let rememberedAt = 0;
let remembered = "";
function onFrame(now: number): void {
  requestAnimationFrame(onFrame); // first: whatever goes wrong below, the page goes on
  view?.draw(now);
  if (!view || listed === undefined || view.player.playhead.playing || now - rememberedAt < kRemember) return;
  rememberedAt = now;
  const here = address(listed, view.player.playhead.position);
  if (here !== remembered) history.replaceState(null, "", here);
  remembered = here;
}

window.phalanxReplay = {
  view: () => view?.frame.view()?.probe(),
  tick: () => view?.player.tick,
  position: () => view?.player.playhead.position ?? 0,
  loading: () => view?.player.loading ?? false,
  surveyed: () => view?.overview.progress ?? 0,
  history: () => {
    const time = view?.player.history.time() ?? new Float64Array();
    return { begin: time[0] ?? NaN, end: time.at(-1) ?? NaN, samples: time.length };
  },
};

const query = new URLSearchParams(location.search);
const wanted = query.get("file");
if (wanted !== null) {
  show(undefined);
  content.replaceChildren(start.element);
  const time = query.get("t");
  void open(stationSource(wanted, pageFetch(false)), time === null ? undefined : Number(time), wanted);
} else {
  leave();
}
requestAnimationFrame(onFrame);
