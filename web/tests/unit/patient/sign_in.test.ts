// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { PeopleError, type Fetch, type PeopleApi } from "../../../src/people/api";
import { signIn, type SignIn } from "../../../src/patient/sign_in";

let trouble: PeopleError | undefined;
let lives = true; // the session holds at the station
const asked: string[] = [];
const changed = vi.fn();

/// A station with accounts. @param get  given where a session is taken over
function api(page: string, get?: Fetch): PeopleApi {
  const answer = <T>(what: string, value: T) => {
    asked.push(`${what} ${page}${get ? " taken over" : ""}`);
    return trouble ? Promise.reject(trouble) : Promise.resolve(value);
  };
  return {
    status: () => answer("status", { accounts: true }),
    signIn: () => answer("sign_in", { session: "s1", account: "screen1", role: "patient_screen", idle: 30 }),
    alive: () => (lives ? answer("alive", undefined) : Promise.reject(new PeopleError("signed_out", ""))),
    signOut: () => answer("sign_out", undefined),
  } as unknown as PeopleApi;
}

const made = (): SignIn => signIn(changed, api);
const settled = () => vi.advanceTimersByTimeAsync(0);
async function entered(form: SignIn): Promise<void> {
  form.element.dispatchEvent(new Event("submit", { cancelable: true }));
  await settled();
}

beforeEach(() => {
  vi.useFakeTimers();
  trouble = undefined;
  lives = true;
  asked.length = 0;
  sessionStorage.clear();
});
afterEach(() => vi.useRealTimers());

it("asks a station that did not answer again, and one without patients no more", async () => {
  const form = made();
  trouble = new PeopleError("gone", "");
  await form.check("p1");
  expect(form.needed).toBe(false);
  trouble = undefined;
  await vi.advanceTimersByTimeAsync(3000);
  expect(form.needed).toBe(true);
  const other = made();
  trouble = new PeopleError("none", "");
  await other.check("p2");
  trouble = undefined;
  await vi.advanceTimersByTimeAsync(10_000);
  expect(asked.filter((one) => one === "status p2")).toHaveLength(1);
  expect(other.needed).toBe(false);
});

it("is put off by Later until it is refused again or opened", async () => {
  const form = made();
  await form.check("p1");
  const later = form.element.querySelector<HTMLButtonElement>(".sign-in-later")!;
  later.click();
  expect([form.needed, form.later]).toEqual([true, true]);
  form.refused();
  expect(form.later).toBe(false);
  later.click();
  form.open();
  expect(form.later).toBe(false);
});

it("leaves its session to the next page of the tab, which takes it once", async () => {
  const form = made();
  await form.check("p1");
  await entered(form);
  expect(form.needed).toBe(false);
  expect(sessionStorage.length, "kept nowhere while the page is open").toBe(0);
  form.handOver();
  const next = made();
  expect(JSON.stringify({ ...sessionStorage })).not.toContain("s1");
  await next.check("p1");
  expect(next.needed).toBe(false);
  expect(asked.at(-1)).toBe("alive p1 taken over");
  const third = made();
  await third.check("p1");
  expect(third.needed).toBe(true);
});

it("asks after all where the session has ended or belongs to another page", async () => {
  const form = made();
  await form.check("p1");
  await entered(form);
  form.handOver();
  lives = false;
  const next = made();
  await next.check("p1");
  expect(next.needed).toBe(true);
  lives = true;
  form.handOver();
  const other = made();
  await other.check("p2");
  expect(other.needed).toBe(true);
});

it("takes the focus from a field that is left, so that Space is STOP again", () => {
  const form = made();
  document.body.append(form.element);
  form.element.hidden = false;
  const field = form.element.querySelector("input")!;
  field.focus();
  vi.advanceTimersByTime(9000);
  field.dispatchEvent(new Event("input"));
  vi.advanceTimersByTime(9000);
  expect(document.activeElement).toBe(field);
  vi.advanceTimersByTime(1000);
  expect(document.activeElement).not.toBe(field);
});
