// SPDX-License-Identifier: Apache-2.0
// The page of patients: who is signed in, which patient is displayed, and what stands there while it is locked. What belongs to patients is in
// the document only while a session is open: a lock removes it.
import { button, el, setShown, setText } from "../panels/dom";
import { PeopleError, type PeopleApi } from "./api";
import { IdleLock } from "./idle";
import { patientForm, patientView } from "./patient_view";
import { exerciseList, patientList } from "./lists";
import type { Course, Deleted, Exercise, Listed, Patient, SignedIn, Status } from "./shapes";
import { lockPanel, signInForm } from "./sign_in";
import { explanation, refusalText } from "./trouble";
import { words } from "./words";

/// What is displayed beside the list.
type Shown =
  | { readonly kind: "none" }
  | { readonly kind: "new" }
  | { readonly kind: "deleted"; readonly report: Deleted }
  | { readonly kind: "view" | "edit"; readonly patient: Patient; readonly course: Course | undefined };

const kLockMargin = 0.9; // of the station's time: the page is locked first, so that no request meets a locked session
const kAlivePart = 5; // reports to the station within that time
const kMillisecond = 1e-3;
const kLockAgainMs = 1000; // after a lock that the station did not confirm

export class PeoplePage {
  readonly content = el("main", { class: "people-content" });
  /// Account, lock and sign-out, for the page's header.
  readonly account = el("div", { class: "people-account", hidden: true });
  readonly idle: IdleLock;
  private status: Status | undefined;
  private signed: SignedIn | undefined;
  private patients: readonly Listed[] = [];
  private exercises: readonly Exercise[] = [];
  private shown: Shown = { kind: "none" };
  private asked = 0; // number of the newest reading: what an older one brings is dropped
  private locked = false; // nothing of a patient is shown, whatever a request brings

  /// @param now    [ms]
  /// @param later  runs a function after kLockAgainMs
  constructor(
    private readonly api: PeopleApi,
    now: () => number = () => Date.now(),
    private readonly later: (run: () => void) => void = (run) => void setTimeout(run, kLockAgainMs),
  ) {
    this.idle = new IdleLock(now, () => this.lock(), () => void this.api.alive().catch((reason: unknown) => this.failed(reason)));
  }

  /// Asks the station what there is, and shows the sign-in or the patients.
  async begin(): Promise<void> {
    this.say(words.reading);
    try {
      this.status = await this.api.status();
      if (this.status.accounts) this.showSignIn("");
      else await this.signIn("", "");
    } catch (reason) {
      this.end(reason);
    }
  }

  /// Removes what belongs to patients from the document at once, and locks the session at the station.
  lock(): void {
    const { signed } = this;
    if (!signed || this.locked) return;
    this.forget();
    this.locked = true;
    const unlock = async (password: string) => {
      await this.api.unlock(password);
      this.locked = false;
      this.enter(signed);
      await this.read();
    };
    this.put(lockPanel(signed.account, unlock, () => void this.signOut()));
    void this.lockStation();
  }

  /// Locks the session at the station, again and again until the station has confirmed it or the session has ended.
  private async lockStation(): Promise<void> {
    if (!this.locked) return;
    try {
      await this.api.lock();
    } catch (reason) {
      if (reason instanceof PeopleError && reason.trouble === "signed_out") return;
      this.later(() => void this.lockStation());
    }
  }

  async signOut(why = ""): Promise<void> {
    this.forget();
    this.locked = false;
    this.signed = undefined;
    void this.api.signOut();
    if (this.status?.accounts) this.showSignIn(why);
    else await this.begin();
  }

  // ---- sessions

  private async signIn(account: string, password: string): Promise<void> {
    this.enter(await this.api.signIn(account, password));
    await this.read();
  }

  private enter(signed: SignedIn): void {
    this.signed = signed;
    const lockMs = (kLockMargin * signed.idle) / kMillisecond;
    this.idle.begin({ lockMs, aliveMs: lockMs / kAlivePart });
    const who = signed.account === "" ? words.signIn.owner : words.signIn.as(signed.account, words.roles[signed.role] ?? signed.role);
    const out = signed.account === "" ? null : button(words.signIn.out, () => void this.signOut());
    this.account.replaceChildren(el("span", {}, who), button(words.lock.now, () => this.lock()), out ?? "");
    setShown(this.account, true);
  }

  private forget(): void {
    ++this.asked;
    this.idle.end();
    this.patients = [];
    this.shown = { kind: "none" };
    setShown(this.account, false);
  }

  private showSignIn(why: string): void {
    this.put(signInForm((account, password) => this.signIn(account, password), why));
  }

  /// Shows why there is nothing.
  private end(reason: unknown): void {
    const { text, hint } = explanation(reason);
    this.put(el("div", { class: "people-box people-gate" }, el("p", { role: "alert" }, text), el("p", { class: "hint", hidden: hint === "" }, hint)));
  }

  /// Handles what a request threw while a session was open.
  private failed(reason: unknown): void {
    if (this.locked) return; // the lock's panel stays
    if (reason instanceof PeopleError && reason.trouble === "signed_out") void this.signOut(words.signedOut);
    else this.trouble(refusalText(reason));
  }

