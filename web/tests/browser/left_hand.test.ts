// SPDX-License-Identifier: Apache-2.0
// A left hand is drawn as the mirror image of a right one, where the stream says it is.
import { beforeAll, expect, it } from "vitest";
import type { Skin } from "../../src/gen/phalanx/geometry_pb";
import { strings } from "../../src/strings";
import type { CockpitPage } from "./support/cockpit_page";
import { cross, distance, dot, minus, origins, skinAt, volume, type Point } from "./support/geometry";
import { shoot } from "./support/pictures";
import { full, stage } from "./support/stage";
import { until } from "./support/until";

const kMillimetre = 1e-3;
const [kThumbTip, kIndexBase, kLittleBase, kPalm] = [2, 3, 12, 15];

const play = stage();
let cockpit: CockpitPage;
let rightHand = 0; // handedness() of what is drawn

beforeAll(async () => {
  cockpit = await play.open((await play.station("squeeze_ball")).url, full);
});

/// On which side of the plane through palm, index finger and little finger the thumb's tip lies [m^3]; it changes sign in a mirror, whatever
/// the hand's pose, as long as the thumb is bent towards the palm.
function handedness(points: readonly Point[]): number {
  const [palm, index, little, thumb] = [points[kPalm]!, points[kIndexBase]!, points[kLittleBase]!, points[kThumbTip]!];
  return dot(cross(minus(index, palm), minus(little, palm)), minus(thumb, palm));
}

/// @param skin  the station's; until the page has loaded this skin it shows the previous one
async function drawnAsSent(cockpit: CockpitPage, skin: Skin): Promise<readonly Point[]> {
  const seen = new Set<bigint>();
  let loaded = false;
  let drawn: readonly Point[] = [];
  await until("four drawn ticks", async () => {
    const probe = await cockpit.probe();
    const tick = probe && cockpit.stream.tick(probe.tick);
    if (!probe || !tick || probe.shown.length !== 16 || seen.has(tick.tick)) return false;
    loaded ||= probe.skin.length > 0 && probe.skin.every(({ vertex, at }) => distance(skinAt(skin, tick.gdpPose, vertex), at) < kMillimetre);
    if (!loaded) return false;
    seen.add(tick.tick);
    origins(tick.gdpPose).forEach((origin, segment) => expect(distance(origin, probe.shown[segment]!), `segment ${segment}`).toBeLessThan(kMillimetre));
    origins(tick.hcpPose).forEach((origin, segment) => expect(distance(origin, probe.ghost[segment]!), `segment ${segment}`).toBeLessThan(kMillimetre));
    expect(probe.skin.length).toBeGreaterThan(0);
    for (const { vertex, at } of probe.skin) expect(distance(skinAt(skin, tick.gdpPose, vertex), at), `vertex ${vertex} of the skin`).toBeLessThan(kMillimetre);
    drawn = probe.shown;
    return seen.size >= 4;
  }, () => cockpit.brief());
  return drawn;
}

/// Looks at the hand that the station has now.
async function seen(left: boolean): Promise<number> {
  const geometry = await cockpit.geometry();
  expect(geometry.left).toBe(left);
  const { display, segment, skin } = geometry;
  // The triangles are turned, too: seen from outside they go round counter-clockwise, or the hand would be inside out.
  for (const mesh of [skin!.mesh!, ...(display.length > 0 ? display : segment)]) expect(volume(mesh.position, mesh.index)).toBeGreaterThan(0);
  return handedness(await drawnAsSent(cockpit, skin!));
}

async function choose(side: "left" | "right"): Promise<void> {
  const shape = cockpit.stream.state!.geometry;
  await cockpit.choose(strings.hand.side, side);
  await cockpit.untilState("another shape", (state) => state.geometry !== shape && state.busy === "");
  await cockpit.untilRunning();
  await until("Side says so", async () => (await cockpit.choice(strings.hand.side).innerText()).includes(strings.hand[side]), () => cockpit.brief());
}

it("draws a right hand as a right hand", async () => {
  rightHand = await seen(false);
  expect(Math.abs(rightHand)).toBeGreaterThan(1e-6);
});

it("makes it a left hand by the page's own choice, and draws that as one", async () => {
  await choose("left");
  const leftHand = await seen(true);
  console.log(`handedness: right ${(1e9 * rightHand).toFixed(0)} mm^3, left ${(1e9 * leftHand).toFixed(0)} mm^3`);
  expect(Math.abs(leftHand)).toBeGreaterThan(1e-6);
  expect(Math.sign(leftHand)).toBe(-Math.sign(rightHand));
  await shoot(cockpit.page, "26_left_hand");
});

it("draws it as a left hand from the beginning in a page that finds one", async () => {
  await cockpit.page.reload();
  await cockpit.ready();
  expect(Math.sign(await seen(true))).toBe(-Math.sign(rightHand));
});

it("makes it a right hand again", async () => {
  await choose("right");
  expect(Math.sign(await seen(false))).toBe(Math.sign(rightHand));
});
