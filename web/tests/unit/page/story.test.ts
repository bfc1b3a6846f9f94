// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { HandSource } from "../../../src/gen/phalanx/cockpit_pb";
import { ToPageSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { storyRibbon } from "../../../src/panels/story_ribbon";
import { kStoryStiffness, kStorySteps, Story, type StoryInput } from "../../../src/state/story";
import { fakeApp, kMe, stiffness, type FakeApp } from "./fake_app";

const base: StoryInput = { stiffness: 0.5, smoothing: false, verdict: "steady", now: 0 };

describe("the story", () => {
  it("ticks its steps as they happen", () => {
    const story = new Story();
    expect(story.feed(base)).toBe(0);
    expect(story.feed({ ...base, stiffness: 2.2 })).toBe(1);
    expect(story.feed({ ...base, stiffness: 2.2, verdict: "none" })).toBe(1);
    expect(story.feed({ ...base, stiffness: 2.2, verdict: "shakes" })).toBe(2);
    const smooth = { ...base, stiffness: 2.2, smoothing: true };
    expect(story.feed({ ...smooth, verdict: "shakes", now: 1 })).toBe(3);
    expect(story.feed({ ...smooth, now: 2 })).toBe(3);
    expect(story.feed({ ...smooth, verdict: "shakes", now: 2.5 })).toBe(3); // not yet settled
    expect(story.feed({ ...smooth, now: 3 })).toBe(3);
    expect(story.feed({ ...smooth, verdict: "none", now: 3.5 })).toBe(3); // between two squeezes
    expect(story.feed({ ...smooth, now: 4 })).toBe(kStorySteps);
    expect(story.feed({ ...base, now: 5 })).toBe(kStorySteps);
  });

  it("goes back where the wall is soft again before it shook, and where smoothing is off again before the hand settled", () => {
    const story = new Story();
    story.feed({ ...base, stiffness: 3 });
    expect(story.feed(base)).toBe(0);
    story.feed({ ...base, stiffness: 3, verdict: "shakes" });
    expect(story.feed({ ...base, stiffness: 3, smoothing: true })).toBe(3);
    expect(story.feed({ ...base, stiffness: 3 })).toBe(2);
  });
});

describe("the line of the story", () => {
  const none: readonly (readonly [string, string])[] = [["stabiliser.method", '"none"'], [stiffness, "0.5"]];
  const state = (fake: FakeApp, values: readonly (readonly [string, string])[], more: object = {}) =>
    fake.state({
      operatorPage: kMe, scene: "first_touch", deviceSimulated: true, source: HandSource.HAND_PATIENT,
      value: values.map(([key, value]) => ({ key, value })), ...more,
    });

  it("is there for the simulated patient of a simulated device alone", () => {
    for (const [more, hidden] of [
      [{}, false],
      [{ deviceSimulated: false, source: HandSource.HAND_DEVICE }, true],
      [{ deviceSimulated: false, source: HandSource.HAND_PATIENT }, true],
      [{ deviceSimulated: true, source: HandSource.HAND_SLIDERS }, true],
    ] as const) {
      const fake = fakeApp();
      const line = storyRibbon(fake.app);
      state(fake, none, more);
      expect(line.hidden, JSON.stringify(more)).toBe(hidden);
    }
  });

  it("is not there in a scene that begins with a stabiliser", () => {
    const fake = fakeApp();
    const line = storyRibbon(fake.app);
    state(fake, [["stabiliser.method", '"rise_only"']]);
    expect(line.hidden).toBe(true);
  });

  it("goes when a device takes the place of the simulated one", () => {
    const fake = fakeApp();
    const line = storyRibbon(fake.app);
    state(fake, none);
    expect(line.hidden).toBe(false);
    state(fake, none, { deviceSimulated: false, source: HandSource.HAND_DEVICE });
    expect(line.hidden).toBe(true);
  });

  it("marks what is done and what is next", () => {
    const fake = fakeApp();
    const line = storyRibbon(fake.app);
    state(fake, [["stabiliser.method", '"none"'], [stiffness, String(kStoryStiffness)]]);
    const marks = () => [...line.querySelectorAll("li")].map((step) => step.dataset["is"]);
    expect(marks()).toEqual(["done", "next", "later", "later"]);
    fake.store.receive(create(ToPageSchema, { what: { case: "tick", value: { tick: 1n, time: 1, contact: [{ segment: 2, touching: true, oscillating: true, frequency: 11, swing: 1 }] } } }));
    expect(marks()).toEqual(["done", "done", "next", "later"]);
  });

  it("can be hidden, and stays so", () => {
    const fake = fakeApp();
    const line = storyRibbon(fake.app);
    state(fake, none);
    line.querySelector("button")!.click();
    expect(line.hidden).toBe(true);
    state(fake, none);
    expect(line.hidden).toBe(true);
  });
});
