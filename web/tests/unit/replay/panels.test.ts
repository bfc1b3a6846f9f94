// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it } from "vitest";
import { eventList, type Happening } from "../../../src/replay/event_list";
import { listenToReplayKeys, type ReplayActions } from "../../../src/replay/replay_keys";
import { SourceError } from "../../../src/replay/source";
import { startPanel } from "../../../src/replay/start_panel";
import type { Listed } from "../../../src/replay/station_list";
import { durationText } from "../../../src/panels/as_text";
import { strings } from "../../../src/strings";

const words = strings.replay;
beforeEach(() => document.body.replaceChildren());

describe("the choice of a recording", () => {
  const listed = (name: string, state = "whole"): Listed => ({ name, bytes: 2e6, begin: 1000, seconds: 75, events: 2, gaps: 1, scene: "first_touch", device: "beihang", opens: state === "whole", state });

  it("opens those that are whole, and names the reason for the others", async () => {
    const opened: string[] = [];
    const panel = startPanel({ list: () => Promise.resolve({ folder: "out", recordings: [listed("b", "being written"), listed("a")] }), openListed: (name) => opened.push(name), openFile: () => {} });
    await panel.look();
    const rows = [...panel.element.querySelectorAll("tbody tr")];
    expect(rows.map((row) => row.querySelector("button") !== null)).toEqual([false, true]);
    expect(rows[0]!.textContent).toContain("being written");
    expect(rows[1]!.textContent).toContain("01:15");
    rows[1]!.querySelector("button")!.click();
    expect(opened).toEqual(["a"]);
  });

  it("says why there is no list; a file of this computer can be chosen in any case", async () => {
    const files: File[] = [];
    const panel = startPanel({ list: () => Promise.reject(new SourceError("refused", "")), openListed: () => {}, openFile: (file) => files.push(file) });
    await panel.look();
    expect(panel.element.querySelector("[role=status]")!.textContent).toBe(words.trouble.refused);
    const input = panel.element.querySelector<HTMLInputElement>("input[type=file]")!;
    const file = new File(["x"], "x.mcap");
    Object.defineProperty(input, "files", { value: [file] });
    input.dispatchEvent(new Event("change"));
    expect(files).toEqual([file]);
  });
});

describe("what happened", () => {
  const list: readonly Happening[] = [
    { time: 0, code: "station", kind: "other", label: "Station", text: "begins" },
    { time: 5, code: "marker", kind: "marker", label: "Marker", text: "stimulus 1" },
    { time: 9, code: "fault", kind: "bad", label: "Fault", text: "no sample" },
  ];

  it("is listed by time; a press goes there, and the newest one at the displayed moment is marked", () => {
    const gone: number[] = [];
    const events = eventList((time) => gone.push(time));
    events.show(list, true);
    const rows = () => [...events.element.querySelectorAll<HTMLButtonElement>(".happening")];
    rows()[1]!.click();
    expect(gone).toEqual([5]);
    const marked = () => rows().flatMap((row, i) => (row.getAttribute("aria-current") ? [i] : []));
    for (const [position, is] of [[0, [0]], [4.9, [0]], [5, [1]], [100, [2]], [2, [0]]] as const) {
      events.update(position);
      expect(marked(), `at ${position}`).toEqual(is);
    }
    events.show(list.slice(0, 2), true);
    events.update(100);
    expect(marked()).toEqual([1]);
  });

  it("keeps its entries, and the focus on one, while nothing is added", () => {
    const events = eventList(() => {});
    document.body.append(events.element);
    events.show(list, false);
    const entry = events.element.querySelectorAll<HTMLButtonElement>(".happening")[1]!;
    entry.focus();
    events.show(list.map((one) => ({ ...one })), true);
    expect(entry.isConnected).toBe(true);
    expect(document.activeElement).toBe(entry);
    events.show([...list, { ...list[2]!, time: 11 }], true);
    expect(events.element.querySelectorAll(".happening").length).toBe(4);
  });

  it("has no event only once all is read, and says how many are listed of very many", () => {
    const events = eventList(() => {});
    const hints = () => [...events.element.querySelectorAll<HTMLElement>(".hint")].filter(({ hidden }) => !hidden).map((hint) => hint.textContent);
    events.show([], false);
    expect(hints()).toEqual([words.reading]);
    events.show([], true);
    expect(hints()).toEqual([words.noEvents]);
    events.show(Array.from({ length: 1200 }, (_, i) => ({ ...list[1]!, time: i })), true);
    expect(hints()).toEqual([words.moreEvents("1,000", "1,200")]);
  });

  it("shows markers alone if that is wanted, and offers it where there are some", () => {
    const events = eventList(() => {});
    const only = events.element.querySelector<HTMLButtonElement>("[role=switch]")!;
    expect(only.hidden).toBe(true);
    events.show(list, true);
    expect(only.hidden).toBe(false);
    only.click();
    expect([...events.element.querySelectorAll(".happening-text")].map((row) => row.textContent)).toEqual(["stimulus 1"]);
  });
});

