// SPDX-License-Identifier: Apache-2.0
// The states of the page with a simulated station (FakeHost), for pictures and for the test of their layout.
import { create } from "@bufbuild/protobuf";
import type { Page } from "playwright-core";
import { Wizard_JointSchema, Wizard_Method, WizardSchema, type Wizard } from "../../../src/gen/phalanx/cockpit_pb";
import { SafetyState } from "../../../src/gen/phalanx/tick_pb";
import type { Strings } from "../../../src/strings";
import type { FakeHost } from "../fake_host";
import { cupAnswer } from "./meshes";

export interface PageState {
  readonly name: string;
  readonly size?: readonly [number, number];
  readonly light?: boolean;
  readonly again?: boolean; // another state at another size or in another theme
  readonly before?: (host: FakeHost) => void;
  readonly act?: (page: Page, host: FakeHost, words: Strings) => Promise<void>; // with the words of the language that the page is in
}

const wait = (ms: number) => new Promise<void>((done) => setTimeout(done, ms));
const tab = (page: Page, name: string) => page.click(`[data-tab=${name}]`);
const cube = { name: "knob.stl", mimeType: "model/stl", buffer: Buffer.from("solid") };

async function upload(page: Page, host: FakeHost, words: Strings, answer: unknown): Promise<void> {
  host.import_ = answer;
  await page.click(".card-own");
  await page.setInputFiles("input[type=file]", cube);
  await page.click(`button:text-is("${words.object.upload}")`);
  await page.waitForSelector(".upload .import:not([hidden])");
  await page.locator(".upload .import").scrollIntoViewIfNeeded();
}

/// A mesh with a preview, and the axis that is up in its file.
async function uploadCup(page: Page, host: FakeHost, words: Strings): Promise<void> {
  await upload(page, host, words, cupAnswer(cube.name));
  await page.click(".up-axis button:text-is(\"y\")");
  await page.waitForFunction(() => (window.phalanx.preview()?.frames ?? 0) > 1);
}

const rad = Math.PI / 180;
const joint = (joint: number, present: number, rest: object) => create(Wizard_JointSchema, { joint, present: present * rad, ...rest });
const poseNames = ["index", "middle"].flatMap((digit) => ["mcp_flexion", "pip_flexion", "dip_flexion"].flatMap((part) => ["first", "second", "third"].map((one) => `${digit}_${part} ${one}`)));
const wizard = create(WizardSchema, {
  pose: 4, name: poseNames, method: Wizard_Method.GONIOMETER, stillFor: 0.9,
  instruction: "Hold the middle joint of the index finger further bent, at least 20 degrees from the first position. Measure the joint and enter the angle.",
  done: poseNames.map((_, i) => i < 4), raw: [20412], joint: [joint(6, 38, { target: 52 * rad, mayEnter: true })],
});
const jig = create(WizardSchema, {
  pose: 1, name: ["open hand", "fist", "spread"], method: Wizard_Method.JIG, stillFor: 0.1, measuring: true, measured: 0.6,
  instruction: "On the jig: the fist, each joint of the four fingers at the angle that is shown.", done: [true, false, false],
  joint: [4, 6, 7, 8, 10, 11].map((j, i) => joint(j, 80 + 4 * i, { target: 90 * rad, mayEnter: true })),
});
const range = create(WizardSchema, {
  ofRange: true, pose: 1, digit: [0, 1, 2], done: [true, false, false], measuring: true, stillFor: 0.7,
  joint: [joint(4, 30, { limitMin: -30 * rad, limitMax: 90 * rad, reachedMin: -5 * rad, reachedMax: 62 * rad }), joint(5, 3, { limitMin: -20 * rad, limitMax: 20 * rad }), joint(6, 38, { limitMin: 0, limitMax: 100 * rad, reachedMin: 2 * rad, reachedMax: 40 * rad }), joint(7, 12, { limitMin: -10 * rad, limitMax: 70 * rad, reachedMin: 0, reachedMax: 25 * rad })],
});

/// A calibration that shows the host's hand, as it does without steps.
const calibrates = (host: FakeHost, shown: Wizard) => {
  onWire(host);
  host.playing = false;
  Object.assign(host.state, { wizard: { ...shown, ...host.hands() }, stationGone: true, calibration: "out/calibrations/BH-0042.toml" });
};
const onWire = (host: FakeHost) => Object.assign(host.state, { source: 0, deviceSimulated: false, deviceSpec: "serial:/dev/ttyACM0", deviceSerial: "BH-0042" });
const fault = {
  $typeName: "phalanx.wire.Fault" as const,
  name: "sensor_jump", meaning: "A sensor's angle jumped farther than a hand can move in one step.",
  remedy: "Check the cable of the sensor, then press Reset.", channel: 7, time: 12.4, tick: 2480n, fromDevice: false, report: "out/faults/20261122-010000.json",
};

