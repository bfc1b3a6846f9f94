// SPDX-License-Identifier: Apache-2.0
// What `phalanx simulate SCENE --out DIR --poses [--contacts]` wrote, as the messages that a station would send.
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { create } from "@bufbuild/protobuf";
import { Matrix4, Quaternion, Vector3 } from "three";
import { GeometrySchema, MeshSchema, SkinSchema } from "../../../src/gen/phalanx/geometry_pb";
import type { Geometry, Mesh, Skin } from "../../../src/gen/phalanx/geometry_pb";
import { ContactPointSchema, ContactSchema, TickSchema } from "../../../src/gen/phalanx/tick_pb";
import type { Contact, Tick } from "../../../src/gen/phalanx/tick_pb";

const fingers = ["index-finger", "middle-finger", "ring-finger", "pinky-finger"];
export const segmentNames: readonly string[] = [
  "thumb-metacarpal", "thumb-phalanx-proximal", "thumb-phalanx-distal",
  ...fingers.flatMap((finger) => ["proximal", "intermediate", "distal"].map((part) => `${finger}-phalanx-${part}`)),
  "wrist",
];

export interface Recording {
  readonly geometry: Geometry;
  readonly ticks: Tick[];
}

/// @param skin  "none", "made" (a stand-in: the segments with their seams blended), or the path of a skin's JSON file
/// @param straight  poses of the same hand with all joints at zero, for that file
export function readRecording(folder: string, left: boolean, skin: string, straight: readonly number[]): Recording {
  const segment = segmentNames.map((name) => readObj(join(folder, "hand", `${name}.obj`)));
  const ticks = readTicks(folder);
  const geometry = create(GeometrySchema, {
    revision: 1, left, segment, object: readObj(join(folder, "object.obj")), rateHz: 200, segmentName: [...segmentNames],
  });
  if (skin === "made") geometry.skin = madeSkin(segment, ticks[0]!.gdpPose);
  else if (skin !== "none") geometry.skin = readSkin(skin, left, straight);
  return { geometry, ticks };
}

function readObj(path: string): Mesh {
  const position: number[] = [];
  const index: number[] = [];
  for (const line of readFileSync(path, "utf8").split("\n")) {
    const [kind, ...rest] = line.trim().split(/\s+/);
    if (kind === "v") position.push(...rest.slice(0, 3).map(Number));
    if (kind === "f") index.push(...rest.slice(0, 3).map((corner) => parseInt(corner, 10) - 1));
  }
  return create(MeshSchema, { position, index });
}

function rows(path: string): { column: Map<string, number>; lines: string[][] } {
  const [head, ...lines] = readFileSync(path, "utf8").trim().split("\n").map((line) => line.split(","));
  return { column: new Map(head!.map((name, i) => [name, i])), lines };
}

function readTicks(folder: string): Tick[] {
  const poses = rows(join(folder, "poses.csv"));
  const ticks = rows(join(folder, "ticks.csv"));
  const byTick = new Map<string, Tick>();
  const result = ticks.lines.map((line) => {
    const get = (name: string): number => Number(line[ticks.column.get(name) ?? -1] ?? NaN);
    const tick = create(TickSchema, { tick: BigInt(line[0]!), time: get("time_s"), factor: 1, contact: segmentNames.flatMap((name, i) => contactOf(get, name, i)) });
    byTick.set(line[0]!, tick);
    return tick;
  });
  for (const line of poses.lines) {
    const [x, y, z, qw, qx, qy, qz] = line.slice(3).map(Number);
    const tick = byTick.get(line[0]!)!;
    (line[2] === "hcp" ? tick.hcpPose : tick.gdpPose).push(x!, y!, z!, qx!, qy!, qz!, qw!);
  }
  const contacts = join(folder, "contacts.csv");
  if (existsSync(contacts)) readContacts(contacts, byTick);
  return result;
}

function readContacts(path: string, byTick: ReadonlyMap<string, Tick>): void {
  for (const line of rows(path).lines) {
    const numbers = line.slice(2).map(Number);
    const [x, y, z] = numbers.slice(7, 10) as [number, number, number]; // friction
    const force = numbers[6]!;
    byTick.get(line[0]!)?.contactPoint.push(create(ContactPointSchema, {
      segment: segmentNames.indexOf(line[1]!), point: numbers.slice(0, 3), normal: numbers.slice(3, 6), force, friction: [x, y, z],
      spin: numbers[10]!, coefficient: numbers[11]!, slips: numbers[12]! > 0,
    }));
  }
}

