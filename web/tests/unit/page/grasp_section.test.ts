// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it, vi } from "vitest";
import { graspOfNextObject, graspSection, plannedGrasp } from "../../../src/panels/grasp_section";
import { strings } from "../../../src/strings";
import { fakeApp, kMe, type FakeApp } from "./fake_app";

const words = strings.grasp;
let fake: FakeApp;
let panel: HTMLElement;
beforeEach(() => {
  fake = fakeApp();
  panel = graspSection(fake.app);
  document.body.replaceChildren(panel);
});

const box = () => panel.querySelector<HTMLButtonElement>("[role=combobox]")!;
const another = () => [...panel.querySelectorAll("button")].find((one) => one.textContent === words.another)!;
const isShown = (element: HTMLElement) => element.closest("[hidden]") === null;
function choose(value: string): void {
  box().click();
  [...document.getElementById(box().getAttribute("aria-controls")!)!.children]
    .find((one): one is HTMLElement => one instanceof HTMLElement && one.dataset["value"] === value)!
    .click();
}
const planned = (type: string, seed: string) => ({
  operatorPage: kMe,
  value: [
    { key: "grasp.type", value: `"${type}"` },
    { key: "grasp.seed", value: seed },
    { key: "grasp.palm", value: "[0, 0, -1]" },
  ],
  changed: [{ key: "grasp", value: `{type = "${type}", seed = ${seed}}` }],
});

describe("the grasp", () => {
  it("is the scene's own until a type is chosen, which replaces wrist and motion as a whole", async () => {
    expect(box().textContent).toBe(words.own);
    expect(isShown(another())).toBe(false);
    choose("tripod");
    await vi.waitFor(() => expect(fake.asked).toEqual([[["grasp", '{type = "tripod", seed = 1}'], ["motion", '{name = "posture", closure = 1.0}']]]));
    fake.state(planned("tripod", "1"));
    expect(box().textContent).toBe(words.types["tripod"]);
  });

  it("is looked for again with the next seed, from the same sides", async () => {
    fake.state(planned("hook", "4"));
    expect(isShown(another())).toBe(true);
    another().click();
    expect(panel.textContent).toContain(words.planning);
    await vi.waitFor(() =>
      expect(fake.asked).toEqual([[["grasp", '{type = "hook", seed = 5, palm = [0, 0, -1]}'], ["motion", '{name = "posture", closure = 1.0}']]]),
    );
    await vi.waitFor(() => expect(panel.textContent).toContain(words.hint));
  });

  it("is of another type with the next seed, too, where the scene allows that", async () => {
    const now = planned("sphere", "1");
    fake.state({ ...now, value: [...now.value, { key: "grasp.other_types", value: "true" }] });
    another().click();
    await vi.waitFor(() => expect(fake.asked[0]![0]![1]).toBe('{type = "sphere", seed = 2, palm = [0, 0, -1], other_types = true}'));
  });

  it("goes back to the scene's own", async () => {
    fake.state(planned("hook", "1"));
    choose("");
    await vi.waitFor(() => expect(fake.asked).toEqual([[["grasp", ""], ["motion", ""]]]));
  });

  it("says why there is none, and shows what is in force", async () => {
    fake.refuse = "no pinch grasp";
    choose("pinch");
    await vi.waitFor(() => expect(panel.querySelector("[role=alert]")!.textContent).toBe("no pinch grasp"));
    expect(box().textContent).toBe(words.own);
    // It is asked for with the next object, until it is in force.
    expect(panel.textContent).toContain(words.next);
    expect(graspOfNextObject(fake.app)).toEqual(plannedGrasp("pinch", 1));
    fake.state(planned("pinch", "1"));
    expect(graspOfNextObject(fake.app)).toEqual([]);
    expect(panel.textContent).toContain(words.hint);
  });

  it("keeps the reason where another type is in force, and asks for nothing in another scene", async () => {
    fake.state({ ...planned("hook", "1"), scene: "one" });
    fake.refuse = "no pinch grasp";
    choose("pinch");
    await vi.waitFor(() => expect(panel.querySelector("[role=alert]")!.textContent).toBe("no pinch grasp"));
    fake.state({ ...planned("hook", "1"), scene: "one" });
    expect(panel.querySelector("[role=alert]")!.textContent).toBe("no pinch grasp");
    expect(box().textContent).toBe(words.types["hook"]);
    expect(graspOfNextObject(fake.app)).toEqual(plannedGrasp("pinch", 1));
    fake.state({ ...planned("hook", "1"), scene: "two" });
    expect(graspOfNextObject(fake.app)).toEqual([]);
    expect(panel.textContent).toContain(words.hint);
  });

  it("has a text for each type", () => {
    const types = fake.store.welcome!.key.find((key) => key.path === "grasp.type")!.choice.filter((type) => type !== "none");
    for (const type of types) expect(words.types[type], type).toBeTruthy();
  });
});