export const pageStates: readonly PageState[] = [
  { name: "contact" },
  { name: "first", before: (host) => (host.touching = false) },
  { name: "shaking", before: (host) => (host.shaking = true), act: async (page) => void (await page.hover(".plot-host", { position: { x: 200, y: 60 } })) },
  { name: "stopped", act: async (page) => page.keyboard.press("Escape") },
  { name: "fault", before: (host) => Object.assign(host.state, { fault, safety: SafetyState.SAFETY_FAULT }), act: async (_, host) => host.notice(3, "", "fault", "sensor_jump: a sensor's angle jumped.") },
  { name: "silent", before: (host) => (host.silent = [3]) },
  { name: "silent_dialog", size: [1024, 768], before: (host) => (host.silent = [1, 4]), act: async (page) => page.click(".silent-digits button") },
  { name: "silent_projector", again: true, size: [1920, 1080], before: (host) => (host.silent = [3]) },
  { name: "silent_laptop", again: true, size: [1280, 720], before: (host) => (host.silent = [1, 2, 3, 4]) },
  { name: "silent_tablet_light", again: true, size: [1024, 768], light: true, before: (host) => (host.silent = [0, 3]) },
  { name: "silent_telephone", again: true, size: [390, 844], before: (host) => (host.silent = [0, 1, 2, 3, 4]) },
  { name: "lost", act: async (_, host) => { await host.cut(); await wait(2500); } },
  { name: "lost_stop", act: async (page, host) => { await host.cut(); await wait(600); await page.keyboard.press("Space"); await wait(900); } },
  { name: "stale", act: async (_, host) => { host.playing = false; await wait(1500); } },
  { name: "viewer", before: (host) => { host.page = 4; } },
  { name: "take", before: (host) => { host.page = 4; }, act: async (page) => page.click(".role-why button") },
  { name: "busy", before: (host) => (host.state.busy = "a new object: the torque goes to zero, the station begins anew") },
  { name: "refused", before: (host) => (host.refuse = "force.stiffness_n_per_mm = 900: beyond its range, >= 0, <= 100 N/mm; write a number within it"), act: async (page) => { await page.fill(".row-slider input.number", "900"); await page.keyboard.press("Enter"); await wait(300); } },
  { name: "sliders", act: async (page, _, words) => { await page.click(`[aria-label="${words.hand.patient}"]`); await wait(400); await page.click(`text=${words.hand.fist}`); } },
  { name: "device", act: async (page) => tab(page, "device") },
  { name: "calibration_ask", before: (host) => onWire(host), act: async (page, _, words) => { await tab(page, "device"); await page.click(`text=${words.calibration.device}`); } },
  { name: "calibration", size: [1920, 1080], before: (host) => calibrates(host, wizard) },
  { name: "calibration_jig", size: [1366, 768], before: (host) => calibrates(host, jig) },
  { name: "calibration_end", light: true, before: (host) => calibrates(host, create(WizardSchema, { ...wizard, pose: poseNames.length, joint: [], problem: ["angle of index_pip_flexion: 2 poses, 12.0 deg apart; measure at least two whose angles differ by more than 20 deg"] })) },
  { name: "range", size: [1366, 768], before: (host) => calibrates(host, range) },
  { name: "range_tablet", again: true, size: [1024, 768], light: true, before: (host) => calibrates(host, range) },
  { name: "calibration_telephone", again: true, size: [390, 844], before: (host) => calibrates(host, wizard) },
  { name: "people", act: async (page, host) => { await tab(page, "people"); host.notice(1, "page 2 (127.0.0.1), Anna", "set", "force.stiffness_n_per_mm = 3"); await wait(200); } },
  { name: "upload_good", act: async (page, host, words) => upload(page, host, words, { ok: true, error: "", report: ["knob.stl: 1,204 vertices, 2,404 triangles", "closed, one piece, 61 x 40 x 38 mm", "simplified: no"], findings: ["2 degenerate triangles were removed"], file: "/var/phalanx/uploads/knob.stl" }) },
  { name: "upload_preview", act: uploadCup },
  { name: "upload_preview_light", again: true, light: true, size: [1920, 1080], act: uploadCup },
  { name: "upload_preview_small", again: true, size: [1366, 768], act: uploadCup },
  { name: "upload_preview_tablet", again: true, light: true, size: [1024, 768], act: uploadCup },
  { name: "upload_preview_upright", again: true, size: [768, 1024], act: uploadCup },
  { name: "upload_preview_telephone", again: true, size: [390, 844], act: uploadCup },
  { name: "upload_preview_large", again: true, size: [1366, 768], act: async (page, host, words) => { await page.click(`text=${words.look.large}`); await wait(1500); await uploadCup(page, host, words); } },
  { name: "upload_empty", act: async (page) => page.click(".card-own") },
  { name: "upload_bad", act: async (page, host, words) => upload(page, host, words, { ok: false, error: "knob.stl: the surface is open: 36 edges belong to one triangle only. Close the holes in a mesh editor.", report: ["knob.stl: 1,204 vertices, 2,380 triangles"], findings: ["36 open edges, the first at (12.1, 3.4, 0.0) mm"], file: "" }) },
  { name: "expert", act: async (page) => tab(page, "expert") },
  { name: "settings", act: async (page) => { await tab(page, "expert"); await page.fill("input[type=search]", "force"); await wait(200); } },
  { name: "help", act: async (page) => page.keyboard.press("?") },
  { name: "light", again: true, light: true },
  { name: "light_shaking", again: true, light: true, before: (host) => (host.shaking = true) },
  { name: "tablet", again: true, size: [1024, 768], before: (host) => (host.shaking = true) },
  { name: "tablet_viewer", again: true, size: [1024, 768], before: (host) => { host.page = 4; } },
  { name: "tablet_stopped", again: true, size: [1024, 768], act: async (page) => page.click(".stop") },
  { name: "upright", again: true, size: [768, 1024] },
  { name: "large", size: [1920, 1080], act: async (page, _, words) => { await page.click(`text=${words.look.large}`); await wait(5000); } },
  { name: "large_tablet", again: true, size: [1280, 800], act: async (page, _, words) => page.click(`text=${words.look.large}`) },
];