describe("the keys of a recording", () => {
  const done: string[] = [];
  let isOpen = true;
  const actions: ReplayActions = {
    isOpen: () => isOpen,
    escape: () => done.push("escape"),
    toggle: () => done.push("toggle"),
    skip: (seconds) => done.push(`skip ${seconds}`),
    pose: (direction) => done.push(`pose ${direction}`),
    event: (direction) => done.push(`event ${direction}`),
    goTo: (end) => done.push(end),
    faster: (steps) => done.push(`faster ${steps}`),
    help: () => done.push("help"),
    camera: (preset) => done.push(preset),
    zoom: (factor) => done.push(factor > 1 ? "nearer" : "farther"),
  };
  const source = new EventTarget();
  listenToReplayKeys(source as Window, actions);
  const press = (key: string, options: KeyboardEventInit = {}, prevented = false) => {
    done.length = 0;
    const event = new KeyboardEvent("keydown", { key, cancelable: true, ...options });
    if (prevented) event.preventDefault();
    source.dispatchEvent(event);
    return [...done];
  };

  it("do what their list says", () => {
    expect(["ArrowLeft", "ArrowRight", ",", ".", "PageUp", "PageDown", "Home", "End", "<", ">", "2", "+", "-", "?", " "].flatMap((key) => press(key))).toEqual([
      "skip -1", "skip 1", "pose -1", "pose 1", "event -1", "event 1", "begin", "end", "faster -1", "faster 1", "palm", "nearer", "farther", "help", "toggle",
    ]);
    expect(press("ArrowLeft", { shiftKey: true })).toEqual(["pose -1"]);
    expect(press("ArrowRight", { shiftKey: true })).toEqual(["pose 1"]);
  });

  it("belong to the browser while no recording is open; Esc and the list of keys are there always", () => {
    isOpen = false;
    expect([" ", "Home", "End", "PageDown", "ArrowLeft", "?", "Escape"].flatMap((key) => press(key))).toEqual(["help", "escape"]);
    isOpen = true;
    expect(press("Escape")).toEqual(["escape"]);
  });

  it("leave alone what the focus has taken, and the browser's own", () => {
    expect(press("ArrowLeft", {}, true)).toEqual([]);
    expect(press("ArrowLeft", { altKey: true })).toEqual([]);
    expect(press("Home", { ctrlKey: true })).toEqual([]);
    expect(press("a")).toEqual([]);
    expect(press(" ", { repeat: true })).toEqual([]); // held down: it does not flicker
  });
});

it("a length is a clock's time, with hours where it has some", () => {
  expect(durationText(0)).toBe("00:00.0");
  expect(durationText(75.26)).toBe("01:15.2");
  expect(durationText(3599.99, 0)).toBe("59:59");
  expect(durationText(3727.3)).toBe("1:02:07.3");
});
