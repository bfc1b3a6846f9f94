// SPDX-License-Identifier: Apache-2.0
// The papers in ten seconds: a stiff wall makes the hand shake, smoothing lets it settle.
import { beforeAll, describe, expect, it } from "vitest";
import { strings } from "../../src/strings";
import type { Tick } from "../../src/gen/phalanx/tick_pb";
import type { CockpitPage } from "./support/cockpit_page";
import { stage, unseen, type Station } from "./support/stage";
import { until } from "./support/until";

const kShaking = 2.2; // [N/mm], docs/scenes.md
const kOscillating = 1 << 13; // status bit
const kFades = 3; // [s] of the station: a switch just before a bump of the squeeze lets the hand shake for up to 1.6 s more
const kSqueezes = 6; // [s] of the station: a whole squeeze and its bump lie within
const kShakes = 1; // [s] of these 6 s, at least, without smoothing: 1.5 to 2.4 s were seen, in one stretch or in four
// The simulated patient planned its press for the softer wall. So each bump reaches the limit of force, and with smoothing, too, the hand shakes
// at the begin of each squeeze. How long a stretch lasts depends on the squeeze's phase at the switch; the share of time does not.
const kSettles = 0.5; // of the time without smoothing: a third was seen

const play = stage();
let station: Station;
let cockpit: CockpitPage;
let unsmoothed: number[] = []; // shaken for so long without smoothing [s]

const shakes = (tick: Tick) => tick.contact.some((contact) => contact.oscillating);

beforeAll(async () => {
  station = await play.station("first_touch");
  cockpit = await play.open(station.url, unseen);
  await cockpit.untilRunning();
});

/// Reads ticks until the station's clock has gone on by `seconds`.
async function ticksOf(seconds: number): Promise<Tick[]> {
  let ticks: Tick[] = [];
  while ((ticks.at(-1)?.time ?? 0) - (ticks[0]?.time ?? 0) < seconds) {
    ticks = ticks.concat(await cockpit.stream.next(20));
  }
  return ticks;
}

/// Durations of the stretches of ticks that shake [s].
function shakenFor(ticks: readonly Tick[]): number[] {
  const found: number[] = [];
  let since: number | undefined;
  for (const tick of ticks) {
    const now = shakes(tick) || (tick.status & kOscillating) !== 0;
    if (now) since ??= tick.time;
    if (since === undefined || (now && tick !== ticks.at(-1))) continue;
    found.push(tick.time - since);
    since = undefined;
  }
  return found;
}

const sum = (values: readonly number[]) => values.reduce((total, value) => total + value, 0);
const inWords = (seconds: readonly number[]) => `${seconds.map((one) => one.toFixed(2)).join(", ")} s`;

/// Of contacts that are deep enough to divide by: force_raw / depth [N/m].
function stiffnesses(ticks: readonly Tick[]): number[] {
  return ticks.flatMap((tick) =>
    tick.contact.filter((contact) => contact.touching && contact.depth > 3e-4).map((contact) => contact.forceRaw / contact.depth / tick.stiffnessFactor),
  );
}

async function untilItFeels(newtonPerMetre: number): Promise<number[]> {
  return until(
    `forces of a law of ${newtonPerMetre} N/m`,
    async () => {
      const ticks = await cockpit.stream.next(5);
      if (ticks.some((tick) => Math.abs(tick.stiffness / newtonPerMetre - 1) > 1e-4)) return false;
      const found = stiffnesses(ticks);
      return found.length >= 5 && found;
    },
    () => `${cockpit.brief()}; the law's stiffness is ${cockpit.stream.newest?.stiffness}`,
  );
}

