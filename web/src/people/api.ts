// SPDX-License-Identifier: Apache-2.0
// Requests of the page of patients. The secret of a session is in the memory of this page only: no cookie, no storage. It goes in a header,
// which no other site's page can send.
import {
  readCourse, readDeleted, readExercises, readPatient, readPatients, readSignedIn, readStatus,
  type Course, type Deleted, type Exercise, type Listed, type Patient, type SignedIn, type Status,
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
const troubles: Readonly<Record<number, Trouble>> = { 401: "signed_out", 403: "forbidden", 404: "none", 429: "busy", 503: "busy" };

export class PeopleApi {
  private session = "";

  /// @param page  secret of the cockpit's page that opened this one: its line in the log of changes names the account; empty: none
  constructor(
    private readonly page: string = "",
    private readonly get: Fetch = (address, options) => fetch(address, options),
  ) {}

  /// Sends a request. @throws PeopleError
  private async ask(path: string, body?: unknown, keepalive = false): Promise<unknown> {
    const headers: Record<string, string> = this.session === "" ? {} : { "X-Phalanx-Session": this.session };
    if (body !== undefined) headers["Content-Type"] = "application/json";
    if (this.page !== "") headers["X-Phalanx-Page"] = this.page;
    let response: Response;
    let said: string;
    try {
      response = await this.get(path, {
        method: body === undefined ? "GET" : "POST", headers, body: body === undefined ? null : JSON.stringify(body),
        cache: "no-store", signal: AbortSignal.timeout(kAnswerMs), keepalive,
      });
      said = await response.text();
    } catch (reason) {
      throw new PeopleError("gone", String(reason));
    }
    if (!response.ok) throw new PeopleError(troubles[response.status] ?? "refused", said.trim());
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

  async patients(): Promise<readonly Listed[]> {
    return readPatients(await this.ask("people/patients"));
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
}
