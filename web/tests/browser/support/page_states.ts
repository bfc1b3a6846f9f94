// SPDX-License-Identifier: Apache-2.0
// The states of the page, fed by a host that is none, for pictures and for the test of their layout.
import type { Page } from "playwright-core";
import { SafetyState } from "../../../src/gen/phalanx/tick_pb";
import type { FakeHost } from "../fake_host";

export interface PageState {
  readonly name: string;
  readonly size?: readonly [number, number];
  readonly light?: boolean;
  readonly before?: (host: FakeHost) => void;
  readonly act?: (page: Page, host: FakeHost) => Promise<void>;
}

const wait = (ms: number) => new Promise<void>((done) => setTimeout(done, ms));
const tab = (page: Page, name: string) => page.click(`[data-tab=${name}]`);
const cube = { name: "knob.stl", mimeType: "model/stl", buffer: Buffer.from("solid") };

async function upload(page: Page, host: FakeHost, answer: unknown): Promise<void> {
  host.import_ = answer;
  await page.click(".card-own");
  await page.setInputFiles("input[type=file]", cube);
  await page.click("button:text-is(\"Upload\")");
  await page.waitForSelector(".upload .import:not([hidden])");
  await page.locator(".upload .import").scrollIntoViewIfNeeded();
}

const wizard = {
  $typeName: "phalanx.wire.Wizard" as const,
  pose: 2, name: ["flat hand", "fist", "fingers at right angles", "thumb across the palm", "fingers spread"],
  instruction: "Bend the fingers at the knuckles to a right angle, the other joints straight, and hold still.",
  measuring: false, measured: 0, done: [true, true, false, false, false], raw: [20412, 18003, 22410, 19772],
  problem: [] as string[], result: [] as string[], finished: false,
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
  { name: "silent_projector", size: [1920, 1080], before: (host) => (host.silent = [3]) },
  { name: "silent_laptop", size: [1280, 720], before: (host) => (host.silent = [1, 2, 3, 4]) },
  { name: "silent_tablet_light", size: [1024, 768], light: true, before: (host) => (host.silent = [0, 3]) },
  { name: "silent_telephone", size: [390, 844], before: (host) => (host.silent = [0, 1, 2, 3, 4]) },
  { name: "lost", act: async (_, host) => { await host.cut(); await wait(2500); } },
  { name: "lost_stop", act: async (page, host) => { await host.cut(); await wait(600); await page.keyboard.press("Space"); await wait(900); } },
  { name: "stale", act: async (_, host) => { host.playing = false; await wait(1500); } },
  { name: "viewer", before: (host) => { host.page = 4; } },
  { name: "take", before: (host) => { host.page = 4; }, act: async (page) => page.click(".role-why button") },
  { name: "busy", before: (host) => (host.state.busy = "a new object: the torque goes to zero, the station begins anew") },
  { name: "refused", before: (host) => (host.refuse = "force.stiffness_n_per_mm = 900: beyond its range, >= 0, <= 100 N/mm; write a number within it"), act: async (page) => { await page.fill(".row-slider input.number", "900"); await page.keyboard.press("Enter"); await wait(300); } },
  { name: "sliders", act: async (page) => { await page.click("[aria-label='Simulated patient']"); await wait(400); await page.click("text=Fist"); } },
  { name: "device", act: async (page) => tab(page, "device") },
  { name: "wizard", before: (host) => { onWire(host); host.state.wizard = wizard; }, act: async (page) => { await tab(page, "device"); await page.locator(".wizard").scrollIntoViewIfNeeded(); } },
  { name: "wizard_end", before: (host) => { onWire(host); host.state.wizard = { ...wizard, pose: 5, done: [true, true, true, true, true], problem: ["channel 3 (index pip): moved 40 counts between flat and fist, at least 200 are needed"], result: ["channel 0  thumb cmc flexion   0.00153 rad/count", "channel 1  thumb ip flexion    0.00148 rad/count"] }; }, act: async (page) => { await tab(page, "device"); await page.locator(".wizard").scrollIntoViewIfNeeded(); } },
  { name: "people", act: async (page, host) => { await tab(page, "people"); host.notice(1, "page 2 (127.0.0.1), Anna", "set", "force.stiffness_n_per_mm = 3"); await wait(200); } },
  { name: "upload_good", act: async (page, host) => upload(page, host, { ok: true, error: "", report: ["knob.stl: 1,204 vertices, 2,404 triangles", "closed, one piece, 61 x 40 x 38 mm", "simplified: no"], findings: ["2 degenerate triangles were removed"], file: "/var/phalanx/uploads/knob.stl" }) },
  { name: "upload_bad", act: async (page, host) => upload(page, host, { ok: false, error: "knob.stl: the surface is open: 36 edges belong to one triangle only. Close the holes in a mesh editor.", report: ["knob.stl: 1,204 vertices, 2,380 triangles"], findings: ["36 open edges, the first at (12.1, 3.4, 0.0) mm"], file: "" }) },
  { name: "expert", act: async (page) => tab(page, "expert") },
  { name: "settings", act: async (page) => { await tab(page, "expert"); await page.fill("input[type=search]", "force"); await wait(200); } },
  { name: "help", act: async (page) => page.keyboard.press("?") },
  { name: "light", light: true },
  { name: "light_shaking", light: true, before: (host) => (host.shaking = true) },
  { name: "tablet", size: [1024, 768], before: (host) => (host.shaking = true) },
  { name: "tablet_viewer", size: [1024, 768], before: (host) => { host.page = 4; } },
  { name: "tablet_stopped", size: [1024, 768], act: async (page) => page.click(".stop") },
  { name: "upright", size: [768, 1024] },
  { name: "large", size: [1920, 1080], act: async (page) => { await page.click("text=Large type"); await wait(5000); } },
  { name: "large_tablet", size: [1280, 800], act: async (page) => page.click("text=Large type") },
];
