// SPDX-License-Identifier: Apache-2.0
// The 3D view in a real browser, with WebGL drawn by the processor, fed with a simulated grasp.
// Needs the built program: PHALANX_PROGRAM, or build/release/bin/phalanx.
import type { Browser, Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, beforeEach, describe, expect, inject, it } from "vitest";
import type { Tick } from "../../../src/gen/phalanx/tick_pb";
import { arrowLength, forceScale } from "../../../src/view3d/force_scale";
import { distance, skinAt } from "../support/geometry";
import { kHangMs, until } from "../support/until";
import { chromium } from "playwright-core";
import { recording, serve } from "./server";

declare global {
  interface Window {
    live: Record<string, number>; // what WebGL has made and not deleted, by kind
  }
}

const name = "grasp_teapot,skin";
const pressing = 240; // all five fingers press
const free = 20;
const kRestoreMs = 4000; // canvas.ts: so long may a lost context take to come back
let browser: Browser;
let page: Page;
let url = "";
let close: () => Promise<void>;
let complaints: string[] = [];

beforeAll(async () => {
  const served = await serve();
  url = served.url;
  close = () => served.server.close();
  browser = await chromium.connect(inject("browser"));
});
afterAll(async () => {
  await browser?.close();
  await close?.();
});
beforeEach(async () => {
  page = await browser.newPage({ viewport: { width: 480, height: 360 }, reducedMotion: "reduce" });
  page.setDefaultTimeout(kHangMs);
  complaints = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type()) && !/GPU stall|GroupMarkerNotSet|fallback/i.test(message.text())) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(String(error)));
});
afterEach(async () => {
  await page.close();
  expect(complaints).toEqual([]);
});

async function open(quality: number | null): Promise<void> {
  await page.goto(quality === null ? url : `${url}?quality=${quality}`);
  await page.waitForFunction(() => window.viewPage !== undefined);
}

async function show(tick: number, which = name): Promise<void> {
  await page.evaluate(async ([shown, number]) => {
    await window.viewPage.show(shown, number);
    await window.viewPage.settled();
  }, [which, tick] as const);
}

async function load(which = name): Promise<void> {
  await page.evaluate((shown) => window.viewPage.load(shown), which);
}

/// In the page, before anything of it runs.
function countLive(): void {
  window.live = {};
  const context = WebGL2RenderingContext.prototype as unknown as Record<string, (...given: unknown[]) => unknown>;
  for (const kind of ["Buffer", "Texture", "VertexArray", "Framebuffer"]) {
    for (const [verb, step] of [["create", 1], ["delete", -1]] as const) {
      const original = context[verb + kind]!;
      context[verb + kind] = function (this: unknown, ...given: unknown[]): unknown {
        window.live[kind] = (window.live[kind] ?? 0) + step;
        return original.apply(this, given);
      };
    }
  }
}

interface Seen {
  readonly warm: number; // share of pixels of skin's hues
  readonly colours: number; // how many different ones
  readonly hash: number;
}

/// What is in the picture.
async function look(): Promise<Seen> {
  return page.evaluate(async () => {
    const image = await createImageBitmap(await (await fetch(window.viewPage.view.picture())).blob());
    const context = new OffscreenCanvas(image.width, image.height).getContext("2d")!;
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    const colours = new Set<number>();
    let warm = 0;
    let hash = 0;
    for (let i = 0; i < data.length; i += 4) {
      const r = data[i]!, g = data[i + 1]!, b = data[i + 2]!;
      if (r > 90 && r - b > 30 && r > g) ++warm;
      colours.add((r << 16) | (g << 8) | b);
      hash = (Math.imul(hash, 31) + r * 65536 + g * 256 + b) | 0;
    }
    return { warm: (4 * warm) / data.length, colours: colours.size, hash };
  });
}

