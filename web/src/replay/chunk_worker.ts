// SPDX-License-Identifier: Apache-2.0
// A thread of its own: the bytes of chunks in, their content out.
import { decodeChunk, surveyChunk } from "./chunk";
import type { Done, Task } from "./decoder";

addEventListener("message", ({ data: { id, what, bytes, layout } }: MessageEvent<Task>) => {
  let done: Done;
  try {
    done = { id, result: what === "decode" ? decodeChunk(bytes, layout) : surveyChunk(bytes, layout) };
  } catch (reason) {
    done = { id, error: String(reason) };
  }
  postMessage(done);
});
