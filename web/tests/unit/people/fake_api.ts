// SPDX-License-Identifier: Apache-2.0
// A station that keeps patients, for the page: it answers at once, and can refuse.
import { PeopleError, type PeopleApi, type Trouble } from "../../../src/people/api";
import { readExerciseNow } from "../../../src/people/exercise_now";
import { readAccounts, readCourse, readPatient, readStatus, type Course, type Patient, type SignedIn, type Template } from "../../../src/people/shapes";

export class FakeApi {
  withAccounts = true; // people sign in
  people: readonly { readonly name: string; readonly role: string }[] = [];
  role = "therapist";
  locked = false;
  signedIn = false;
  exercisesOn = false; // the station can carry exercises out
  said: readonly string[] = [];
  damaged: readonly string[] = [];
  kinds: readonly Template[] = [{ name: "day", title: "Assessment day", titleDe: "Messtag", lines: [{ exercise: "press", repetitions: 5, minutes: 0, note: "slowly", overrides: { pain_limit: "4" } }] }];
  now: Readonly<Record<string, unknown>> = {}; // the exercise that runs, as the station's JSON has it
  lockFails = 0; // so many requests to lock are lost
  refuse: { readonly trouble: Trouble; readonly message: string } | undefined;
  readonly asked: string[] = [];
  readonly meant: number[] = []; // exercises that inputs were for
  kept: Patient[] = [
    readPatient({ record: "aa", code: "P07", side: "left", symbol: "boat", revision: "r1", obstacles: ["unchecked"], warnings: ["skin at the thumb"], force_limit_n: 4 }),
    readPatient({ record: "bb", code: "P12", side: "right", symbol: "sun", obstacles: [] }),
  ];
  readonly measured: Course = readCourse({
    results: [{ date: 1_780_000_000, exercise: "press_and_hold", assessment: true, scores: [{ name: "mean_n", unit: "N", value: 4.25, origin: "measured" }] }],
    tests: [{ date: "2026-05-04", kind: "grip", side: "more_affected", value: 20, unit: "kg", rater: "PT1" }],
    notes: [{ date: 1_780_000_000, account: "a.meier", text: "hand is warm" }],
    trends: [{ name: "grip_index", title: "Grip", unit: "kg", points: [{ date: 1_770_000_000, value: 20 }, { date: 1_780_000_000, value: 24 }], verdict: "up by 4 kg", smallest_real_difference: 2.9 }],
  });

  get api(): PeopleApi {
    return this as unknown as PeopleApi;
  }

  /// What a locked session may ask for, too.
  private answerLocked<T>(what: string, value: () => T): Promise<T> {
    if (this.signedIn) return this.answer(what, value, false);
    this.asked.push(what);
    return Promise.reject(new PeopleError("signed_out", "sign in"));
  }

  private answer<T>(what: string, value: () => T, open = true): Promise<T> {
    this.asked.push(what);
    const { refuse } = this;
    if (refuse) return Promise.reject(new PeopleError(refuse.trouble, refuse.message));
    if (open && (!this.signedIn || this.locked)) return Promise.reject(new PeopleError("signed_out", "sign in"));
    return new Promise((resolve) => resolve(value())); // rejected where it throws
  }

