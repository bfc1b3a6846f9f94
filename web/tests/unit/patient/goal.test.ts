// SPDX-License-Identifier: Apache-2.0
import { readFileSync, readdirSync } from "node:fs";
import { resolve } from "node:path";
import { describe, expect, it } from "vitest";
import { goalOf, instructionText } from "../../../src/patient/goal";
import { patientLanguages } from "../../../src/patient/words";
import { de } from "../../../src/strings/patient_de";
import { en } from "../../../src/strings/patient_en";
import { exerciseNow, knownWith } from "./exercise";

const assets = resolve(__dirname, "../../../../assets/exercises");
const shipped = readdirSync(assets).map((name) => /^instruction = "(.*)"$/m.exec(readFileSync(resolve(assets, name), "utf8"))![1]!);

describe("the goal", () => {
  it.each(Object.entries(patientLanguages))("has own words in %s for the instruction of every shipped exercise", (_, texts) => {
    expect(shipped.length).toBeGreaterThan(10);
    for (const instruction of shipped) expect(texts.goals[instruction], instruction).toBeTruthy();
  });

  it("names the finger that an instruction ends with", () => {
    const text = (instruction: string) => instructionText(exerciseNow({ instruction }), en);
    expect(text("Move only this finger (ring)")).toBe("Move only this finger: your ring finger");
    expect(text("Bend only the index finger.")).toBe("Bend only your index finger");
    expect(instructionText(exerciseNow({ instruction: "Straighten only the little finger." }), de)).toBe("Strecken Sie nur den kleinen Finger");
  });

  it("shows the own words of an exercise that is not shipped", () => {
    expect(instructionText(exerciseNow({ instruction: "Press the bell." }), de)).toBe("Press the bell");
  });

  it("says that the connection is interrupted, whatever the last exercise was", () => {
    const goal = goalOf(knownWith(exerciseNow(), { connected: "waiting" }), en);
    expect([goal.screen, goal.text, goal.more]).toEqual(["wait", en.screen.lost, en.screen.lostMore]);
    expect(goalOf(knownWith(undefined, { connected: "connecting", ever: false }), en).text).toBe(en.screen.connecting);
  });

  it("says that nothing presses on the hand after a stop, a fault and in a break", () => {
    const paused = exerciseNow({ phase: "paused" });
    for (const changes of [{}, { stopped: true }, { fault: true }]) {
      const goal = goalOf(knownWith(paused, changes), en);
      expect(goal.screen).toBe("break");
      expect(goal.more).toContain("Nothing presses on your hand");
    }
  });

  it("tells break, stop, fault, rest and the two questions apart by their pictures", () => {
    const picture = (changes: Parameters<typeof exerciseNow>[0], known: Parameters<typeof knownWith>[1] = {}) => goalOf(knownWith(exerciseNow(changes), known), en).picture;
    const pictures = [
      picture({ phase: "paused" }), picture({ phase: "paused" }, { stopped: true }), picture({ phase: "paused" }, { fault: true }), picture({ phase: "rest" }),
      picture({ phase: "rest", instruction: "Let go. The second one comes." }), picture({ phase: "rating", asks: "pain" }), picture({ phase: "rating", asks: "tired" }),
    ];
    expect(pictures).toEqual(["cup", "stop", "helper", "hand", "second", "pain", "tired"]);
  });

  it("leads from the greeting to the thanks", () => {
    const screens = [
      knownWith(undefined), knownWith(exerciseNow({ stage: "opening" })), knownWith(exerciseNow({ phase: "ready" })), knownWith(exerciseNow({ phase: "warm_up" })),
      knownWith(exerciseNow({ phase: "rating", asks: "tired" })), knownWith(exerciseNow({ phase: "rest" })), knownWith(exerciseNow()), knownWith(exerciseNow({ phase: "answer" })),
      knownWith(exerciseNow({ stage: "closing", phase: "done" })), knownWith(exerciseNow({ stage: "ended", phase: "done" })),
    ].map((known) => goalOf(known, en).screen);
    expect(screens).toEqual(["greet", "greet", "ready", "rest", "rating", "rest", "play", "answer", "done", "done"]);
  });
});
