// SPDX-License-Identifier: Apache-2.0
// Cuts the recording of demo.html out of one that `phalanx run` made: the hand's poses, the shapes and the events of a stretch of time.
// The messages keep their bytes, but the setup loses its meshes, which the shapes repeat. scripts/demo --record calls it.
// npx vite-node demo/cut.ts FILE FROM TO: writes demo/recording.mcap.gz
import { readFileSync, writeFileSync } from "node:fs";
import { basename, resolve } from "node:path";
import { gzipSync } from "node:zlib";
import { fromBinary, toBinary } from "@bufbuild/protobuf";
import { McapIndexedReader, McapWriter } from "@mcap/core";
import { SetupSchema } from "../src/gen/phalanx/recording_pb";
import { decompressHandlers } from "../src/replay/chunk";

const kTopics = ["/setup", "/geometry", "/pose", "/event"];
const kChunk = 60_000; // [bytes]
const kBest = 9; // of gzip
const kUsage = "usage: vite-node demo/cut.ts FILE FROM TO   (seconds since the recording's begin)";

const [file = "", from = "", to = ""] = process.argv.slice(2);
if (!(Number(to) > Number(from))) throw new Error(kUsage);

const bytes = readFileSync(file);
const readable = {
  size: () => Promise.resolve(BigInt(bytes.length)),
  read: (offset: bigint, length: bigint) => Promise.resolve(new Uint8Array(bytes.subarray(Number(offset), Number(offset + length)))),
};
const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
const begin = reader.statistics!.messageStartTime;
const first = begin + BigInt(Math.round(Number(from) * 1e9));
const last = begin + BigInt(Math.round(Number(to) * 1e9));

const parts: Uint8Array[] = [];
let size = 0;
const writer = new McapWriter({
  writable: {
    position: () => BigInt(size),
    write: (part: Uint8Array) => {
      parts.push(part.slice());
      size += part.length;
      return Promise.resolve();
    },
  },
  chunkSize: kChunk,
});
await writer.start({ profile: "", library: "phalanx" });
const channels = new Map<number, number>();
for (const channel of [...reader.channelsById.values()].filter(({ topic }) => kTopics.includes(topic))) {
  const { name, encoding, data } = reader.schemasById.get(channel.schemaId)!;
  const schemaId = await writer.registerSchema({ name, encoding, data });
  const { topic, messageEncoding, metadata } = channel;
  channels.set(channel.id, await writer.registerChannel({ topic, schemaId, messageEncoding, metadata }));
}
for await (const { metadata } of reader.readMetadata({ name: "phalanx" })) {
  await writer.addMetadata({ name: "phalanx", metadata: new Map([...metadata, ["cut", `${from} to ${to} s, without steps, of ${basename(file)}`]]) });
}

/// The setup without what takes most of its bytes.
function withoutMeshes(data: Uint8Array): Uint8Array {
  const setup = fromBinary(SetupSchema, data);
  if (setup.start) delete setup.start.model;
  return toBinary(SetupSchema, setup);
}

let sequence = 0;
for await (const message of reader.readMessages({ topics: kTopics })) {
  const topic = reader.channelsById.get(message.channelId)!.topic;
  const stands = topic === "/setup" || topic === "/geometry"; // in force from the beginning on
  if (message.logTime > last || (!stands && message.logTime < first)) continue;
  const time = message.logTime < first ? first : message.logTime;
  await writer.addMessage({
    channelId: channels.get(message.channelId)!, sequence: sequence++, logTime: time, publishTime: time,
    data: topic === "/setup" ? withoutMeshes(message.data) : message.data,
  });
}
await writer.end();
const packed = gzipSync(Buffer.concat(parts), { level: kBest });
writeFileSync(resolve(__dirname, "recording.mcap.gz"), packed);
console.log(`demo/recording.mcap.gz: ${packed.length} bytes, ${(Number(last - first) / 1e9).toFixed(1)} s, ${sequence} messages`);
