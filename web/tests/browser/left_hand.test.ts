// SPDX-License-Identifier: Apache-2.0
// A left hand is drawn as the mirror image of a right one, where the stream says it is.
import { expect, it } from "vitest";
import type { Skin } from "../../src/gen/phalanx/geometry_pb";
import { strings } from "../../src/strings";
import type { CockpitPage } from "./support/cockpit_page";
import { cross, distance, dot, minus, origins, skinAt, volume, type Point } from "./support/geometry";
import { shoot } from "./support/pictures";
import { small, stage } from "./support/stage";
import { pause, until } from "./support/until";

const kMillimetre = 1e-3;
const [kThumbTip, kIndexBase, kLittleBase, kPalm] = [2, 3, 12, 15];

const play = stage();

/// The simulated patient takes hold of it the same way in a mirror.
async function open(args: readonly string[]): Promise<CockpitPage> {
  return play.open((await play.station({ scene: "squeeze_ball", args })).url, small);
}

/// On which side of the plane through palm, index finger and little finger the thumb's tip lies [m^3]; it changes sign in a mirror, whatever
/// the hand's pose, as long as the thumb is bent towards the palm.
function handedness(points: readonly Point[]): number {
  const [palm, index, little, thumb] = [points[kPalm]!, points[kIndexBase]!, points[kLittleBase]!, points[kThumbTip]!];
  return dot(cross(minus(index, palm), minus(little, palm)), minus(thumb, palm));
}

async function drawnAsSent(cockpit: CockpitPage, skin: Skin): Promise<readonly Point[]> {
  const seen = new Set<bigint>();
  let drawn: readonly Point[] = [];
  await until("four drawn ticks", async () => {
    const probe = await cockpit.probe();
    const tick = probe && cockpit.stream.tick(probe.tick);
    if (!probe || !tick || probe.shown.length !== 16 || seen.has(tick.tick)) return false;
    seen.add(tick.tick);
    origins(tick.gdpPose).forEach((origin, segment) => expect(distance(origin, probe.shown[segment]!), `segment ${segment}`).toBeLessThan(kMillimetre));
    origins(tick.hcpPose).forEach((origin, segment) => expect(distance(origin, probe.ghost[segment]!), `segment ${segment}`).toBeLessThan(kMillimetre));
    expect(probe.skin.length).toBeGreaterThan(0);
    for (const { vertex, at } of probe.skin) expect(distance(skinAt(skin, tick.gdpPose, vertex), at), `vertex ${vertex} of the skin`).toBeLessThan(kMillimetre);
    drawn = probe.shown;
    await pause(100);
    return seen.size >= 4;
  }, () => cockpit.brief());
  return drawn;
}

it("draws a left hand as a left hand, and a right one as a right one", async () => {
  const cockpits = [await open([]), await open(["--set", "mirror=true"])] as const;
  const sides: number[] = [];
  for (const [i, cockpit] of cockpits.entries()) {
    const { left, display, segment, skin } = await cockpit.geometry();
    expect(left).toBe(i === 1);
    // The triangles are turned, too: seen from outside they go round counter-clockwise, or the hand would be inside out.
    for (const mesh of [skin!.mesh!, ...(display.length > 0 ? display : segment)]) expect(volume(mesh.position, mesh.index)).toBeGreaterThan(0);
    sides.push(handedness(await drawnAsSent(cockpit, skin!)));
  }
  const [right, left] = sides as [number, number];
  console.log(`handedness: right ${(1e9 * right).toFixed(0)} mm^3, left ${(1e9 * left).toFixed(0)} mm^3`);
  expect(Math.abs(right)).toBeGreaterThan(1e-6);
  expect(Math.abs(left)).toBeGreaterThan(1e-6);
  expect(Math.sign(left)).toBe(-Math.sign(right));
  await cockpits[1].tab("hand");
  await until("Side says left", async () => (await cockpits[1].choice(strings.hand.side).innerText()).includes(strings.hand.left), () => cockpits[1].brief());
  await shoot(cockpits[1].page, "26_left_hand");
});

it("makes it the other hand by the page's own choice, and back", async () => {
  const cockpit = await open([]);
  await cockpit.tab("hand");
  const { skin } = await cockpit.geometry();
  const right = handedness(await drawnAsSent(cockpit, skin!));
  for (const [side, left] of [["left", true], ["right", false]] as const) {
    const shape = cockpit.stream.state!.geometry;
    await cockpit.choose(strings.hand.side, side);
    await cockpit.untilState("another shape", (state) => state.geometry !== shape && state.busy === "");
    expect((await cockpit.geometry()).left).toBe(left);
    await cockpit.untilRunningAgain();
    const drawn = handedness(await drawnAsSent(cockpit, (await cockpit.geometry()).skin!));
    expect(Math.sign(drawn)).toBe((left ? -1 : 1) * Math.sign(right));
    await until("Side says so", async () => (await cockpit.choice(strings.hand.side).innerText()).includes(strings.hand[side]), () => cockpit.brief());
  }
});