describe("shake and settle", () => {
  it("computes with the stiffness that is typed into the page", async () => {
    for (const stiffness of [0.5, 0.8]) {
      await cockpit.setStiffness(stiffness);
      const found = await untilItFeels(1000 * stiffness);
      console.log(`set ${1000 * stiffness} N/m; force over depth: ${Math.min(...found).toFixed(1)} .. ${Math.max(...found).toFixed(1)} N/m of ${found.length} contacts`);
      for (const one of found) expect(Math.abs(one / (1000 * stiffness) - 1)).toBeLessThan(0.02);
    }
  });

  it("shakes when the slider makes the wall stiff, and says so", async () => {
    expect(await cockpit.switch(strings.calm.smoothing).getAttribute("aria-checked")).toBe("false");
    const slider = cockpit.slider(strings.force.stiffness);
    await slider.scrollIntoViewIfNeeded();
    const box = (await slider.boundingBox())!;
    const place = (newtonPerMm: number) => box.x + 10 + (box.width - 20) * (Math.log(newtonPerMm / 0.1) / Math.log(5 / 0.1));
    await cockpit.page.mouse.move(place(0.8), box.y + box.height / 2);
    await cockpit.page.mouse.down();
    await cockpit.page.mouse.move(place(1.2), box.y + box.height / 2, { steps: 4 });
    await cockpit.page.mouse.move(place(kShaking), box.y + box.height / 2, { steps: 4 });
    await cockpit.page.mouse.up();
    const dragged = Number(await cockpit.stiffnessField.inputValue());
    expect(dragged).toBeGreaterThan(1.8);
    expect(dragged).toBeLessThan(2.7);
    await until(
      "the dragged stiffness",
      () => Math.abs((cockpit.stream.newest?.stiffness ?? 0) / 1000 - dragged) < 1e-3,
      async () => `dragged to ${dragged} N/mm; the field says ${await cockpit.stiffnessField.inputValue()}, the stream ${cockpit.stream.newest?.stiffness} N/m; ${cockpit.brief()}`,
    );
    await cockpit.setStiffness(kShaking);
    await until("the stream's oscillating bits", () => cockpit.stream.ticks.slice(-20).some(shakes), () => cockpit.brief());
    await until("the light says shaking", async () => (await cockpit.verdict()) === "shakes", () => cockpit.brief());
    const tick = cockpit.stream.ticks.filter(shakes).at(-1)!;
    expect(tick.status & kOscillating).not.toBe(0);
    expect(await cockpit.page.locator("[data-verdict]").innerText()).toContain(strings.verdict.shakes);
    const contact = tick.contact.find((one) => one.oscillating)!;
    expect(contact.swing).toBeGreaterThan(0.1);
    unsmoothed = shakenFor(await ticksOf(kSqueezes));
    console.log(`it shakes: ${contact.frequency.toFixed(1)} Hz, ${contact.swing.toFixed(2)} N, for ${inWords(unsmoothed)}`);
    expect(sum(unsmoothed), `without smoothing it goes on, for ${inWords(unsmoothed)}`).toBeGreaterThan(kShakes);
  });

  it("shakes for less than half of the time when smoothing is switched on", async () => {
    await cockpit.switch(strings.calm.smoothing).click();
    await cockpit.untilState("smoothing in force", (state) => state.value.some((one) => one.key === "stabiliser.method" && one.value === '"smoothing"'));
    await ticksOf(kFades);
    await until("the light says steady", async () => (await cockpit.verdict()) === "steady", () => cockpit.brief());
    const ticks = await ticksOf(kSqueezes);
    const shaking = shakenFor(ticks);
    expect(sum(shaking), `shaken for ${inWords(shaking)}, without smoothing for ${inWords(unsmoothed)}`).toBeLessThan(kSettles * sum(unsmoothed));
    expect(ticks.at(-1)!.stiffness).toBeCloseTo(1000 * kShaking, 1);
    const touching = ticks.filter((tick) => tick.contact.some((contact) => contact.force > 0.2)).length;
    console.log(`settled: ${ticks.length} ticks over ${(ticks.at(-1)!.time - ticks[0]!.time).toFixed(1)} s, ${touching} of them with a force above 0.2 N, shaken for ${inWords(shaking)}`);
    expect(touching, "a hand that touches nothing is calm, too").toBeGreaterThan(ticks.length / 10);
  });
});
