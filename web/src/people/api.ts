// SPDX-License-Identifier: Apache-2.0
// Requests of the page of patients. The secret of a session is in the memory of this page only: no cookie, no storage. It goes in a header,
// which no other site's page can send.
import { readExerciseNow, type ExerciseNow } from "./exercise_now";
import {
  readAccounts, readCourse, readDeleted, readExercises, readExport, readPatient, readPatients, readSignedIn, readStatus, readTemplates, readUnreadable,
  type Account, type Course, type Deleted, type Exercise, type ExportedFile, type Listed, type Patient, type SignedIn, type Status, type Template, type Unreadable,
} from "./shapes";

/// none: the station keeps no patients; signed_out: no session, or it is locked; refused: the station says why; forbidden: never with this
/// address or account; busy: ask again; gone: no answer.
export type Trouble = "none" | "signed_out" | "refused" | "forbidden" | "busy" | "gone";

export class PeopleError extends Error {
  /// @param message  the station's words
  constructor(
    readonly trouble: Trouble,
    message: string,
  ) {
    super(message);
  }
}

export type Fetch = (address: string, options: RequestInit) => Promise<Response>;

const kAnswerMs = 20_000; // Argon2id of a slow computer, after requests that wait
const kExerciseMs = 1500; // of the exercise that is watched: a cut link must not look live
const troubles: Readonly<Record<number, Trouble>> = { 401: "signed_out", 403: "forbidden", 404: "none", 429: "busy", 503: "busy" };

export class PeopleApi {
  private session = "";

  /// @param page  secret of the cockpit's page that opened this one: its line in the log of changes names the account; empty: none
  constructor(
    private readonly page: string = "",
    private readonly get: Fetch = (address, options) => fetch(address, options),
  ) {}

  /// Sends a request. @returns the answer's text @throws PeopleError
  private async send(path: string, body?: unknown, keepalive = false, answerMs = kAnswerMs): Promise<string> {
    const headers: Record<string, string> = this.session === "" ? {} : { "X-Phalanx-Session": this.session };
    if (body !== undefined) headers["Content-Type"] = "application/json";
    if (this.page !== "") headers["X-Phalanx-Page"] = this.page;
    let response: Response;
    let said: string;
    try {
      response = await this.get(path, {
        method: body === undefined ? "GET" : "POST", headers, body: body === undefined ? null : JSON.stringify(body),
        cache: "no-store", signal: AbortSignal.timeout(answerMs), keepalive,
      });
      said = await response.text();
    } catch (reason) {
      throw new PeopleError("gone", String(reason));
    }
    if (!response.ok) throw new PeopleError(troubles[response.status] ?? "refused", said.trim());
    return said;
  }

  /// Sends a request that is answered in JSON. @throws PeopleError
  private async ask(path: string, body?: unknown, keepalive = false, answerMs = kAnswerMs): Promise<unknown> {
    const said = await this.send(path, body, keepalive, answerMs);
    try {
      return said.trim() === "" ? {} : JSON.parse(said);
    } catch (reason) {
      throw new PeopleError("refused", String(reason));
    }
  }

  async status(): Promise<Status> {
    return readStatus(await this.ask("people"));
  }

  /// The secret of the session; empty: no account is signed in.
  get secret(): string {
    return this.session;
  }

  /// Without accounts both are empty, and the owner of the computer is signed in.
  async signIn(account: string, password: string): Promise<SignedIn> {
    this.session = "";
    const signed = readSignedIn(await this.ask("people/sign_in", { account, password }));
    this.session = signed.session;
    return signed;
  }

  /// Forgets the session here and, if it answers, at the station.
  async signOut(): Promise<void> {
    if (this.session === "") return;
    const ended = this.ask("people/sign_out", {}, true);
    this.session = "";
    await ended.catch(() => undefined);
  }

  /// Locks the session at the station: nothing more is given out until unlock().
  async lock(): Promise<void> {
    await this.ask("people/lock", {}, true);
  }

  async unlock(password: string): Promise<void> {
    await this.ask("people/unlock", { password });
  }

  /// Tells the station that the person is there: it locks a session by the time without requests.
  async alive(): Promise<void> {
    await this.ask("people/alive", {});
  }

