// SPDX-License-Identifier: Apache-2.0
import { expect, it } from "vitest";
import { streamUrl } from "../../../src/wire/http";

it("the stream lies beside the page", () => {
  expect(streamUrl("http://127.0.0.1:8480/")).toBe("ws://127.0.0.1:8480/stream");
  expect(streamUrl("https://host/a/b/index.html#x")).toBe("wss://host/a/b/stream");
});