  // ---- patients

  /// Runs requests; what they bring is shown unless something newer was asked for meanwhile.
  private async bring(requests: () => Promise<Shown | undefined>): Promise<void> {
    if (this.locked) return;
    const mine = ++this.asked;
    try {
      const found = await requests();
      if (mine !== this.asked || !this.signed || this.locked) return;
      if (found) this.shown = found;
      this.show();
    } catch (reason) {
      if (mine === this.asked) this.failed(reason);
    }
  }

  /// Reads the list, and the exercises once.
  private async read(): Promise<void> {
    await this.bring(async () => {
      const patients = await this.api.patients();
      if (this.exercises.length === 0) this.exercises = await this.api.exercises();
      if (!this.locked) this.patients = patients;
      return undefined;
    });
  }

  private async open(record: string): Promise<void> {
    await this.bring(async () => ({ kind: "view", patient: await this.api.patient(record), course: undefined }));
    if (this.shown.kind !== "view" || this.shown.patient.record !== record) return;
    const { patient } = this.shown;
    await this.bring(async () => ({ kind: "view", patient, course: await this.api.course(record) }));
    this.content.querySelector<HTMLElement>(".people-patient h2")?.focus();
  }

  /// After a change: the list and the patient as the station has them now.
  private async readAgain(record: string): Promise<void> {
    await this.read();
    await this.open(record);
  }

  /// Makes a change. Its refusal goes to the form; with the session, all of the patients leave the document.
  private async change<T>(request: Promise<T>): Promise<T> {
    try {
      return await request;
    } catch (reason) {
      if (reason instanceof PeopleError && reason.trouble === "signed_out" && !this.locked) void this.signOut(words.signedOut);
      throw reason;
    }
  }

  private async save(before: Patient | undefined, fields: Readonly<Record<string, unknown>>): Promise<void> {
    const saved = before ? await this.change(this.api.edit(before.record, before.revision, fields)) : await this.change(this.api.add(fields));
    await this.readAgain(saved.record);
    if (!this.locked && saved.said.length > 0) this.trouble(saved.said.join("; "));
  }

  private async remove(record: string, confirm: string): Promise<void> {
    const report = await this.change(this.api.remove(record, confirm));
    if (this.locked) return;
    this.shown = { kind: "deleted", report };
    await this.read();
  }

  private set(shown: Shown): void {
    ++this.asked; // what is being read is no longer wanted
    this.shown = shown;
    this.show();
    this.content.querySelector<HTMLElement>(".people-patient h2")?.focus();
  }

  // ---- what is in the document

  private readonly alert = el("p", { class: "refused", role: "alert", hidden: true });

  private trouble(text: string): void {
    setText(this.alert, text);
    setShown(this.alert, text !== "");
  }

  private say(text: string): void {
    this.put(el("p", { class: "people-box people-gate hint", role: "status" }, text));
  }

  private put(...elements: readonly HTMLElement[]): void {
    this.trouble("");
    this.content.replaceChildren(this.alert, ...elements);
  }

  private detail(status: Status): HTMLElement {
    const { shown } = this;
    if (shown.kind === "new") return patientForm(undefined, status, (fields) => this.save(undefined, fields), () => this.set({ kind: "none" }));
    if (shown.kind === "none") return el("div", { class: "people-detail", tabindex: 0, role: "group", "aria-label": words.exercises.title }, el("p", { class: "people-box hint" }, words.list.choose), exerciseList(this.exercises));
    if (shown.kind === "deleted") {
      const { left } = shown.report;
      const files = el("ul", {}, ...left.map((file) => el("li", {}, el("code", {}, file))));
      return el("div", { class: "people-box", role: "status" }, el("p", {}, words.remove.done), ...(left.length > 0 ? [el("p", {}, words.remove.left), files] : []));
    }
    const { patient, course } = shown;
    const { record } = patient;
    if (shown.kind === "edit") return patientForm(patient, status, (fields) => this.save(patient, fields), () => this.set({ kind: "view", patient, course }));
    return patientView(patient, status, course, {
      edit: () => this.set({ kind: "edit", patient, course }),
      back: () => this.set({ kind: "none" }),
      addTest: async (test) => {
        await this.change(this.api.addTest(record, test));
        await this.open(record);
      },
      addNote: async (text) => {
        await this.change(this.api.addNote(record, text));
        await this.open(record);
      },
      remove: (confirm) => this.remove(record, confirm),
    });
  }

  private show(): void {
    if (!this.status || !this.signed || this.locked) return;
    const { shown } = this;
    const chosen = shown.kind === "view" || shown.kind === "edit" ? shown.patient.record : "";
    const list = patientList(this.patients, chosen, (record) => void this.open(record), () => this.set({ kind: "new" }));
    const scrolled = this.content.querySelector(".people-list")?.scrollTop ?? 0; // the list stays where it is
    const columns = el("div", { class: "people-columns", "data-detail": String(shown.kind !== "none") }, list, this.detail(this.status));
    this.put(columns);
    list.scrollTop = scrolled;
  }
}
