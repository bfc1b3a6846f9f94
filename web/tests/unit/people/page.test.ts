// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it } from "vitest";
import { PeoplePage } from "../../../src/people/page";
import { words } from "../../../src/people/words";
import { FakeApi } from "./fake_api";

let station: FakeApi;
let page: PeoplePage;
let now = 0;
let again: (() => void)[] = []; // what the page does later

const flush = () => new Promise((resolve) => setTimeout(resolve));
const shown = () => page.content.textContent ?? "";
const find = <T extends HTMLElement>(selector: string) => page.content.querySelector<T>(selector)!;
const named = (text: string) => [...page.content.querySelectorAll("button"), ...page.account.querySelectorAll("button")].find((one) => one.textContent === text)!;
function fill(label: string, text: string): void {
  const found = [...page.content.querySelectorAll("label")].find((one) => one.textContent!.startsWith(label))!;
  const field = document.getElementById(found.htmlFor) as HTMLInputElement | HTMLTextAreaElement;
  field.value = text;
}
async function submit(button: string): Promise<void> {
  named(button).closest("form")!.dispatchEvent(new Event("submit", { cancelable: true }));
  await flush();
  await flush();
}
async function press(text: string): Promise<void> {
  named(text).click();
  await flush();
}
async function open(code: string): Promise<void> {
  [...page.content.querySelectorAll<HTMLButtonElement>(".patient-item")].find((one) => one.textContent!.includes(code))!.click();
  await flush();
  await flush();
}
async function signIn(password = "right"): Promise<void> {
  await page.begin();
  fill(words.signIn.account, "a.meier");
  fill(words.signIn.password, password);
  await submit(words.signIn.submit);
}

beforeEach(() => {
  now = 0;
  station = new FakeApi();
  again = [];
  page = new PeoplePage(station.api, () => now, (run) => again.push(run));
  document.body.replaceChildren(page.account, page.content);
});

describe("the page of patients", () => {
  it("shows nothing before a sign-in, and the station's words after a wrong password", async () => {
    await signIn("wrong");
    expect(shown()).not.toContain("P07");
    expect(find(".refused:not([hidden])").textContent).toBe("account or password is wrong");
    expect(find<HTMLInputElement>("input[type=password]").value).toBe("");
    expect(page.account.hidden).toBe(true);
    expect(station.asked).not.toContain("patients");
  });

  it("lists patients with side and symbol, and the exercises", async () => {
    await signIn();
    expect([...page.content.querySelectorAll(".patient-item")].map((one) => one.textContent)).toEqual([
      `P07${words.sides["left"]}, ${words.symbols["boat"]}${words.list.notReady}`, `P12${words.sides["right"]}, ${words.symbols["sun"]}`,
    ]);
    expect(shown()).toContain("Press and hold");
    expect(page.account.textContent).toContain("a.meier");
  });

  it("names patients that cannot be read by their record numbers, beside the others", async () => {
    station.damaged = ["d".repeat(32)];
    await signIn();
    expect(find(".people-damaged summary").textContent).toBe(words.list.damaged("1"));
    expect(find(".people-damaged code").textContent).toBe("d".repeat(32));
    expect(page.content.querySelectorAll(".patient-item").length).toBe(2);
  });

  it("signs an account out whose role sees no patients, and says why", async () => {
    station.exercisesOn = true;
    station.role = "patient_screen";
    await signIn();
    await flush();
    expect(shown()).toContain(words.signIn.noPatients(words.roles["patient_screen"]!));
    expect(station.signedIn).toBe(false);
    expect(page.account.hidden).toBe(true);
    expect(station.asked.filter((one) => one === "exercise")).toEqual([]); // nothing asks on
    station.role = "therapist";
    fill(words.signIn.account, "a.meier");
    fill(words.signIn.password, "right");
    await submit(words.signIn.submit);
    expect(page.content.querySelectorAll(".patient-item").length).toBe(2);
  });

  it("needs no password where no accounts are set up", async () => {
    station.withAccounts = false;
    await page.begin();
    expect(page.content.querySelectorAll(".patient-item").length).toBe(2);
    expect(page.account.textContent).toContain(words.signIn.owner);
  });

  it.each([["none", words.noRegistry], ["forbidden", words.forbidden], ["gone", words.gone]] as const)("says why there is nothing: %s", async (trouble, text) => {
    station.refuse = { trouble, message: "the station's words" };
    await page.begin();
    expect(find("[role=alert]:not([hidden])").textContent).toBe(text);
  });
});

