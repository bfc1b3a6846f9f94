// SPDX-License-Identifier: Apache-2.0
// The device and the loop that drives it.
import type { Link, Loop, Recording, State } from "../gen/phalanx/cockpit_pb";
import type { DeliveryFigures } from "../state/delivery";
import { strings } from "../strings";
import type { App } from "./app";
import { sizeText } from "./as_text";
import { el, section, setShown, setText } from "./dom";
import { isBehind, recordingsLink } from "./recording";
import { histogram } from "./histogram";
import type { CalibrationDialog } from "./calibration_dialog";
import { wizardSection } from "./wizard";

const words = strings.device;
type Fact = readonly [label: string, value: string, bad?: boolean];

/// Writes facts into a list; rows keep their place.
function showFacts(list: HTMLElement, facts: readonly Fact[]): void {
  const wanted = facts.map((fact) => fact.join("|")).join("\n");
  if (list.dataset["shown"] === wanted) return;
  list.dataset["shown"] = wanted;
  list.replaceChildren(
    ...facts.flatMap(([label, value, bad]) => [el("dt", {}, label), el("dd", { class: bad ? "bad" : undefined }, value || strings.dash)]),
  );
}

function deviceFacts(state: State): readonly Fact[] {
  const name = state.deviceSimulated ? words.simulated(state.deviceName) : state.deviceName;
  return [
    [words.name, name],
    [words.serial, state.deviceSerial],
    [words.spec, state.deviceSpec],
    [words.state, words.states[state.deviceState] ?? state.deviceState, state.deviceState === "latched"],
    [words.estop, state.estop ? words.pressed : words.released, state.estop],
    [words.torque, state.rendersTorque ? words.renders : words.noTorque],
    [words.watchdog, state.holdsWithoutHost ? words.noWatchdog : words.letsGo, state.holdsWithoutHost],
    [words.calibration, state.calibration || words.ownNumbers],
    [words.range, state.range || words.noRange],
    [words.realtime, state.realtime || words.realtimeUnknown],
  ];
}

const count = (value: bigint) => value.toLocaleString(strings.figures);

function linkFacts(link: Link): readonly Fact[] {
  const names = words.linkNames;
  return [
    [names.received, count(link.received)],
    [names.lost, count(link.lost), link.lost > 0n],
    [names.corrupt, count(link.corrupt), link.corrupt > 0n],
    [names.refused, count(link.refused), link.refused > 0n],
    [names.outdated, count(link.outdated), link.outdated > 0n],
    [names.sent, count(link.sent)],
  ];
}

function recordingFacts(recording: Recording): readonly Fact[] {
  return [
    [words.recordingFile, recording.file],
    [words.recordingSize, sizeText(Number(recording.bytes))],
    [words.recordingRoom, sizeText(Number(recording.freeBytes))],
    [words.recordingMissing, count(recording.lostSteps), recording.lostSteps > 0n],
  ];
}

/// The same rows, without what is no longer known.
const unknown = (facts: readonly Fact[]): readonly Fact[] => facts.map(([label]) => [label, strings.dash]);

function loopFacts(loop: Loop): readonly Fact[] {
  return [
    [words.period, strings.device.durations.ms((loop.period * 1000).toLocaleString(strings.figures, { maximumSignificantDigits: 4 }))],
    [words.steps, count(loop.steps)],
    [words.overruns, count(loop.overruns), loop.overruns > 0n],
    [words.skipped, count(loop.skipped), loop.skipped > 0n],
  ];
}

/// @param figures  of pictures that arrived  @param drawn  frames that the view draws in a second; undefined: there is no view
function pageFacts(figures: DeliveryFigures, drawn: number | undefined): readonly Fact[] {
  const { durations } = words;
  const delay = (seconds: number) => (Number.isFinite(seconds) ? durations.ms((1000 * seconds).toFixed(0)) : strings.dash);
  return [
    [words.drawn, drawn === undefined ? strings.dash : words.perSecond(drawn.toFixed(0))],
    [words.received, words.perSecond(figures.perSecond.toFixed(0))],
    [words.missingPictures, String(figures.missing), figures.missing > 0],
    [words.delay, words.delays(delay(figures.delay.p50), delay(figures.delay.p99))],
  ];
}

/// @param framesDrawn  in a second; undefined: there is no view
export function devicePanel(app: App, calibration: CalibrationDialog, framesDrawn: () => number | undefined = () => undefined): HTMLElement {
  const device = el("dl", { class: "facts" });
  const link = el("dl", { class: "facts facts-narrow" });
  const loop = el("dl", { class: "facts facts-narrow" });
  const page = el("dl", { class: "facts facts-narrow" });
  const recording = el("dl", { class: "facts" });
  const unsaved = el("p", { class: "warning", role: "status" });
  const notRecorded = el("p", {}, words.notRecorded);
  const holds = el("p", { class: "warning", role: "status" }, words.holdsWithoutHost);
  const degraded = el("p", { class: "warning", role: "status" }, words.degraded);
  const lateness = histogram(words.lateness);
  const step = histogram(words.step);
  const update = () => {
    const state = app.store.state;
    if (!state) return;
    const live = app.store.connected;
    const said = (facts: readonly Fact[]) => (live ? facts : unknown(facts));
    const { loop: numbers } = state;
    showFacts(device, said(deviceFacts(state)));
    showFacts(link, state.link ? said(linkFacts(state.link)) : []);
    showFacts(loop, numbers ? said(loopFacts(numbers)) : []);
    showFacts(page, said(pageFacts(app.store.delivery.figures(performance.now() / 1000), framesDrawn())));
    showFacts(recording, state.recording ? said(recordingFacts(state.recording)) : []);
    setShown(notRecorded, !state.recording);
    setText(unsaved, state.recording ? words.unsaved(state.recording.trouble, state.recording.unsaved.toFixed(1)) : "");
    setShown(unsaved, live && state.recording !== undefined && isBehind(state.recording));
    setShown(holds, state.holdsWithoutHost);
    setShown(degraded, state.degraded && live);
    lateness.show(live ? numbers?.lateness : undefined);
    step.show(live ? numbers?.step : undefined);
  };
  app.store.on(["state", "connection"], update);
  update();
  return el(
    "div",
    {},
    section(words.title, holds, device),
    wizardSection(app, calibration),
    section(words.recording, unsaved, notRecorded, recording, recordingsLink()),
    section(words.loop, degraded, loop, lateness.element, step.element),
    section(words.link, link),
    section(words.page, page, el("p", { class: "hint" }, words.pageHint)),
  );
}