  /// The patients, and what is known of those that cannot be read.
  async patients(): Promise<Unreadable & { readonly patients: readonly Listed[] }> {
    const answer = await this.ask("people/patients");
    return { patients: readPatients(answer), ...readUnreadable(answer) };
  }

  async patient(record: string): Promise<Patient> {
    return readPatient(await this.ask(`people/patients/${record}`));
  }

  async course(record: string): Promise<Course> {
    return readCourse(await this.ask(`people/patients/${record}/course`));
  }

  async add(fields: Readonly<Record<string, unknown>>): Promise<Patient> {
    return readPatient(await this.ask("people/patients", fields));
  }

  /// @param revision  of the fields that the change was made from; the station refuses the change if they are others now
  async edit(record: string, revision: string, fields: Readonly<Record<string, unknown>>): Promise<Patient> {
    return readPatient(await this.ask(`people/patients/${record}`, { ...fields, revision }));
  }

  async addTest(record: string, test: Readonly<Record<string, unknown>>): Promise<void> {
    await this.ask(`people/patients/${record}/tests`, test);
  }

  async addNote(record: string, text: string): Promise<void> {
    await this.ask(`people/patients/${record}/notes`, { text });
  }

  /// @param confirm  the patient's code, typed again
  async remove(record: string, confirm: string): Promise<Deleted> {
    return readDeleted(await this.ask(`people/patients/${record}/delete`, { confirm }));
  }

  async exercises(): Promise<readonly Exercise[]> {
    return readExercises(await this.ask("people/exercises"));
  }

  async templates(): Promise<readonly Template[]> {
    return readTemplates(await this.ask("people/templates"));
  }

  // ---- accounts

  async accounts(): Promise<readonly Account[]> {
    return readAccounts(await this.ask("people/accounts"));
  }

  async addAccount(fields: Readonly<Record<string, unknown>>): Promise<void> {
    await this.ask("people/accounts", fields);
  }

  /// @param fields  a role or a password
  async editAccount(name: string, fields: Readonly<Record<string, unknown>>): Promise<void> {
    await this.ask(`people/accounts/${encodeURIComponent(name)}`, fields);
  }

  async removeAccount(name: string): Promise<void> {
    await this.ask(`people/accounts/${encodeURIComponent(name)}/delete`, {});
  }

  // ---- documents

  async export(record: string): Promise<readonly ExportedFile[]> {
    return readExport(await this.ask(`people/patients/${record}/export`));
  }

  /// @param day  2026-05-04; empty: all days
  async report(record: string, language: string, day: string): Promise<string> {
    return this.send(`people/patients/${record}/report?${new URLSearchParams(day === "" ? { lang: language } : { lang: language, day }).toString()}`);
  }

  async fhir(record: string, day: string): Promise<string> {
    return this.send(`people/patients/${record}/fhir${day === "" ? "" : `?${new URLSearchParams({ day }).toString()}`}`);
  }

  // ---- the exercise that the station carries out

  async exercise(): Promise<ExerciseNow> {
    return readExerciseNow(await this.ask("people/exercise", undefined, false, kExerciseMs));
  }

  /// @param confirm  the patient's code  @param demo  skill of a simulated participant; empty: a person
  async beginExercise(record: string, exercise: string, confirm: string, demo: string): Promise<void> {
    await this.ask(`people/patients/${record}/exercise`, demo === "" ? { exercise, confirm } : { exercise, confirm, demo });
  }

  /// @param number  of the exercise that the page shows: the station refuses what is meant for another one
  /// @param values  of the input: "value" of a rating, an answer or a difficulty, "stops" of a resume
  async exerciseInput(kind: string, number: number, values: Readonly<Record<string, number>> = {}): Promise<void> {
    await this.ask("people/exercise", { kind, number, ...values });
  }

  // ---- the same while the page is locked

  /// The exercise without its patient. A locked session may ask for it.
  async watchedExercise(): Promise<ExerciseNow> {
    return readExerciseNow(await this.ask("people/exercise/watched", undefined, false, kExerciseMs));
  }

  /// @param kind  "pause", "pain" or "fatigue"
  async watchedInput(kind: string, number: number, values: Readonly<Record<string, number>> = {}): Promise<void> {
    await this.ask("people/exercise/watched", { kind, number, ...values });
  }
}