  status = () => this.answer("status", () => readStatus({ accounts: this.withAccounts, exercises: this.exercisesOn, symbols: ["sun", "boat"], tests: [{ kind: "grip", unit: "kg", least: 0, most: 100 }] }), false);
  signIn(account: string, password: string): Promise<SignedIn> {
    this.asked.push("sign_in");
    if (this.refuse || (this.withAccounts && password !== "right")) return Promise.reject(new PeopleError("signed_out", "account or password is wrong"));
    this.signedIn = true;
    this.locked = false;
    return Promise.resolve({ session: "s", account, role: this.withAccounts ? this.role : "owner", idle: 100 });
  }
  signOut(): Promise<void> {
    this.asked.push("sign_out");
    this.signedIn = false;
    return Promise.resolve();
  }
  lock(): Promise<void> {
    this.asked.push("lock");
    if (this.lockFails > 0) {
      --this.lockFails;
      return Promise.reject(new PeopleError("gone", "no answer"));
    }
    this.locked = true;
    return Promise.resolve();
  }
  unlock(password: string): Promise<void> {
    this.asked.push("unlock");
    if (this.withAccounts && password !== "right") return Promise.reject(new PeopleError("signed_out", "account or password is wrong"));
    this.locked = false;
    return Promise.resolve();
  }
  alive = () => this.answer("alive", () => undefined);
  patients = () =>
    this.answer("patients", () => {
      if (this.role === "patient_screen") throw new PeopleError("forbidden", "the role of this account sees no patients");
      return { patients: this.kept, damaged: this.damaged, withoutKey: 0 };
    });
  patient = (record: string) => this.answer(`patient ${record}`, () => this.kept.find((one) => one.record === record)!);
  course = (record: string) => this.answer(`course ${record}`, () => this.measured);
  exercises = () => this.answer("exercises", () => [
    { name: "press", title: "Press and hold", titleDe: "Drücken und halten", kind: "assessment", measure: "press_and_hold" },
    { name: "entry", title: "Entry check", titleDe: "Eingangsprüfung", kind: "assessment", measure: "entry_check" },
  ]);
  accounts = () => this.answer("accounts", () => readAccounts({ accounts: this.people }));
  addAccount = (fields: Readonly<Record<string, unknown>>) =>
    this.answer(`add account ${JSON.stringify(fields)}`, () => {
      this.people = [...this.people, { name: String(fields["name"]), role: String(fields["role"]) }];
      if (!this.withAccounts) [this.withAccounts, this.signedIn] = [true, false]; // the first one ends the owner's session
    });
  editAccount = (name: string, fields: Readonly<Record<string, unknown>>) =>
    this.answer(`edit account ${name} ${JSON.stringify(fields)}`, () => {
      if ("password" in fields) this.signedIn = false;
    });
  removeAccount = (name: string) => this.answer(`remove account ${name}`, () => void (this.people = this.people.filter((one) => one.name !== name)));
  watchedExercise = () => this.answerLocked("watched", () => readExerciseNow({ ...this.now, record: undefined, code: undefined, symbol: undefined, side: undefined, result: undefined }));
  watchedInput = (kind: string, number: number, values: Readonly<Record<string, number>> = {}) => {
    this.meant.push(number);
    return this.answerLocked(`watched ${[kind, ...Object.values(values)].join(" ")}`, () => undefined);
  };
  add = (fields: Readonly<Record<string, unknown>>) =>
    this.answer(`add ${JSON.stringify(fields)}`, () => {
      const added = readPatient({ ...fields, record: "cc", obstacles: [] });
      this.kept = [...this.kept, added];
      return added;
    });
  edit = (record: string, revision: string, fields: Readonly<Record<string, unknown>>) =>
    this.answer(`edit ${record} ${JSON.stringify({ ...fields, revision })}`, () => {
      const before = this.kept.find((one) => one.record === record)!.fields;
      const edited = readPatient({ ...before, ...fields, record, obstacles: [], revision: `${revision}+`, said: this.said });
      this.kept = this.kept.map((one) => (one.record === record ? edited : one));
      return edited;
    });
  addTest = (record: string, test: Readonly<Record<string, unknown>>) => this.answer(`test ${record} ${JSON.stringify(test)}`, () => undefined);
  addNote = (record: string, text: string) => this.answer(`note ${record} ${text}`, () => undefined);
  remove = (record: string, confirm: string) =>
    this.answer(`delete ${record} ${confirm}`, () => {
      this.kept = this.kept.filter((one) => one.record !== record);
      return { left: ["/exports/old"], removed: 1, unreadable: 7, unknown: 0 };
    });
  templates = () => this.answer("templates", () => this.kinds);
  report = (record: string, language: string, day: string) =>
    this.answer(`report ${record} ${language} ${day}`, () => "<!doctype html><html lang=en><title>Report</title><style>p{color:red}</style><body><p style='margin: 3px'>4.25 N<script>1</script></p></body></html>");
  fhir = (record: string, day: string) => this.answer(`fhir ${record} ${day}`, () => '{"resourceType":"Bundle"}');
  export = (record: string) => this.answer(`export ${record}`, () => ["patient.json", "results.csv", "tests.csv"].map((name) => ({ name, type: "text/csv", text: name })));
  exercise = () => this.answer("exercise", () => readExerciseNow(this.now));
  beginExercise = (record: string, exercise: string, confirm: string, demo: string) =>
    this.answer(`begin ${record} ${exercise} ${confirm} ${demo}`, () => {
      const { code, symbol, side } = this.kept.find((one) => one.record === record)!;
      this.now = { number: 1, stage: "running", record, code, symbol, side, name: exercise, title: "Press and hold", kind: "training", measure: "press_and_hold", simulated: demo !== "", phase: "ready" };
    });
  exerciseInput = (kind: string, number: number, values: Readonly<Record<string, number>> = {}) => {
    this.meant.push(number);
    return this.answer(`input ${[kind, ...Object.values(values)].join(" ")}`, () => undefined);
  };
}
