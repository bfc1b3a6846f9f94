// SPDX-License-Identifier: Apache-2.0
// Pictures of the 3D view for people to look at. From web/:
//   npx vite-node tests/browser/view3d_page/shoot.ts FOLDER NAME:RECORDING:TICK:PRESET:THEME:QUALITY[:lost][:noskin][:noghost][:noobject][:cones][:zoom=1.5][:kind=mug][:tone=deep] ...
//   for example  /tmp/pictures home:grasp_teapot,skin:240:home:dark:3
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import type { CameraPreset } from "../../../src/view3d/hand_view";
import type { SkinToneName } from "../../../src/view3d/skin_tones";
import type { ThemeName } from "../../../src/theme";
import { launch } from "./browser";
import { serve } from "./server";

interface Shot {
  readonly recording: string;
  readonly tick: number;
  readonly preset: CameraPreset;
  readonly theme: ThemeName;
  readonly flags: string[];
}

const [folder, ...shots] = process.argv.slice(2);
if (!folder || shots.length === 0) throw new Error("say a folder and at least one picture: see the head of this file");
mkdirSync(folder, { recursive: true });
const { server, url } = await serve();
const browser = await launch();
const page = await browser.newPage({ viewport: { width: 1000, height: 750 }, reducedMotion: "reduce" });
page.setDefaultTimeout(300_000);
page.on("console", (message) => {
  if (message.type() === "error") console.error(message.text());
});
for (const words of shots) {
  const [name, recording, tick, preset, theme, quality, ...flags] = words.split(":");
  await page.goto(`${url}?quality=${quality}`);
  await page.waitForFunction(() => window.viewPage !== undefined);
  const shot: Shot = { recording: recording!, tick: Number(tick), preset: preset as CameraPreset, theme: theme as ThemeName, flags };
  const probe = await page.evaluate(async ({ recording, tick, preset, theme, flags }: Shot) => {
    const { view, load, show, settled } = window.viewPage;
    const value = (name: string): string | undefined => flags.find((flag) => flag.startsWith(`${name}=`))?.slice(name.length + 1);
    view.setTheme(theme);
    view.setObjectKind(value("kind") ?? recording.split(",")[0]!.split("_").at(-1)!);
    view.setSkinTone((value("tone") ?? "light") as SkinToneName);
    view.setParts({ skin: !flags.includes("noskin"), ghost: !flags.includes("noghost"), arrows: true, object: !flags.includes("noobject"), cones: flags.includes("cones") });
    await load(recording);
    await show(recording, tick);
    await settled();
    view.camera(preset);
    view.setLost(flags.includes("lost"));
    view.zoom(Number(value("zoom") ?? 1));
    await settled();
    const { tick: shown, arrows } = await settled();
    return `tick ${shown}, ${arrows.length} arrows`;
  }, shot);
  await page.screenshot({ path: join(folder, `${name}.png`) });
  console.log(`${name}: ${probe}`);
}
await browser.close();
await server.close();
