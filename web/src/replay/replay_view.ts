// SPDX-License-Identifier: Apache-2.0
// The page of one recording that is open: view, plots, figures, scrubber, events.
import { el, section, setText } from "../panels/dom";
import { notLoaded } from "../panels/not_loaded";
import { openingsText } from "../panels/openings";
import { readouts, type Readouts } from "../panels/readouts";
import { viewFrame, type ViewFrame } from "../panels/view_frame";
import type { PlotPanel } from "../plots/plot_panel";
import { strings } from "../strings";
import type { ThemeName } from "../theme";
import type { Shapes } from "../view3d/shapes";
import { about } from "./about";
import type { Layout } from "./chunk";
import type { Decoder } from "./decoder";
import { eventList, happenings, type Happening } from "./event_list";
import { note } from "./note";
import { Overview } from "./overview";
import { Player } from "./player";
import type { Recording } from "./recording";
import { scrubber } from "./scrubber";
import { transport } from "./transport";

const kReadoutMs = 80; // as in the cockpit
const kPlotMs = 33;
const kPlotRest = 4;
const kOverviewMs = 200; // at most so often the overview is drawn

export interface ReplayView {
  readonly player: Player;
  readonly frame: ViewFrame;
  readonly overview: Overview;
  readonly content: readonly HTMLElement[]; // what scrolls on a small screen
  readonly dock: HTMLElement; // playback and scrubber, always in sight
  draw(now: number): void; // once a frame
  skip(seconds: number): void;
  toggle(): void;
  event(direction: 1 | -1): void;
  setTheme(theme: ThemeName): void;
  close(): void;
}

/// Which digits had no force, without the cockpit's button.
function silentDigits(player: Player): Readouts {
  const line = el("p", { role: "status" });
  return {
    element: el("div", { class: "openings" }, el("div", { class: "silent-digits" }, line)),
    update: () => setText(line, openingsText(player.lost ? [] : (player.tick?.opening ?? []))),
  };
}

/// Where chunks are decompressed and shapes are made, and the curves if the page has them.
export interface Workshop {
  decoder(layout: Layout): Decoder;
  shapes(bytes: ArrayBuffer): Promise<Shapes>;
  plots?(): Promise<{ readonly plotPanel: (player: Player, theme: ThemeName) => PlotPanel }>;
}

export function replayView(recording: Recording, theme: ThemeName, workshop: Workshop): ReplayView {
  const decoder = workshop.decoder(recording.layout);
  const surveyor = workshop.decoder(recording.layout); // of the overview: playing does not wait for it
  const player = new Player(recording, decoder, workshop.shapes);
  const overview = new Overview(recording);
  const ended = new AbortController();
  let list: Happening[] = [];
  let colours = theme;
  let plots: PlotPanel | undefined;

  const seek = (time: number) => player.seek(time);
  const toggle = () => {
    if (player.playhead.playing) player.playhead.pause();
    else player.playhead.play();
  };
  const event = (direction: 1 | -1) => {
    const { position } = player.playhead;
    const kHere = 1e-6; // [s]: an event so near is the displayed one
    const next = direction > 0 ? list.find(({ time }) => time > position + kHere) : [...list].reverse().find(({ time }) => time < position - kHere);
    if (next) seek(next.time);
  };
  const over = note(player, overview, () => {
    player.retry();
    if (overview.trouble !== undefined) survey();
  });
  const watermark = el("span", { class: "watermark", "aria-hidden": "true" }, strings.replay.watermark);
  const numbers = readouts(player, silentDigits(player));
  const frame = viewFrame(player, [watermark, over.element]);
  const plotPlace = el("div", { class: "plot-slot" });
  const bar = transport(player.playhead, Number(recording.layout.begin) / 1e9, { toggle, pose: (direction) => void player.step(direction), event });
  const track = scrubber(overview, recording.seconds, theme, seek);
  const events = eventList(seek);
  const facts = about(player, overview);
  const panel = el("div", { class: "tab-panel" }, el("div", {}, section(strings.replay.events, events.element), facts.element));
  const dock = el("section", { class: "replay-dock", "aria-label": strings.replay.transport }, bar.element, track.element);

  let drawnAt = -Infinity;
  let stale = true; // the overview has grown since it was drawn
  let dead: boolean | undefined; // the view
  const survey = () => void overview.fill(surveyor, () => (stale = true), ended.signal);
  survey();
  void (async () => {
    const view = frame.load(theme);
    try {
      const curves = await workshop.plots?.();
      if (curves && !ended.signal.aborted) {
        plots = curves.plotPanel(player, colours);
        plotPlace.append(plots.element);
      }
    } catch (reason) {
      console.error(reason);
      plotPlace.append(notLoaded(strings.plots.notLoaded));
    }
    await view;
    if (ended.signal.aborted) frame.view()?.dispose();
    dead = undefined; // the next frame tells the view
  })();

  let readAt = -Infinity;
  let plotAt = 0;
  return {
    player,
    frame,
    overview,
    content: [
      el("main", { class: "scene" }, numbers.element, frame.element, ...(workshop.plots ? [plotPlace] : [])),
      el("aside", { class: "side", "aria-label": strings.replay.events }, el("div", { class: "tabbed" }, el("div", { class: "tab-panels", tabindex: 0 }, panel))),
    ],
    dock,
    draw(now) {
      player.frame(now);
      if (dead !== player.viewDead) {
        dead = player.viewDead;
        document.documentElement.dataset["view"] = dead ? "dead" : "live";
        frame.view()?.setLost(dead);
      }
      bar.update();
      track.update(player.playhead.position);
      over.update(now);
      if (stale && now - drawnAt > kOverviewMs) {
        stale = false;
        drawnAt = now;
        list = happenings(overview);
        player.events = list;
        events.show(list, overview.progress === 1);
        track.show(list);
      }
      events.update(player.playhead.position);
      if (now - readAt >= kReadoutMs) {
        readAt = now;
        numbers.update();
        facts.update();
        plots?.update();
      }
      if (plots && now >= plotAt) {
        const began = performance.now();
        plots.draw();
        plotAt = now + Math.max(kPlotMs, kPlotRest * (performance.now() - began));
      }
    },
    skip: (seconds) => seek(player.playhead.position + seconds),
    toggle,
    event,
    setTheme(next) {
      colours = next;
      frame.setTheme(next);
      plots?.setTheme(next);
      track.setTheme(next);
    },
    close() {
      ended.abort();
      decoder.close();
      surveyor.close();
      plots?.dispose();
      frame.view()?.dispose();
      dock.remove();
      delete document.documentElement.dataset["view"];
    },
  };
}
