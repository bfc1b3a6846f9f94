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

const play = stage();
let station: Station;
let cockpit: CockpitPage;

const shakes = (tick: Tick) => tick.contact.some((contact) => contact.oscillating);

beforeAll(async () => {
  station = await play.station("first_touch");
  cockpit = await play.open(station.url, unseen);
  await cockpit.untilRunning();
});

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
    const light = await until("the light says shaking", async () => {
      const now = await cockpit.verdictInWords();
      return now.verdict === "shakes" && now;
    }, () => cockpit.brief());
    expect(light.words).toContain(strings.verdict.shakes);
    const tick = cockpit.stream.ticks.filter(shakes).at(-1)!;
    expect(tick.status & kOscillating).not.toBe(0);
    const contact = tick.contact.find((one) => one.oscillating)!;
    expect(contact.swing).toBeGreaterThan(0.1);
    console.log(`it shakes: ${contact.frequency.toFixed(1)} Hz, ${contact.swing.toFixed(2)} N`);
  });

  // That it shakes for less of the time is measured without a browser: SessionTest.TheFirstScene*.
  it("has smoothing in force when that is switched on, and says steady while the hand touches", async () => {
    await cockpit.switch(strings.calm.smoothing).click();
    await cockpit.untilState("smoothing in force", (state) => state.value.some((one) => one.key === "stabiliser.method" && one.value === '"smoothing"'));
    const touches = () => cockpit.stream.newest!.contact.some((contact) => contact.force > 0.2);
    const light = await until("the light says steady, and a force is there", async () => {
      const touched = touches();
      const now = await cockpit.verdictInWords();
      return touched && touches() && now.verdict === "steady" && now;
    }, () => cockpit.brief());
    expect(light.words).toContain(strings.verdict.steady);
    expect(cockpit.stream.newest!.stiffness).toBeCloseTo(1000 * kShaking, 1);
  });
});