describe("one patient", () => {
  beforeEach(async () => {
    await signIn();
    await open("P07");
  });

  it("is displayed with obstacles and warnings, course and fields", () => {
    for (const text of [words.obstacles["unchecked"]!, "skin at the thumb", "4.25 N", "20 kg", "up by 4 kg", "hand is warm", "4 N"]) expect(shown()).toContain(text);
    expect(find(".patient-item[aria-current]").textContent).toContain("P07");
    expect(document.activeElement?.textContent).toBe("P07");
  });

  it("is changed by its form, which sends the fields that differ, numbers as numbers and an empty one as none", async () => {
    await press(words.patient.edit);
    fill(words.fields["force_limit_n"]!, "");
    fill(words.fields["stiffness_limit_n_per_mm"]!, "0,5");
    fill(words.fields["prescription"]!, "press; 20; 10; slowly; gently\nindependence\n");
    await submit(words.save);
    const sent = JSON.parse(station.asked.find((one) => one.startsWith("edit aa "))!.slice("edit aa ".length)) as Record<string, unknown>;
    expect(Object.keys(sent).sort()).toEqual(["force_limit_n", "prescription", "revision", "stiffness_limit_n_per_mm"]);
    expect(sent).toMatchObject({ force_limit_n: null, stiffness_limit_n_per_mm: 0.5, revision: "r1" });
    expect(sent["prescription"]).toEqual([
      { exercise: "press", repetitions_per_day: 20, minutes_per_day: 10, note: "slowly; gently", overrides: {} },
      { exercise: "independence", repetitions_per_day: 0, minutes_per_day: 0, note: "", overrides: {} },
    ]);
  });

  it.each([["force_limit_n", "four", words.patient.badNumber(words.fields["force_limit_n"]!)], ["prescription", "press; often", words.patient.badLine("press; often")]])(
    "is not changed by what is no number: %s",
    async (name, text, why) => {
      await press(words.patient.edit);
      fill(words.fields[name]!, text);
      await submit(words.save);
      expect(find(".refused:not([hidden])").textContent).toBe(why);
      expect(station.asked.filter((one) => one.startsWith("edit"))).toEqual([]);
    },
  );

  it("says what a change did beyond its fields", async () => {
    await press(words.patient.edit);
    station.said = ["measure the right hand"];
    fill(words.fields["note"]!, "a note");
    await submit(words.save);
    await flush();
    expect(find("[role=alert]:not([hidden])").textContent).toBe("measure the right hand");
  });

  it("keeps what was typed when the station refuses it", async () => {
    await press(words.patient.edit);
    fill(words.fields["code"]!, "P12");
    station.refuse = { trouble: "refused", message: "P12: this code is in use" };
    await submit(words.save);
    expect(find(".refused:not([hidden])").textContent).toBe("P12: this code is in use");
    expect([...page.content.querySelectorAll("input")].map((one) => one.value)).toContain("P12");
  });

  it("leaves the document when a change finds that the session has ended", async () => {
    await press(words.patient.edit);
    station.signedIn = false;
    await submit(words.save);
    expect(shown()).toContain(words.signedOut);
    expect(document.body.innerHTML).not.toMatch(/P07|P12/);
  });

  it("gets tests and notes", async () => {
    const box = [...page.content.querySelectorAll("details")].find((one) => one.querySelector("summary")!.textContent === words.tests.add)!;
    const inputs = [...box.querySelectorAll("label")].filter(({ textContent }) => [words.tests.value, words.tests.date, words.tests.rater].some((text) => textContent!.startsWith(text)));
    ["21.5", "2026-06-01", "PT1"].forEach((text, i) => ((document.getElementById(inputs[i]!.htmlFor) as HTMLInputElement).value = text));
    box.querySelector("form")!.dispatchEvent(new Event("submit", { cancelable: true }));
    await flush();
    expect(station.asked).toContain('test aa {"kind":"grip","side":"more_affected","value":21.5,"date":"2026-06-01","rater":"PT1","note":""}');
    const note = find<HTMLTextAreaElement>("textarea");
    note.value = "a note";
    note.closest("form")!.dispatchEvent(new Event("submit", { cancelable: true }));
    await flush();
    expect(station.asked).toContain("note aa a note");
  });

  it("is deleted with its code only, and what remains to be deleted is listed", async () => {
    fill(words.remove.confirm("P07"), "P07");
    await submit(words.remove.submit);
    expect(station.asked).toContain("delete aa P07");
    expect(shown()).not.toContain("P07");
    for (const text of ["/exports/old", words.remove.unreadable("7"), words.remove.removed("1")]) expect(shown()).toContain(text);
    expect(shown()).not.toContain(words.remove.unknown("0"));
  });

  it("is left for the list", async () => {
    await press(words.back);
    expect(shown()).toContain(words.list.choose);
  });
});