describe("what is drawn", () => {
  it("stands where the tick says, shown hand, skin and ghost, within a hundredth of a millimetre", async () => {
    await open(1);
    await load();
    const skin = recording(name).geometry.skin!;
    for (const number of [0, pressing, 400]) {
      await show(number);
      const probe = await page.evaluate(() => window.viewPage.view.probe());
      const tick: Tick = recording(name).ticks[number]!;
      expect(probe.shown).toHaveLength(16);
      expect(probe.skin.length).toBeGreaterThan(0);
      for (const { vertex, at } of probe.skin) expect(distance(skinAt(skin, tick.gdpPose, vertex), at)).toBeLessThan(1e-5);
      for (let i = 0; i < 16; ++i) {
        for (let k = 0; k < 3; ++k) {
          expect(Math.abs(probe.shown[i]![k]! - tick.gdpPose[7 * i + k]!)).toBeLessThan(1e-5);
          expect(Math.abs(probe.ghost[i]![k]! - tick.hcpPose[7 * i + k]!)).toBeLessThan(1e-5);
        }
      }
    }
  });
  it("has an arrow to scale for each segment that pushes, and none in the open", async () => {
    await open(1);
    await load();
    await show(pressing);
    const arrows = await page.evaluate(() => [...window.viewPage.view.probe().arrows]);
    const contacts = recording(name).ticks[pressing]!.contact.filter((contact) => contact.force > 0);
    for (const digit of [0, 1, 2, 3, 4]) expect(contacts.some((contact) => Math.floor(contact.segment / 3) === digit)).toBe(true);
    expect(arrows.map((arrow) => arrow.segment)).toEqual(contacts.map((contact) => contact.segment));
    arrows.forEach((arrow, i) => expect(arrow.length).toBeCloseTo(arrowLength(forceScale(Infinity), contacts[i]!.force), 5));
    await show(free);
    expect(await page.evaluate(() => window.viewPage.view.probe().arrows.length)).toBe(0);
  });
  for (const quality of [0, 1, 2, 3]) {
    it(`is a picture at quality ${quality}, with every part on and off, dark and light`, async () => {
      await open(quality);
      await load();
      await show(pressing);
      const seen = await look();
      expect(seen.warm).toBeGreaterThan(0.03);
      expect(seen.colours).toBeGreaterThan(1000);
      const hashes = new Set([seen.hash]);
      for (const off of ["ghost", "arrows", "object"] as const) {
        await page.evaluate((part) => window.viewPage.view.setParts({ skin: true, ghost: true, arrows: true, object: true, cones: false, [part]: false }), off);
        hashes.add((await look()).hash);
      }
      await page.evaluate(() => window.viewPage.view.setTheme("light"));
      hashes.add((await look()).hash);
      expect(hashes.size).toBe(5); // each looks different
    });
  }
  it("looks like what it is made of: another kind of object, another skin tone", async () => {
    await open(2);
    await load();
    await show(pressing);
    const hashes = [(await look()).hash];
    for (const kind of ["teapot", "box", "key", "jar"]) {
      await page.evaluate((one) => window.viewPage.view.setObjectKind(one), kind);
      hashes.push((await look()).hash);
    }
    await page.evaluate(() => window.viewPage.view.setSkinTone("deep"));
    hashes.push((await look()).hash);
    expect(new Set(hashes).size).toBe(hashes.length);
  });
  it("has its figure at each arrow's tip, but not at the lowest quality", async () => {
    for (const [quality, some] of [[1, true], [0, false]] as const) {
      await open(quality);
      await load();
      await show(pressing);
      const figures = page.locator(".force-labels span:not([hidden])");
      expect(await figures.count() > 0).toBe(some);
      for (const text of await figures.allTextContents()) expect(text).toMatch(/^\d+\.\d N$/);
    }
  });
  it("has a ring at each sliding contact point, and cones on demand", async () => {
    const sliding = "grasp_teapot,contact.mode=sliding";
    await open(1);
    await load(sliding);
    await show(pressing, sliding);
    const points = recording(sliding).ticks[pressing]!.contactPoint.length;
    expect(points).toBeGreaterThanOrEqual(5);
    const without = await page.evaluate(() => window.viewPage.view.probe());
    expect(without.cones).toBe(0);
    expect(without.rings).toBeGreaterThanOrEqual(points);
    const picture = await look();
    await page.evaluate(() => window.viewPage.view.setParts({ skin: true, ghost: true, arrows: true, object: true, cones: true }));
    expect((await look()).hash).not.toBe(picture.hash);
    expect(await page.evaluate(() => window.viewPage.view.probe().cones)).toBe(points);
  });
});

