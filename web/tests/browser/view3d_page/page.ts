// SPDX-License-Identifier: Apache-2.0
// The 3D view alone, fed with a recording from the test's own server: for looking at it and for tests of it.
import { fromBinary } from "@bufbuild/protobuf";
import { PerspectiveCamera } from "three";
import { GeometrySchema } from "../../../src/gen/phalanx/geometry_pb";
import { TickSchema, type Tick } from "../../../src/gen/phalanx/tick_pb";
import { Canvas } from "../../../src/view3d/canvas";
import { HandScene } from "../../../src/view3d/hand_scene";
import type { HandView, ViewProbe } from "../../../src/view3d/hand_view";
import { qualityLevels } from "../../../src/view3d/quality";
import { shapesOf, type Shapes } from "../../../src/view3d/shapes";
import { createHandView } from "../../../src/view3d/view";
import type { ViewTrouble } from "../../../src/view3d/view";

export interface ViewPage {
  readonly view: HandView;
  readonly troubles: ViewTrouble[];
  load(recording: string): Promise<void>;
  show(recording: string, tick: number): Promise<void>;
  play(recording: string, hertz: number): Promise<() => void>;
  settled(): Promise<ViewProbe>; // after two more frames of the screen
  /// Draws by a renderer of one kind and then of the other, so many times, in a canvas beside the view's.
  swing(recording: string, tick: number, times: number, after: () => void): Promise<void>;
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

async function shapes(recording: string): Promise<Shapes> {
  return shapesOf(fromBinary(GeometrySchema, await bytes(`/recording/${recording}/geometry`)));
}

async function tick(recording: string, number: number): Promise<Tick> {
  return fromBinary(TickSchema, await bytes(`/recording/${recording}/tick/${number}`));
}

const nextFrame = (): Promise<void> => new Promise((done) => requestAnimationFrame(() => done()));

window.viewPage = {
  view,
  troubles,
  load: async (recording) => view.setGeometry(await shapes(recording)),
  show: async (recording, number) => view.show(await tick(recording, number)),
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
  swing: async (recording, number, times, after) => {
    const scene = new HandScene();
    const canvas = new Canvas(document.createElement("div"), () => {}, () => scene.release(), (what) => troubles.push(what));
    const camera = new PerspectiveCamera(40, 1, 0.01, 10);
    camera.position.set(0.4, 0.4, 0.4);
    camera.lookAt(0, 0, 0);
    scene.setGeometry(await shapes(recording));
    scene.show(await tick(recording, number));
    for (let i = 0; i < times; ++i) {
      for (const level of [2, 1]) {
        const settings = qualityLevels[level]!;
        const renderer = canvas.use(settings.antialias)!;
        scene.setQuality(settings, renderer);
        renderer.shadowMap.needsUpdate = true;
        renderer.render(scene.scene, camera);
        renderer.render(scene.over, camera);
      }
      after();
    }
    canvas.dispose();
    scene.dispose();
  },
};
