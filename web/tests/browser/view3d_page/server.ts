// SPDX-License-Identifier: Apache-2.0
// Serves the page and recordings: each is simulated when it is asked for first, into a temporary folder.
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { toBinary } from "@bufbuild/protobuf";
import { createServer } from "vite";
import type { ViteDevServer } from "vite";
import { GeometrySchema } from "../../../src/gen/phalanx/geometry_pb";
import { TickSchema } from "../../../src/gen/phalanx/tick_pb";
import { readRecording } from "./fixture";
import type { Recording } from "./fixture";

const here = dirname(fileURLToPath(import.meta.url));
const program = process.env["PHALANX_PROGRAM"] ?? resolve(here, "../../../../build/release/bin/phalanx");
const skinFile = resolve(here, "../../../../assets/hands/generic/skin.json");
const recordings = new Map<string, Recording>();
let folderOfThisProcess = "";

/// Of this process, until it ends.
function folderOfRecordings(): string {
  if (folderOfThisProcess === "") {
    folderOfThisProcess = mkdtempSync(join(tmpdir(), "phalanx_recordings_"));
    process.on("exit", () => rmSync(folderOfThisProcess, { recursive: true, force: true }));
  }
  return folderOfThisProcess;
}

/// Name: SCENE, SCENE,left or SCENE,KEY=VALUE,...; and at last ,skin or ,made for a skin.
export function recording(name: string): Recording {
  const known = recordings.get(name);
  if (known) return known;
  const [scene, ...words] = name.split(",");
  const left = words.includes("left");
  const settings = words.filter((word) => word.includes("=")).concat(left ? ["mirror=true"] : []);
  const folder = join(folderOfRecordings(), name.replaceAll(/[^\w,=.-]/g, "_"));
  execFileSync(program, ["simulate", scene!, "--out", folder, "--poses", "--quiet", ...(settings.includes("contact.mode=sliding") ? ["--contacts"] : []), ...settings.flatMap((word) => ["--set", word])]);
  const skin = words.includes("skin") ? skinFile : words.includes("made") ? "made" : "none";
  // The teapot's grasp begins with all joints at zero.
  const straight = skin === skinFile ? recording(left ? "grasp_teapot,left" : "grasp_teapot").ticks[0]!.gdpPose : [];
  const made = readRecording(folder, left, skin, straight);
  recordings.set(name, made);
  return made;
}

export async function serve(): Promise<{ server: ViteDevServer; url: string }> {
  const server = await createServer({
    root: here,
    configFile: false,
    logLevel: "warn",
    cacheDir: join(tmpdir(), "phalanx_view3d", "vite"),
    server: { host: "127.0.0.1", port: 0, hmr: false, watch: null, fs: { allow: [resolve(here, "../../..")] } },
    plugins: [{ name: "recordings", configureServer: (vite) => void vite.middlewares.use("/recording", answer) }],
  });
  await server.listen();
  return { server, url: server.resolvedUrls!.local[0]! };
}

function answer(request: { url?: string | undefined }, response: import("node:http").ServerResponse): void {
  try {
    const [, name, what, number] = decodeURIComponent(request.url ?? "").split("/");
    const found = recording(name!);
    const body = what === "geometry" ? toBinary(GeometrySchema, found.geometry) : toBinary(TickSchema, found.ticks[Number(number)]!);
    response.setHeader("Content-Type", "application/octet-stream").end(body);
  } catch (error) {
    response.statusCode = 500;
    response.end(String(error));
  }
}