describe("a lost connection", () => {
  it("greys the hand at once, without another tick", async () => {
    await open(1);
    await load();
    await show(pressing);
    const before = await look();
    await page.evaluate(() => window.viewPage.view.setLost(true));
    const lost = await look();
    expect(before.warm).toBeGreaterThan(0.03);
    expect(lost.warm).toBeLessThan(0.001);
    const probe = await page.evaluate(() => window.viewPage.view.probe().arrows.length);
    expect(probe).toBe(0);
    await page.evaluate(() => window.viewPage.view.setLost(false));
    expect((await look()).hash).toBe(before.hash);
  });
});

describe("the camera", () => {
  it("is moved by presets, keys, mouse and wheel", async () => {
    await open(0);
    await load();
    await show(pressing);
    const hashes = [(await look()).hash];
    for (const preset of ["palm", "thumb", "contact", "home"] as const) {
      await page.evaluate((to) => window.viewPage.view.camera(to), preset);
      hashes.push((await look()).hash);
    }
    expect(hashes.at(-1)).toBe(hashes[0]); // home again
    await page.evaluate(() => window.viewPage.view.orbit(0.3, 0.1));
    hashes.push((await look()).hash);
    await page.evaluate(() => window.viewPage.view.zoom(1.5));
    hashes.push((await look()).hash);
    await page.mouse.move(200, 200);
    await page.mouse.down();
    await page.mouse.move(260, 220, { steps: 4 });
    await page.mouse.up();
    await page.evaluate(() => window.viewPage.settled());
    hashes.push((await look()).hash);
    await page.mouse.wheel(0, 300);
    await page.evaluate(() => window.viewPage.settled());
    hashes.push((await look()).hash);
    expect(new Set(hashes).size).toBe(hashes.length - 1);
  });
  it("keeps the hand in the picture, open and closed, at every preset", async () => {
    await open(0);
    await load();
    for (const preset of ["home", "palm", "thumb", "contact"] as const) {
      await show(free);
      await page.evaluate((to) => window.viewPage.view.camera(to), preset);
      for (const tick of [free, 120, pressing, 400, free]) {
        await until(`${preset} at ${tick}`, async () => {
          await show(tick); // a camera moves with a frame
          return page.evaluate(() => window.viewPage.view.probe().handInPicture);
        });
      }
    }
  });
  it("shows up to three views side by side, of which the first takes the mouse", async () => {
    await page.setViewportSize({ width: 1000, height: 400 });
    await open(0);
    await load();
    await show(pressing);
    const one = await look();
    await page.evaluate(() => window.viewPage.view.setViews(3));
    expect((await look()).hash).not.toBe(one.hash);
    const panes = () => page.evaluate(() => window.viewPage.view.probe().panes.map(({ preset }) => preset));
    expect(await panes()).toEqual(["home", "palm", "contact"]);
    const drag = async (x: number) => {
      await page.mouse.move(x, 200);
      await page.mouse.down();
      await page.mouse.move(x + 40, 220, { steps: 3 });
      await page.mouse.up();
      await page.evaluate(() => window.viewPage.settled());
    };
    await drag(800);
    expect(await panes()).toEqual(["home", "palm", "contact"]);
    await drag(200);
    expect(await panes()).toEqual([null, "palm", "contact"]);
    await page.setViewportSize({ width: 480, height: 400 });
    await until("one view", async () => (await panes()).length === 1, () => panes());
  });
  it("follows the contact: the camera moves by itself when the hand has moved", async () => {
    await open(0);
    await load();
    await show(free);
    await page.evaluate(() => window.viewPage.view.camera("contact"));
    const before = (await look()).hash;
    await show(pressing);
    const frames = await page.evaluate(async () => {
      const began = window.viewPage.view.probe().frames;
      for (let i = 0; i < 8; ++i) await window.viewPage.settled();
      return window.viewPage.view.probe().frames - began;
    });
    expect(frames).toBeGreaterThan(2); // it moves by itself
    expect((await look()).hash).not.toBe(before);
  });
});

