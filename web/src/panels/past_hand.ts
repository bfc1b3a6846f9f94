// SPDX-License-Identifier: Apache-2.0
// While the plots are paused: the hand of the moment that is pointed at, in the place of the one of now, and the words on that.
import type { LookBack } from "../replay/look_back";
import { strings } from "../strings";
import type { App } from "./app";
import { button, el, setShown, setText } from "./dom";
import type { ViewFrame } from "./view_frame";

const words = strings.past;

export interface PastHandNote {
  readonly element: HTMLElement;
  /// The plots are pointed at. @param time  on the ticks' clock [s]; null: no longer, and the hand stays
  point(time: number | null): void;
  /// @param frame  the view that shows it
  attach(frame: Pick<ViewFrame, "showPast">): void;
}

/// @param open  begins to read the running recording with this name
export function pastHand(app: App, open: (name: string) => Promise<LookBack>): PastHandNote {
  const { store } = app;
  const text = el("p", { role: "status" });
  const now = button(words.now, () => store.setPaused(false));
  const element = el("div", { class: "past-note", hidden: true }, text, now);
  let frame: Pick<ViewFrame, "showPast"> | undefined;
  let reader: { readonly file: string; readonly look: Promise<LookBack> } | undefined;
  let wanted: number | undefined;
  let working = false;
  let pause = 0; // number of the pause: what is read for an earlier one is dropped, or never comes
  let said = ""; // on the moment that was pointed at; empty: none was

  /// Why no earlier moment can be shown; empty: it can.
  function hindrance(): string {
    if (!store.connected) return words.offline;
    if (store.role === "watch_only") return words.refused;
    return store.state?.recording ? "" : words.notRecorded;
  }

  function update(): void {
    setShown(element, store.paused);
    if (!store.paused) return;
    setText(text, said || hindrance() || words.hint);
  }

  async function readerOf(file: string): Promise<LookBack> {
    if (reader?.file !== file) {
      end();
      reader = { file, look: open(file.split("/").at(-1) ?? file) };
    }
    return reader.look;
  }

  function end(): void {
    void reader?.look.then((look) => look.close(), () => {});
    reader = undefined;
  }

  /// Shows the newest moment that is wanted. Those that were pointed at while one was read are passed over.
  async function work(): Promise<void> {
    if (working) return;
    working = true;
    const mine = pause;
    while (wanted !== undefined) {
      const time = wanted;
      wanted = undefined;
      const recording = store.state?.recording;
      if (!recording || hindrance() !== "") {
        said = hindrance();
        break;
      }
      try {
        const look = await readerOf(recording.file);
        const hand = await look.at(time, store.utcOffset, store.state?.recording?.bytes ?? recording.bytes);
        if (mine !== pause) return;
        frame?.showPast(hand);
        said = hand ? words.shown((store.history.end - hand.tick.time).toFixed(1)) : words.hole;
      } catch (reason) {
        if (mine !== pause) return;
        console.error(reason);
        end();
        frame?.showPast(undefined);
        said = words.failed;
      }
      update();
    }
    working = false;
    update();
  }

  let wasPaused = store.paused;
  store.on(["own"], () => {
    if (store.paused === wasPaused) return;
    wasPaused = store.paused;
    if (!store.paused) {
      ++pause;
      working = false;
      wanted = undefined;
      said = "";
      frame?.showPast(undefined);
      end();
    }
    update();
  });
  store.on(["connection", "state"], update);
  return {
    element,
    point(time) {
      if (time === null || !store.paused) return;
      wanted = time;
      void work();
    },
    attach: (view) => (frame = view),
  };
}
