// SPDX-License-Identifier: Apache-2.0
import { create, type MessageInitShape } from "@bufbuild/protobuf";
import { beforeEach, describe, expect, it } from "vitest";
import { NoticeSchema, type Notice } from "../../../src/gen/phalanx/cockpit_pb";
import { merged } from "../../../src/state/notices";

let past: Notice[] = [];
beforeEach(() => (past = []));

describe("notices", () => {
  const notice = (unixTime: number, text: string, more: MessageInitShape<typeof NoticeSchema> = {}) =>
    past.push(create(NoticeSchema, { unixTime, text, code: "set", who: "page 2", ...more }));
  const texts = () => merged(past).map((one) => one.text);

  it("of one person who drags one control are one line, the last", () => {
    for (let i = 0; i < 20; ++i) notice(i, `force.stiffness_n_per_mm = ${i}`);
    expect(texts()).toEqual(["force.stiffness_n_per_mm = 19"]);
  });

  it("of others, of other keys, later ones and other things stay", () => {
    notice(1, "a.b = 1");
    notice(1, "a.b = 2", { who: "page 3" });
    notice(1, "a.b = 3, a.c = 4", { who: "page 3" });
    notice(4, "a.b = 5, a.c = 4", { who: "page 3" });
    notice(4, "stopped the torque", { code: "stopped" });
    notice(4, "stopped the torque", { code: "stopped" });
    expect(texts().length).toBe(6);
  });
});
