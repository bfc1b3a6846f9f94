// SPDX-License-Identifier: Apache-2.0
// What a replay needs of Setup, Change and Geometry at once. Their meshes, which take most of the bytes, are skipped.
import { BinaryReader, WireType } from "@bufbuild/protobuf/wire";
import { fromBinary } from "@bufbuild/protobuf";
import { SettingSchema, type Setting } from "../gen/phalanx/cockpit_pb";
import { GeometrySchema } from "../gen/phalanx/geometry_pb";
import { ChangeSchema, DeviceChannelSchema, SetupSchema, type DeviceChannel } from "../gen/phalanx/recording_pb";
import { kJointsPerDigit } from "../state/channels";
import { find, kDigitLimit, limitOf } from "../state/keys";
import { unquote } from "../state/toml";

export interface ChangeFacts {
  readonly scene: string;
  readonly slides: boolean; // contacts slide, with friction
  readonly objectKind: string; // empty: not stated
  readonly digitLimit: number; // of a digit's force [N]; Infinity: none, or not stated
  readonly law: string; // empty, as the next ones: not stated
  readonly stabiliser: string;
  readonly rate: string; // [Hz]
}

export interface StationFacts extends ChangeFacts {
  readonly device: string;
  readonly rendersTorque: boolean;
  readonly simulated: boolean;
  readonly sensedJoint: readonly number[];
}

/// Calls `see` with each field that is one of `wanted`.
function eachField(bytes: Uint8Array, see: (field: number, reader: BinaryReader) => boolean): void {
  const reader = new BinaryReader(bytes);
  while (reader.pos < reader.len) {
    const [field, type] = reader.tag();
    const before = reader.pos;
    if (!see(field, reader)) {
      reader.pos = before;
      reader.skip(type as WireType, field);
    }
  }
}

const change = ChangeSchema.field;
const setup = SetupSchema.field;
const geometry = GeometrySchema.field;

export function changeFacts(bytes: Uint8Array): ChangeFacts {
  let scene = "";
  const values: Setting[] = [];
  eachField(bytes, (field, reader) => {
    if (field === change.scene.number) scene = reader.string();
    else if (field === change.value.number) values.push(fromBinary(SettingSchema, reader.bytes()));
    else return false;
    return true;
  });
  const text = (key: string) => unquote(find(values, key) ?? "");
  return {
    scene,
    slides: text("contact.mode") === "sliding",
    objectKind: text("objects.0.kind"),
    digitLimit: limitOf(text(kDigitLimit)),
    law: text("force.law"),
    stabiliser: text("stabiliser.method"),
    rate: text("rate_hz"),
  };
}

/// Steps a second of the station whose Geometry this is.
export function rateOf(bytes: Uint8Array): number {
  let rate = 0;
  eachField(bytes, (field, reader) => {
    if (field !== geometry.rateHz.number) return false;
    rate = reader.float();
    return true;
  });
  return rate;
}

/// Joints that the channels set, without those that follow other joints: as in src/station/session_state.cpp.
function sensedJoints(channels: readonly DeviceChannel[]): number[] {
  const [kAngle, kCurl, kSplay] = [0, 4, 5];
  return channels.flatMap(({ kind, index }) => {
    const joint = (place: number) => kJointsPerDigit * index + place;
    if (kind === kAngle) return [index];
    if (kind === kSplay) return [joint(1)];
    return kind === kCurl ? [joint(0), joint(2), joint(3)] : [];
  });
}

export function stationFacts(bytes: Uint8Array): StationFacts {
  let facts: StationFacts = {
    scene: "", slides: false, objectKind: "", digitLimit: Infinity, law: "", stabiliser: "", rate: "",
    device: "", rendersTorque: false, simulated: false, sensedJoint: [],
  };
  const channels: DeviceChannel[] = [];
  eachField(bytes, (field, reader) => {
    if (field === setup.start.number) facts = { ...facts, ...changeFacts(reader.bytes()) };
    else if (field === setup.deviceName.number) facts = { ...facts, device: reader.string() };
    else if (field === setup.rendersTorque.number) facts = { ...facts, rendersTorque: reader.bool() };
    else if (field === setup.simulated.number) facts = { ...facts, simulated: reader.bool() };
    else if (field === setup.channel.number) channels.push(fromBinary(DeviceChannelSchema, reader.bytes()));
    else return false;
    return true;
  });
  return { ...facts, sensedJoint: sensedJoints(channels) };
}