describe("the graphics card", () => {
  it("draws nothing while nothing changes", async () => {
    await open(0);
    await load();
    await show(pressing);
    const drawn = await page.evaluate(async () => {
      for (let i = 0; i < 30; ++i) await window.viewPage.settled(); // the camera comes to rest
      const before = window.viewPage.view.probe().frames;
      for (let i = 0; i < 30; ++i) await window.viewPage.settled();
      return window.viewPage.view.probe().frames - before;
    });
    expect(drawn).toBe(0);
  });
  it("starts low where the processor draws", async () => {
    await open(null);
    expect(await page.evaluate(() => window.viewPage.view.probe().quality)).toBeLessThanOrEqual(1);
    expect(await page.locator("canvas").count()).toBe(1); // the one without anti-aliasing
    await load();
    await show(pressing);
    expect((await look()).warm).toBeGreaterThan(0.03);
  });
  it("comes back when its context was lost, with the same picture", async () => {
    await open(1);
    await load();
    await show(pressing);
    const before = await look();
    await page.evaluate(async () => {
      const gl = document.querySelector("canvas")!.getContext("webgl2")!;
      const loss = gl.getExtension("WEBGL_lose_context")!;
      const lost = new Promise((done) => gl.canvas.addEventListener("webglcontextlost", done, { once: true }));
      loss.loseContext();
      await lost;
      const restored = new Promise((done) => gl.canvas.addEventListener("webglcontextrestored", done, { once: true }));
      setTimeout(() => loss.restoreContext(), 100);
      await restored;
    });
    await show(pressing);
    expect((await look()).hash).toBe(before.hash);
    expect(await page.evaluate(() => window.viewPage.troubles)).toEqual([]);
    complaints = complaints.filter((text) => !/context/i.test(text)); // of three.js, about the loss itself
  });
  it("says so when the context stays lost", async () => {
    await page.clock.install();
    await open(0);
    await load();
    await page.evaluate(() => document.querySelector("canvas")!.getContext("webgl2")!.getExtension("WEBGL_lose_context")!.loseContext());
    await until("the loss", () => page.evaluate(() => document.querySelector("canvas")!.getContext("webgl2")!.isContextLost()));
    expect(await page.evaluate(() => window.viewPage.troubles)).toEqual([]);
    await page.clock.runFor(kRestoreMs);
    expect(await page.evaluate(() => window.viewPage.troubles)).toEqual(["context-lost"]);
    complaints = complaints.filter((text) => !/context/i.test(text));
  });
  it("gets all buffers back from a renderer that another kind replaces, however often the quality swings", async () => {
    await page.addInitScript(countLive);
    await open(0);
    const buffers = await page.evaluate(async ([which, number]) => {
      const counts: number[] = [];
      await window.viewPage.swing(which, number, 4, () => counts.push(window.live["Buffer"] ?? 0));
      return counts;
    }, [name, pressing] as const);
    expect(buffers.length).toBe(4);
    expect(buffers[0]).toBeGreaterThan(5);
    expect(new Set(buffers).size, `live buffers after each swing: ${buffers.join(", ")}`).toBe(1);
    complaints = complaints.filter((text) => !/context/i.test(text));
  });
  it("gets all its buffers, textures and vertex arrays back when shapes change", async () => {
    await page.addInitScript(countLive);
    await open(2);
    const liveAfter = async (): Promise<Record<string, number>> => {
      await load();
      await show(pressing);
      return page.evaluate(() => ({ ...window.live }));
    };
    await liveAfter();
    const once = await liveAfter();
    expect(once["Buffer"]).toBeGreaterThan(5);
    for (let i = 0; i < 4; ++i) await liveAfter();
    expect(await liveAfter()).toEqual(once);
  });
});
