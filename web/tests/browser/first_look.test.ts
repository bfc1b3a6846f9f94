// SPDX-License-Identifier: Apache-2.0
// Whoever opens the page sees the hand where the station has it, what it touches, and how hard.
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { beforeAll, describe, expect, it } from "vitest";
import { strings } from "../../src/strings";
import { arrowLength, forceScale } from "../../src/view3d/force_scale";
import type { CockpitPage } from "./support/cockpit_page";
import { curveHeight } from "./support/pictures";
import { filesOf, weightOf } from "./support/page_weight";
import { dataFolder } from "./support/program";
import { small, stage, type Station } from "./support/stage";
import { distance, origins, skinAt, type Point } from "./support/geometry";
import { until } from "./support/until";

const kMillimetre = 1e-3;
const kLeastForce = 1e-3; // [N]; less has no arrow
const scale = forceScale(5); // the default of limits.fingertip_force_n
/// [bytes], gzipped, in all languages and with what is loaded later. The patient's screen is to more than a half three.js, which the cockpit has, too.
const kLimits: readonly (readonly [pages: readonly string[], limit: number])[] = [
  [["index.html", "recording.html"], 450_000], // half of what the cockpit may have
  [["people.html"], 150_000],
  [["patient.html"], 300_000],
];
const kForceSent = 16; // the channels behind those of the raw forces

const play = stage();
let station: Station;
let cockpit: CockpitPage;

beforeAll(async () => {
  station = await play.station();
  cockpit = await play.open(station.url, small);
});

describe("the first look", () => {
  it("shows the hand, its skin and its ghost where the stream says that they are", async () => {
    const skin = (await cockpit.geometry()).skin!;
    const seen = new Set<bigint>();
    let worst = 0;
    let moved = 0;
    let first: readonly Point[] | undefined;
    await until("eight drawn ticks of a hand that moves", async () => {
      const probe = await cockpit.probe();
      const tick = probe && cockpit.stream.tick(probe.tick);
      if (!probe || !tick || seen.has(tick.tick)) return false;
      seen.add(tick.tick);
      expect(probe.shown).toHaveLength(16);
      expect(probe.ghost).toHaveLength(16);
      for (const [drawn, sent] of [[probe.shown, origins(tick.gdpPose)], [probe.ghost, origins(tick.hcpPose)]] as const) {
        sent.forEach((origin, segment) => (worst = Math.max(worst, distance(origin, drawn[segment]!))));
      }
      expect(probe.skin.length).toBeGreaterThan(0);
      for (const { vertex, at } of probe.skin) worst = Math.max(worst, distance(skinAt(skin, tick.gdpPose, vertex), at));
      first ??= origins(tick.hcpPose);
      moved = Math.max(moved, ...origins(tick.hcpPose).map((origin, segment) => distance(origin, first![segment]!)));
      return seen.size >= 8 && moved > kMillimetre;
    }, () => cockpit.brief());
    console.log(`farthest from the stream: ${(worst * 1e6).toFixed(3)} um, over ${seen.size} ticks in which the hand moved ${(moved * 1000).toFixed(1)} mm`);
    expect(worst).toBeLessThan(kMillimetre);
  });

  it("draws an arrow to scale for each force, and a curve that rises", async () => {
    await cockpit.untilRunning();
    await cockpit.untilTouching();
    let arrows = 0;
    const seen = new Set<bigint>();
    await until("six ticks with arrows", async () => {
      const probe = await cockpit.probe();
      const tick = probe && cockpit.stream.tick(probe.tick);
      if (!probe || !tick || probe.lost || seen.has(tick.tick)) return false;
      const forces = new Map(tick.contact.map((contact) => [contact.segment, contact.force * tick.factor] as const).filter(([, force]) => force > kLeastForce));
      expect(new Set(probe.arrows.map((arrow) => arrow.segment)), `arrows of tick ${tick.tick}`).toEqual(new Set(forces.keys()));
      if (forces.size === 0) return false;
      seen.add(tick.tick);
      for (const arrow of probe.arrows) {
        ++arrows;
        expect(arrow.length).toBeGreaterThan(0);
        expect(Math.abs(arrow.length - arrowLength(scale, forces.get(arrow.segment)!))).toBeLessThan(0.1 * kMillimetre);
      }
      return seen.size >= 6;
    }, () => cockpit.brief());
    console.log(`${arrows} arrows of ${seen.size} ticks are to scale`);
  });

  it("plots the force that is sent", async () => {
    await until("a curve that rises", async () => (await curveHeight(cockpit.page, strings.plots.titles.force)) > 0.15, () => cockpit.brief());
    let compared = 0;
    await until("a force in the history as in the stream", async () => {
      const { tick, values } = await cockpit.page.evaluate(
        (from) => ({ tick: window.phalanx.tick()!.tick, values: Array.from({ length: 16 }, (_, segment) => window.phalanx.newest(from + segment)) }),
        kForceSent,
      );
      const sent = cockpit.stream.tick(tick);
      if (!sent || sent.contact.every((contact) => contact.force * sent.factor < 0.1)) return false;
      for (const contact of sent.contact) expect(values[contact.segment]).toBeCloseTo(contact.force * sent.factor, 4);
      return ++compared >= 3;
    }, () => cockpit.brief());
  });

  it("is small; how soon something was seen is printed, not asserted: that is the machine's", async () => {
    const site = join(dataFolder, "web/dist");
    expect(await (await cockpit.page.request.get(station.url)).text(), "the station serves another page than the one that is weighed").toBe(
      readFileSync(join(site, "index.html"), "utf8"),
    );
    const weights = kLimits.map(([pages]) => weightOf(site, filesOf(site, pages)));
    const files = filesOf(site, kLimits.flatMap(([pages]) => pages));
    const built = readdirSync(site, { recursive: true }).map(String).filter((name) => /\.(js|css)$/.test(name));
    expect(built.filter((name) => !files.includes(name)), "files that no page is weighed with").toEqual([]);
    const paint = await cockpit.page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0]?.startTime);
    console.log(`first contentful paint after ${paint?.toFixed(0)} ms; ${files.length} files of JS and CSS, ${weights.map((bytes) => (bytes / 1000).toFixed(1)).join(", ")} kB gzipped`);
    expect(files.length).toBeGreaterThan(1);
    expect(paint, "the browser has painted").toBeDefined();
    kLimits.forEach(([pages, limit], i) => expect(weights[i], pages.join(" ")).toBeLessThan(limit));
  });
});
