// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it, vi } from "vitest";
import { PeopleApi, PeopleError } from "../../../src/people/api";

interface Asked {
  readonly address: string;
  readonly options: RequestInit;
}
let asked: Asked[] = [];
let answer: { status: number; body: string } | Error = { status: 200, body: "{}" };

const headers = (one: Asked) => one.options.headers as Record<string, string>;
function api(page = ""): PeopleApi {
  return new PeopleApi(page, (address, options) => {
    asked.push({ address, options });
    return answer instanceof Error ? Promise.reject(answer) : Promise.resolve(new Response(answer.body, { status: answer.status }));
  });
}
async function signedIn(): Promise<PeopleApi> {
  const made = api();
  answer = { status: 200, body: JSON.stringify({ session: "secret", account: "a.meier", role: "therapist", idle_s: 60 }) };
  await made.signIn("a.meier", "word");
  asked = [];
  answer = { status: 200, body: "{}" };
  return made;
}

beforeEach(() => {
  asked = [];
  answer = { status: 200, body: "{}" };
});

describe("a request", () => {
  it("of an input states the exercise that it is for, and “go on” the stops that were seen", async () => {
    const made = await signedIn();
    await made.exerciseInput("pause", 7);
    await made.exerciseInput("resume", 7, { stops: 4 });
    await made.exerciseInput("pain", 7, { value: 3 });
    expect(asked.map(({ options }) => JSON.parse(options.body as string) as unknown)).toEqual([
      { kind: "pause", number: 7 }, { kind: "resume", number: 7, stops: 4 }, { kind: "pain", number: 7, value: 3 },
    ]);
  });

  it("for the exercise that is watched waits much shorter than the others", async () => {
    const limits: number[] = [];
    const limit = vi.spyOn(AbortSignal, "timeout").mockImplementation((ms) => (limits.push(ms), new AbortController().signal));
    const made = await signedIn();
    limits.length = 0;
    await made.exercise();
    await made.patients();
    limit.mockRestore();
    expect(limits[0]).toBeLessThanOrEqual(1500);
    expect(limits[1]).toBeGreaterThanOrEqual(10_000);
  });

  it("has the secret of the session in a header, and never in its address", async () => {
    const made = await signedIn();
    await made.patients();
    await made.edit("ab12", "r1", { note: "x" });
    for (const one of asked) {
      expect(headers(one)["X-Phalanx-Session"]).toBe("secret");
      expect(one.address).not.toContain("secret");
    }
    expect(asked.map(({ address, options }) => [options.method, address])).toEqual([["GET", "people/patients"], ["POST", "people/patients/ab12"]]);
    expect(asked[1]!.options.body).toBe('{"note":"x","revision":"r1"}');
    expect(JSON.stringify([localStorage, sessionStorage, document.cookie])).not.toContain("secret");
  });

  it("has no secret before a sign-in and after a sign-out, even if the station does not answer it", async () => {
    const made = await signedIn();
    answer = new Error("no connection");
    await made.signOut();
    answer = { status: 200, body: "{}" };
    await made.status();
    expect(headers(asked.at(-1)!)).toEqual({});
    asked = [];
    await made.signOut();
    expect(asked).toEqual([]);
  });

  it("names the cockpit's page that opened this one", async () => {
    await api("page-secret").status();
    await api().status();
    expect(asked.map((one) => headers(one)["X-Phalanx-Page"])).toEqual(["page-secret", undefined]);
  });

  it.each([
    [401, "signed_out"], [403, "forbidden"], [404, "none"], [429, "busy"], [503, "busy"], [400, "refused"], [409, "refused"], [507, "refused"],
  ])("that gets %i fails with the station's words", async (status, trouble) => {
    answer = { status, body: "code P7!: use A-Z\n" };
    await expect(api().patients()).rejects.toMatchObject({ trouble, message: "code P7!: use A-Z" });
  });

  it("without an answer, or with one that is no JSON, fails in words", async () => {
    answer = new Error("no connection");
    await expect(api().patients()).rejects.toMatchObject({ trouble: "gone" });
    answer = { status: 200, body: "<html>" };
    await expect(api().patients()).rejects.toBeInstanceOf(PeopleError);
  });
});