describe("a new patient", () => {
  it("has no side until one is chosen: the wrong hand would get these limits", async () => {
    await signIn();
    await press(words.list.add);
    fill(words.fields["code"]!, "P20");
    await submit(words.save);
    expect(find(".refused:not([hidden])").textContent).toBe(words.patient.noSide);
    find(".chips [data-value=right]").click();
    await submit(words.save);
    expect(station.asked.some((one) => one.startsWith("add ") && one.includes('"code":"P20","side":"right","symbol":""'))).toBe(true);
    expect(find(".patient-item[aria-current]").textContent).toContain("P20");
  });
});

describe("the lock", () => {
  beforeEach(async () => {
    await signIn();
    await open("P07");
  });

  it("removes all of the patients from the document at once, and locks the session", () => {
    named(words.lock.now).click();
    expect(document.body.innerHTML).not.toMatch(/P07|P12|skin at the thumb|boat/i);
    expect(page.account.hidden).toBe(true);
    expect(station.locked).toBe(true);
  });

  it("comes by itself before the station's", () => {
    now = 99_000;
    page.idle.check();
    expect(shown()).toContain(words.lock.hint);
    expect(shown()).not.toContain("P07");
  });

  it("ends with the password, and not with a wrong one", async () => {
    page.lock();
    fill(words.lock.password("a.meier"), "wrong");
    await submit(words.lock.unlock);
    expect(shown()).not.toContain("P07");
    fill(words.lock.password("a.meier"), "right");
    await submit(words.lock.unlock);
    expect(page.content.querySelectorAll(".patient-item").length).toBe(2);
  });

  it("drops what was still being read", async () => {
    const answered: (() => void)[] = [];
    Object.assign(station, { patient: () => new Promise((resolve) => answered.push(() => resolve(station.kept[0]))) });
    [...page.content.querySelectorAll<HTMLButtonElement>(".patient-item")][1]!.click();
    page.lock();
    answered.forEach((one) => one());
    await flush();
    expect(shown()).not.toContain("P07");
  });

  it("stays while a save under way ends, and what that save brings is not shown", async () => {
    const answered: (() => void)[] = [];
    Object.assign(station, { edit: () => new Promise((resolve) => answered.push(() => resolve(station.kept[0]))) });
    await press(words.patient.edit);
    await submit(words.save);
    station.lockFails = 2; // the station does not know of the lock: it answers as before
    page.lock();
    answered.forEach((one) => one());
    await flush();
    await flush();
    expect(shown()).toContain(words.lock.hint);
    expect(document.body.innerHTML).not.toMatch(/P07|P12/);
    expect(station.locked).toBe(false);
    again.splice(0).forEach((run) => run());
    await flush();
    again.splice(0).forEach((run) => run());
    await flush();
    expect(station.locked, "the request is repeated until the station confirms it").toBe(true);
    expect(again).toEqual([]);
  });

  it("is not requested again after the unlock", async () => {
    station.lockFails = 1;
    page.lock();
    await flush();
    fill(words.lock.password("a.meier"), "right");
    await submit(words.lock.unlock);
    again.splice(0).forEach((run) => run());
    await flush();
    expect(station.locked).toBe(false);
    expect(page.content.querySelectorAll(".patient-item").length).toBe(2);
  });

  it("leads to the sign-in where another account is to be used, and where the session has ended", async () => {
    page.lock();
    await press(words.lock.other);
    expect(shown()).toContain(words.signIn.account);
    expect(station.signedIn).toBe(false);
    fill(words.signIn.account, "b");
    fill(words.signIn.password, "right");
    await submit(words.signIn.submit);
    station.signedIn = false;
    await open("P12");
    expect(shown()).toContain(words.signedOut);
    expect(shown()).not.toContain("P12");
  });
});

