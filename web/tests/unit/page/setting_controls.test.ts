// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { fromScale, guarded, logSliderRow, numberRow, toScale } from "../../../src/panels/setting_controls";
import { fakeApp, stiffness, type FakeApp } from "./fake_app";

let fake: FakeApp;
beforeEach(() => {
  vi.useFakeTimers();
  fake = fakeApp();
});
afterEach(() => vi.useRealTimers());

const slider = () => logSliderRow(fake.app, stiffness, { label: "Stiffness", field: "Number", unit: "N/mm" }, 0.1, 5, document.createElement("div"));
function enter(row: HTMLElement, text: string): void {
  const field = row.querySelector<HTMLInputElement>("input[type=text]")!;
  field.value = text;
  field.dispatchEvent(new Event("input"));
  field.dispatchEvent(new Event("change"));
}

describe("controls", () => {
  it("are usable on the page that has control, and on no other", () => {
    const fieldset = guarded(fake.app);
    expect(fieldset.disabled).toBe(true);
    fake.operate(2);
    expect(fieldset.disabled).toBe(false);
    fake.operate(3);
    expect(fieldset.disabled).toBe(true);
    fake.operate(2);
    fake.store.setPhase("waiting");
    expect(fieldset.disabled).toBe(true);
  });

  it("a dragged slider sends at most ten changes a second, and the last one", async () => {
    fake.operate(2);
    const range = slider().querySelector<HTMLInputElement>("input[type=range]")!;
    for (let i = 0; i <= 100; ++i) {
      range.value = String(10 * i);
      range.dispatchEvent(new Event("input"));
      await vi.advanceTimersByTimeAsync(10);
    }
    range.dispatchEvent(new Event("change"));
    await vi.advanceTimersByTimeAsync(500);
    expect(fake.asked.length).toBeLessThanOrEqual(12);
    expect(fake.asked.at(-1)).toEqual([[stiffness, "5"]]);
    expect(fake.dragging.length).toBeGreaterThan(2);
    expect(fake.dragging, "the last one alone is for the log").toEqual(fake.dragging.map((_, i) => i < fake.dragging.length - 1));
  });

  it("a key that is held down drags the slider until it comes up, and a click moves it at once", async () => {
    fake.operate(2);
    const range = slider().querySelector<HTMLInputElement>("input[type=range]")!;
    const move = (to: number) => {
      range.value = String(to);
      range.dispatchEvent(new Event("input"));
      range.dispatchEvent(new Event("change"));
    };
    for (let i = 1; i <= 3; ++i) {
      range.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight" }));
      move(500 + i);
      await vi.advanceTimersByTimeAsync(200);
    }
    range.dispatchEvent(new KeyboardEvent("keyup", { key: "ArrowRight" }));
    expect(fake.dragging).toEqual([true, true, true, false]);
    await vi.advanceTimersByTimeAsync(200);
    move(700);
    await vi.advanceTimersByTimeAsync(200);
    range.dispatchEvent(new Event("blur"));
    expect(fake.dragging.slice(4)).toEqual([true, false]);
  });

  it("a number that is dragged or typed is never replaced by an older one while it is on its way", async () => {
    fake.operate(2, [[stiffness, "0.5"]]);
    const element = slider();
    const range = element.querySelector<HTMLInputElement>("input[type=range]")!;
    const field = element.querySelector<HTMLInputElement>("input[type=text]")!;
    const drag = (to: number) => {
      range.value = String(to);
      range.dispatchEvent(new Event("input"));
      return field.value;
    };
    const told = drag(600); // sent at once
    const wanted = drag(700); // waits for its turn
    expect(Number(wanted)).toBeGreaterThan(Number(told));
    fake.operate(2, [[stiffness, "0.5"]]);
    await vi.advanceTimersByTimeAsync(0); // the first one's answer
    expect(field.value).toBe(wanted);
    expect(range.getAttribute("aria-valuetext")).toBe(`${wanted} N/mm`);
    range.dispatchEvent(new Event("pointerup"));
    expect(field.value).toBe(wanted);
    expect(fake.asked.at(-1)).toEqual([[stiffness, wanted]]);

    enter(element, "2.5"); // so soon after the drag it waits, too
    fake.operate(2, [[stiffness, wanted]]);
    expect(field.value).toBe("2.5");
    await vi.advanceTimersByTimeAsync(300);
    expect(fake.asked.at(-1)).toEqual([[stiffness, "2.5"]]);
    fake.operate(2, [[stiffness, "0.7"]]);
    await vi.advanceTimersByTimeAsync(3000);
    fake.operate(2, [[stiffness, "0.7"]]);
    expect(field.value).toBe("0.7");
  });

  it("what is refused is said in the host's words, and the control goes back to the truth", async () => {
    fake.operate(2, [[stiffness, "0.7"]]);
    const element = slider();
    fake.refuse = "beyond its range";
    enter(element, "900");
    await vi.advanceTimersByTimeAsync(300);
    expect(fake.asked).toEqual([[[stiffness, "900"]]]);
    expect(element.querySelector(".refused")?.textContent).toBe("beyond its range");
    expect(element.querySelector<HTMLInputElement>("input[type=text]")!.value).toBe("0.7");
  });

  it("the stiffness scale is logarithmic and goes there and back", () => {
    expect(fromScale(0, 0.1, 5)).toBeCloseTo(0.1, 12);
    expect(fromScale(1, 0.1, 5)).toBeCloseTo(5, 12);
    expect(fromScale(0.5, 0.1, 5)).toBeCloseTo(Math.sqrt(0.5), 12);
    for (const value of [0.1, 0.3, 1, 4.9]) expect(fromScale(toScale(value, 0.1, 5), 0.1, 5)).toBeCloseTo(value, 12);
    expect(toScale(50, 0.1, 5)).toBe(1);
  });

  it("a drag ends where the finger leaves, or with control", async () => {
    fake.operate(2, [[stiffness, "0.5"]]);
    const range = slider().querySelector<HTMLInputElement>("input[type=range]")!;
    const before = range.value;
    for (const end of ["pointerup", "pointercancel", "blur"]) {
      range.value = "900";
      range.dispatchEvent(new Event("input"));
      range.dispatchEvent(new Event(end));
      await vi.advanceTimersByTimeAsync(3000);
      fake.operate(2, [[stiffness, "0.5"]]);
      expect(range.value, end).toBe(before);
    }
    const count = fake.asked.length;
    range.value = "900";
    range.dispatchEvent(new Event("input"));
    range.value = "950";
    range.dispatchEvent(new Event("input")); // waits for its turn
    fake.operate(3, [[stiffness, "0.5"]]);
    await vi.advanceTimersByTimeAsync(3000);
    fake.operate(2, [[stiffness, "0.5"]]);
    expect(range.value).toBe(before);
    expect(fake.asked.length).toBeLessThanOrEqual(count + 1);
  });

  it("take a decimal comma, on the slider's field and on any other", async () => {
    fake.operate(2);
    enter(slider(), "1,6");
    enter(numberRow(fake.app, "smoothing.max_n_per_s", "Rise", "N/s"), " 2,5 ");
    enter(numberRow(fake.app, "limits.joint_torque_nm", "Torque", "Nm"), "off");
    enter(numberRow(fake.app, "rate_hz", "Rate", "Hz"), "");
    await vi.advanceTimersByTimeAsync(300);
    expect(fake.asked).toEqual([[[stiffness, "1.6"]], [["smoothing.max_n_per_s", "2.5"]], [["limits.joint_torque_nm", '"off"']], [["rate_hz", ""]]]);
  });
});
