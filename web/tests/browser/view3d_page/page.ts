// SPDX-License-Identifier: Apache-2.0
// The 3D view alone, fed with a recording from the test's own server: for looking at it and for tests of it.
import { fromBinary } from "@bufbuild/protobuf";
import { GeometrySchema } from "../../../src/gen/phalanx/geometry_pb";
import { TickSchema } from "../../../src/gen/phalanx/tick_pb";
import type { HandView, ViewProbe } from "../../../src/view3d/hand_view";
import { createHandView } from "../../../src/view3d/view";
import type { ViewTrouble } from "../../../src/view3d/view";

export interface ViewPage {
  readonly view: HandView;
  readonly troubles: ViewTrouble[];
  load(recording: string): Promise<void>;
  show(recording: string, tick: number): Promise<void>;
  play(recording: string, hertz: number): Promise<() => void>;
  settled(): Promise<ViewProbe>; // after two more frames of the screen
}

declare global {
  interface Window {
    viewPage: ViewPage;
  }
}

const query = new URLSearchParams(location.search);
const quality = query.get("quality");
const troubles: ViewTrouble[] = [];
const view = createHandView(document.getElementById("host")!, {
  ...(quality === null ? {} : { quality: Number(quality) }),
  onTrouble: (what) => troubles.push(what),
});

async function bytes(path: string): Promise<Uint8Array> {
  const answer = await fetch(path);
  if (!answer.ok) throw new Error(`${path}: ${answer.status}`);
  return new Uint8Array(await answer.arrayBuffer());
}

const nextFrame = (): Promise<void> => new Promise((done) => requestAnimationFrame(() => done()));

window.viewPage = {
  view,
  troubles,
  load: async (recording) => view.setGeometry(fromBinary(GeometrySchema, await bytes(`/recording/${recording}/geometry`))),
  show: async (recording, tick) => view.show(fromBinary(TickSchema, await bytes(`/recording/${recording}/tick/${tick}`))),
  play: async (recording, hertz) => {
    const ticks = await Promise.all(Array.from({ length: 100 }, (_, i) => bytes(`/recording/${recording}/tick/${6 * i}`)));
    let i = 0;
    const timer = setInterval(() => view.show(fromBinary(TickSchema, ticks[i++ % ticks.length]!)), 1000 / hertz);
    return () => clearInterval(timer);
  },
  settled: async () => {
    await nextFrame();
    await nextFrame();
    return view.probe();
  },
};