describe("what is measured before the first training", () => {
  beforeEach(async () => {
    station.exercisesOn = true;
    await signIn();
    await open("P07");
  });
  const named_ = (label: string) => page.content.querySelector<HTMLElement>(`[aria-label="${label}"]`)!;

  it("is measured by an exercise", async () => {
    named_(`${words.steps.measure}: ${words.fields["entry"]}`).click();
    await flush();
    expect(find(".confirm").textContent).toContain("Entry check");
  });

  it("is entered if it was measured elsewhere: the station judges it", async () => {
    fill(words.steps.flexion, "45");
    fill(words.steps.release, "30,5");
    named_(`${words.steps.enter}: ${words.fields["entry"]}`).parentElement!.querySelector("form")!.dispatchEvent(new Event("submit", { cancelable: true }));
    await flush();
    const sent = JSON.parse(station.asked.find((one) => one.startsWith("edit aa "))!.slice("edit aa ".length)) as { entry: Record<string, unknown> };
    expect(sent.entry).toMatchObject({ flexion_deg: 45, release_deg: 30.5 });
    expect(sent.entry["date"]).toMatch(/^\d{4}-\d\d-\d\d$/);
  });

  it("has a force for each digit, and what is no number is refused", async () => {
    const box = named_(`${words.steps.enter}: ${words.fields["own_force_n"]}`).parentElement!;
    const inputs = [...box.querySelectorAll("input")];
    const send = async () => {
      box.querySelector("form")!.dispatchEvent(new Event("submit", { cancelable: true }));
      await flush();
    };
    inputs[1]!.value = "strong";
    await send();
    expect(box.querySelector(".refused:not([hidden])")!.textContent).toContain("Index");
    inputs[1]!.value = "4.5";
    await send();
    expect(station.asked.find((one) => one.startsWith("edit aa "))).toContain('"own_force_n":[0,4.5,0,0,0]');
  });
});

describe("a prescription", () => {
  it("gets lines, doses and loses lines without its text", async () => {
    station.exercisesOn = true;
    await signIn();
    await open("P12");
    const sent = () => (JSON.parse(station.asked.filter((one) => one.startsWith("edit bb ")).at(-1)!.slice("edit bb ".length)) as { prescription: unknown[] }).prescription;
    find(".begin-other .choice").click();
    [...page.content.querySelectorAll<HTMLElement>(".begin-other [role=option]")].find((one) => one.dataset["value"] === "press")!.click();
    await press(words.begin.prescribe);
    await flush();
    expect(sent()).toEqual([{ exercise: "press", repetitions_per_day: 0, minutes_per_day: 0, note: "", overrides: {} }]);
    await flush();
    fill(words.begin.repetitions, "20");
    fill(words.begin.minutes, "7,5");
    find(".begin-card form").dispatchEvent(new Event("submit", { cancelable: true }));
    await flush();
    expect(sent()).toEqual([{ exercise: "press", repetitions_per_day: 20, minutes_per_day: 7.5, note: "", overrides: {} }]);
    await flush();
    await flush();
    await submit(words.begin.remove);
    expect(sent()).toEqual([]);
  });
});

describe("accounts", () => {
  it("begin with an administrator's, after which everyone signs in", async () => {
    station.withAccounts = false;
    await page.begin();
    await press(words.accounts.title);
    expect(shown()).toContain(words.accounts.first);
    fill(words.accounts.name, "chief");
    fill(words.signIn.password, "a long password");
    await submit(words.accounts.add);
    await flush();
    expect(station.asked).toContain('add account {"name":"chief","role":"administrator","password":"a long password"}');
    expect(shown()).toContain(words.signIn.account);
    expect(shown()).not.toContain("P07");
  });

  it("are listed and changed by an administrator", async () => {
    station.role = "administrator";
    station.people = [{ name: "chief", role: "administrator" }, { name: "b.kurz", role: "therapist" }];
    await signIn();
    await press(words.accounts.title);
    await flush();
    const box = [...page.content.querySelectorAll<HTMLElement>(".account")].find((one) => one.textContent!.includes("b.kurz"))!;
    const [, password, remove] = [...box.querySelectorAll("form")];
    password!.querySelector("input")!.value = "another long one";
    password!.dispatchEvent(new Event("submit", { cancelable: true }));
    await flush();
    expect(station.asked).toContain('edit account b.kurz {"password":"another long one"}');
    remove!.dispatchEvent(new Event("submit", { cancelable: true }));
    await flush();
    expect(remove!.querySelector(".refused:not([hidden])")!.textContent).toBe(words.accounts.wrongName);
    expect(station.asked.some((one) => one.startsWith("remove account"))).toBe(false);
  });

  it("of a therapist have a password of their own to change", async () => {
    await signIn();
    await press(words.accounts.own);
    expect(station.asked).not.toContain("accounts");
    fill(words.accounts.newPassword, "another long one");
    await submit(words.accounts.setPassword);
    await flush();
    expect(shown()).toContain(words.accounts.passwordDone);
  });
});
