// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { askSession, offerSession, signedFetch } from "../../../src/wire/shared_session";

/// A station whose recordings need the session "s2".
function station() {
  const asked: string[] = [];
  const get = (address: string, options: RequestInit): Promise<Response> => {
    const session = (options.headers as Record<string, string> | undefined)?.["X-Phalanx-Session"] ?? "";
    asked.push(`${address} ${session}`);
    return Promise.resolve(new Response("", { status: address === "recordings" || session === "s2" ? 200 : 409 }));
  };
  return { asked, get };
}

describe("the session that pages share", () => {
  it("is asked for where a recording is refused, and kept", async () => {
    const { asked, get } = station();
    const fetch = signedFetch(get, () => Promise.resolve("s2"))(false);
    expect((await fetch("recordings/a", {})).status).toBe(200);
    expect((await fetch("recordings/a", { headers: { Range: "bytes=0-1" } })).status).toBe(200);
    expect(asked).toEqual(["recordings/a ", "recordings/a s2", "recordings/a s2"]);
  });

  it("is asked for once where no page has one, and the refusal stays", async () => {
    const { asked, get } = station();
    expect((await signedFetch(get, () => Promise.resolve(""))(false)("recordings/a", {})).status).toBe(409);
    expect(asked).toEqual(["recordings/a "]);
  });

  it("is asked for before a list", async () => {
    const { asked, get } = station();
    await signedFetch(get, () => Promise.resolve("s2"))(true)("recordings", {});
    expect(asked).toEqual(["recordings s2"]);
  });

  it("comes from the page that has one, while it has one", async () => {
    let session = "";
    offerSession(() => session);
    expect(await askSession()).toBe("");
    session = "s2";
    expect(await askSession()).toBe("s2");
  });
});