function contactOf(get: (name: string) => number, segmentName: string, segment: number): Contact[] {
  const name = segmentName.replaceAll("-", "_"); // as columns have it
  const touching = get(`${name}_contact`) > 0;
  const force = get(`${name}_force_n`);
  if (!touching && !(force > 0)) return [];
  return [create(ContactSchema, {
    segment, touching, depth: get(`${name}_depth_m`), forceRaw: get(`${name}_force_raw_n`), force, slips: get(`${name}_slip`) > 0,
    point: [get(`${name}_px_m`), get(`${name}_py_m`), get(`${name}_pz_m`)],
    normal: [get(`${name}_nx`), get(`${name}_ny`), get(`${name}_nz`)],
  })];
}

/// X_WS as matrices, seen from the palm: bind poses in the hand frame.
function fromPalm(poses: readonly number[]): Matrix4[] {
  const matrices = segmentNames.map((_, i) => {
    const [x, y, z, a, b, c, d] = poses.slice(7 * i, 7 * i + 7);
    return new Matrix4().compose(new Vector3(x, y, z), new Quaternion(a, b, c, d), new Vector3(1, 1, 1));
  });
  const fromW = matrices[15]!.clone().invert();
  return matrices.map((matrix) => fromW.clone().multiply(matrix));
}

/// The segments' own surfaces, each vertex held also by the parent where it is near the joint.
function madeSkin(segments: readonly Mesh[], poses: readonly number[]): Skin {
  const bind = fromPalm(poses);
  const skin = create(SkinSchema, { mesh: create(MeshSchema, {}) });
  segments.forEach((mesh, segment) => {
    const first = skin.mesh!.position.length / 3;
    const parent = segment === 15 ? 15 : segment % 3 === 0 ? 15 : segment - 1;
    for (let i = 0; i < mesh.position.length; i += 3) {
      const local = new Vector3(...(mesh.position.slice(i, i + 3) as [number, number, number]));
      const share = segment === 15 ? 0 : Math.max(0, 0.5 - local.length() / 0.024);
      skin.segment.push(segment, parent, 0, 0);
      skin.weight.push(1 - share, share, 0, 0);
      local.applyMatrix4(bind[segment]!);
      skin.mesh!.position.push(local.x, local.y, local.z);
    }
    skin.mesh!.index.push(...mesh.index.map((corner) => corner + first));
  });
  skin.bindPose = poseArray(bind);
  return skin;
}

interface SkinFile {
  readonly segments: readonly string[];
  readonly vertices_mm: readonly (readonly [number, number, number])[];
  readonly influences: readonly (readonly (readonly [number, number])[])[];
  readonly triangles: readonly (readonly [number, number, number])[];
}

/// A right hand's skin; a left hand's is its mirror image in x = 0. `poses`: of a hand with all joints at zero.
function readSkin(path: string, left: boolean, poses: readonly number[]): Skin {
  const file = JSON.parse(readFileSync(path, "utf8")) as SkinFile;
  const side = left ? -1 : 1;
  const number = file.segments.map((name) => segmentNames.indexOf(name));
  const skin = create(SkinSchema, { mesh: create(MeshSchema, {}), bindPose: poseArray(fromPalm(poses)) });
  skin.mesh!.position = file.vertices_mm.flatMap(([x, y, z]) => [(side * x) / 1000, y / 1000, z / 1000]);
  skin.mesh!.index = file.triangles.flatMap(([a, b, c]) => (left ? [a, c, b] : [a, b, c]));
  for (const influences of file.influences) {
    for (let k = 0; k < 4; ++k) {
      skin.segment.push(number[influences[k]?.[0] ?? 0]!);
      skin.weight.push(influences[k]?.[1] ?? 0);
    }
  }
  return skin;
}

function poseArray(matrices: readonly Matrix4[]): number[] {
  return matrices.flatMap((matrix) => {
    const position = new Vector3();
    const rotation = new Quaternion();
    matrix.decompose(position, rotation, new Vector3());
    return [...position.toArray(), ...rotation.toArray()];
  });
}
