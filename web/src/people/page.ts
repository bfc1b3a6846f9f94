// SPDX-License-Identifier: Apache-2.0
// The page of patients: who is signed in, which patient is displayed, and what stands there while it is locked. What belongs to patients is in
// the document only while a session is open: a lock removes it.
import { button, el, setShown, setText } from "../panels/dom";
import { accountsPanel, ownPasswordPanel, type AccountActions } from "./accounts_panel";
import { PeopleError, type PeopleApi } from "./api";
import { confirmPanel } from "./begin_exercise";
import { CalibrationOffer } from "./calibration_offer";
import { ReportWindows, reportLanguage } from "./documents";
import { isUnderWay, type ExerciseNow } from "./exercise_now";
import { ExerciseWatch } from "./exercise_watch";
import { IdleLock } from "./idle";
import { deletedReport, patientForm, patientView, type PatientContext } from "./patient_view";
import { exerciseList, patientList } from "./lists";
import { RunningPanel } from "./running_panel";
import { RunningStrip } from "./running_strip";
import type { Account, Course, Deleted, Exercise, Listed, Patient, SignedIn, Status, Template, Unreadable } from "./shapes";
import { lockPanel, signInForm } from "./sign_in";
import { explanation, refusalText } from "./trouble";
import { WatchedPanel, withoutPatient } from "./watched_panel";
import { words } from "./words";
import type { CalibrationFiles } from "../wire/calibration_channel";

/// What is displayed beside the list.
type Shown =
  | { readonly kind: "none" }
  | { readonly kind: "new" }
  | { readonly kind: "accounts"; readonly accounts: readonly Account[] }
  | { readonly kind: "deleted"; readonly report: Deleted }
  | { readonly kind: "confirm"; readonly patient: Patient; readonly course: Course | undefined; readonly exercise: Exercise }
  | { readonly kind: "exercise"; readonly record: string; readonly number: number } // that runs, or has just ended
  | { readonly kind: "view" | "edit"; readonly patient: Patient; readonly course: Course | undefined };

const kAllReadable: Unreadable = { damaged: [], withoutKey: 0 };
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
  private unreadable: Unreadable = kAllReadable;
  private exercises: readonly Exercise[] = [];
  private templates: readonly Template[] = [];
  private readonly offer = new CalibrationOffer(() => this.status?.exercises === true);
  private readonly windows = new ReportWindows();
  private readonly watch: ExerciseWatch;
  private readonly strip = new RunningStrip(() => this.showExercise());
  private running: ExerciseNow | undefined; // the newest answer
  private panel: RunningPanel | undefined;
  private readonly lockedWatch: ExerciseWatch;
  private watched: WatchedPanel | undefined; // while the page is locked
  private draft = { number: 0, text: "" }; // note that was being written when the page was locked
  private shown: Shown = { kind: "none" };
  private asked = 0; // number of the newest reading: what an older one brings is dropped
  private locked = false; // nothing of a patient is shown, whatever a request brings

  /// @param now    [ms]
  /// @param later  runs a function after kLockAgainMs  @param watchLater  runs a function after a time [ms], for the exercise that runs
  constructor(
    private readonly api: PeopleApi,
    private readonly now: () => number = () => Date.now(),
    private readonly later: (run: () => void) => void = (run) => void setTimeout(run, kLockAgainMs),
    watchLater?: (run: () => void, ms: number) => void,
  ) {
    this.watch = new ExerciseWatch(() => this.api.exercise(), (told) => this.heard(told), (reason, stale) => this.unheard(reason, stale), () => this.setStale(), now, watchLater);
    this.lockedWatch = new ExerciseWatch(() => this.api.watchedExercise(), (told) => this.watched?.show(told), (reason, stale) => this.unwatched(reason, stale), () => this.watched?.setStale(words.run.stale), now, watchLater);
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
    const { signed, running, panel } = this;
    if (!signed || this.locked) return;
    this.draft = { number: panel?.number ?? 0, text: panel?.draft ?? "" };
    this.forget();
    this.locked = true;
    const unlock = async (password: string) => {
      await this.api.unlock(password);
      this.lockedWatch.end();
      this.watched = undefined;
      this.locked = false;
      this.enter(signed);
      await this.readAll();
    };
    this.watched = new WatchedPanel((kind, number, values) => this.api.watchedInput(kind, number, values), this.now);
    if (running) this.watched.show(withoutPatient(running));
    this.put(el("div", { class: "people-locked" }, this.watched.element, lockPanel(signed.account, unlock, () => void this.signOut())));
    if (this.status?.exercises) this.lockedWatch.begin();
    void this.lockStation();
  }

  private unwatched(reason: unknown, stale: boolean): void {
    const ended = reason instanceof PeopleError && reason.trouble === "signed_out"; // the station has forgotten the session
    if (ended) this.lockedWatch.end();
    if (ended || stale) this.watched?.setStale(ended ? words.lock.lost : words.run.stale);
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

  /// Removes everything from the document, before the browser leaves the page.
  leave(): void {
    this.windows.closeAll();
    this.content.replaceChildren();
  }

  async signOut(why = ""): Promise<void> {
    this.forget();
    this.draft = { number: 0, text: "" };
    this.offer.end();
    this.locked = false;
    this.signed = undefined;
    void this.api.signOut();
    if (this.status?.accounts) this.showSignIn(why);
    else await this.begin();
  }

  // ---- sessions

  private async signIn(account: string, password: string): Promise<void> {
    this.enter(await this.api.signIn(account, password));
    await this.readAll();
  }

  private enter(signed: SignedIn): void {
    this.signed = signed;
    const lockMs = (kLockMargin * signed.idle) / kMillisecond;
    this.idle.begin({ lockMs, aliveMs: lockMs / kAlivePart });
    const who = signed.account === "" ? words.signIn.owner : words.signIn.as(signed.account, words.roles[signed.role] ?? signed.role);
    const out = signed.account === "" ? null : button(words.signIn.out, () => void this.signOut());
    const accounts = button(this.mayAdminister ? words.accounts.title : words.accounts.own, () => void this.openAccounts());
    this.account.replaceChildren(el("span", {}, who), button(words.lock.now, () => this.lock()), accounts, out ?? "");
    setShown(this.account, true);
  }

  private forget(): void {
    ++this.asked;
    this.idle.end();
    this.watch.end();
    this.lockedWatch.end();
    this.watched = undefined;
    this.windows.closeAll();
    this.running = undefined;
    this.panel = undefined;
    this.strip.show(undefined);
    this.patients = [];
    this.unreadable = kAllReadable;
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

  /// Reads the list, and from then on which exercise runs.
  private async readAll(): Promise<void> {
    await this.read();
    if (this.status?.exercises && this.signed && !this.locked) this.watch.begin();
  }

  /// Reads the list, and the exercises once.
  private async read(): Promise<void> {
    await this.bring(async () => {
      const { patients, ...unreadable } = await this.listed();
      if (this.exercises.length === 0) this.exercises = await this.api.exercises();
      if (this.templates.length === 0) this.templates = await this.api.templates().catch(() => []); // a station without them
      if (!this.locked) {
        this.patients = patients;
        this.unreadable = unreadable;
      }
      return undefined;
    });
  }

  /// The list of the station. The session of an account whose role sees no patients is ended: its page would have nothing to show.
  private async listed(): ReturnType<PeopleApi["patients"]> {
    try {
      return await this.api.patients();
    } catch (reason) {
      const { signed } = this;
      const isRefused = reason instanceof PeopleError && reason.trouble === "forbidden";
      if (isRefused && signed && this.status?.accounts && !this.locked) void this.signOut(words.signIn.noPatients(words.roles[signed.role] ?? signed.role));
      throw reason;
    }
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

  // ---- accounts

  private get mayAdminister(): boolean {
    return this.signed?.role === "administrator" || this.signed?.role === "owner";
  }

  private async openAccounts(): Promise<void> {
    const accounts = this.mayAdminister ? () => this.api.accounts() : () => Promise.resolve([]);
    await this.bring(async () => ({ kind: "accounts", accounts: await accounts() }));
    if (this.patients.length === 0) await this.read(); // the list was perhaps being read
    this.content.querySelector<HTMLElement>(".people-patient h2")?.focus();
  }

  private accountActions(signed: SignedIn): AccountActions {
    // The first account ends the owner's use of the page, and the end of the last one begins it again.
    const changed = async (request: Promise<void>) => {
      await this.change(request);
      const status = await this.api.status();
      const switched = status.accounts !== this.status?.accounts;
      this.status = status;
      if (switched) await this.signOut(status.accounts ? words.accounts.firstDone : words.accounts.lastDone);
      else await this.openAccounts();
    };
    return {
      add: (fields) => changed(this.api.addAccount(fields)),
      setRole: async (name, role) => {
        if (name !== signed.account) return changed(this.api.editAccount(name, { role }));
        await this.change(this.api.editAccount(name, { role }));
        await this.signOut(words.accounts.roleDone);
      },
      setPassword: async (name, password) => {
        await this.change(this.api.editAccount(name, { password }));
        if (name === signed.account) await this.signOut(words.accounts.passwordDone);
        else await this.openAccounts();
      },
      remove: (name) => changed(this.api.removeAccount(name)),
    };
  }

  private set(shown: Shown): void {
    ++this.asked; // what is being read is no longer wanted
    this.shown = shown;
    this.show();
    const first = shown.kind === "new" ? ".people-form input" : ".people-patient h2"; // never a button: Enter that is held down would press it
    this.content.querySelector<HTMLElement>(first)?.focus();
  }

  /// What a cockpit of this browser has told of the station's calibration.
  setStation(files: CalibrationFiles): void {
    this.offer.told(files);
    this.watch.now();
    this.showOffer();
  }

  private showOffer(): void {
    if (this.shown.kind === "view" && !this.isTyping()) this.show();
  }

  /// Whether a form of the displayed patient is being filled in: it must not be made again.
  private isTyping(): boolean {
    const { activeElement } = document;
    return activeElement instanceof HTMLElement && this.content.contains(activeElement) && activeElement.closest("form") !== null;
  }

  // ---- the exercise that the station carries out

  private heard(told: ExerciseNow): void {
    if (!this.signed || this.locked) return;
    const first = this.running === undefined;
    this.running = told;
    this.strip.setStale(false);
    if (this.panel?.number === told.number) this.panel.show(told);
    else if (this.shown.kind === "exercise") this.another(told);
    if (this.offer.heard(told)) this.showOffer();
    // A page that comes to an exercise under way, as after a reload, goes to it. Otherwise the strip leads there.
    if (first && isUnderWay(told) && this.shown.kind === "none") this.showExercise();
    this.showStrip();
  }

  private unheard(reason: unknown, stale: boolean): void {
    if (this.locked) return;
    if (reason instanceof PeopleError && reason.trouble === "signed_out") return void this.failed(reason);
    if (stale) this.setStale();
  }

  /// What is displayed of the exercise is not what happens now.
  private setStale(): void {
    this.panel?.setStale(true);
    this.strip.setStale(true);
  }

  /// Another exercise has begun than the one that is displayed. A result, and a form that is being filled in, stay; the strip leads on.
  private another(told: ExerciseNow): void {
    if (this.panel?.showsResult || this.isTyping()) return this.panel?.setStale(!this.panel.showsResult);
    this.shown = told.number === 0 ? { kind: "none" } : { kind: "exercise", record: told.record, number: told.number };
    this.show();
  }

  private showStrip(): void {
    const { running } = this;
    const { shown } = this;
    const elsewhere = running && isUnderWay(running) && !(shown.kind === "exercise" && shown.number === running.number);
    this.strip.show(elsewhere ? running : undefined);
  }

  private showExercise(): void {
    const { running } = this;
    if (running) this.set({ kind: "exercise", record: running.record, number: running.number });
  }

  private async beginExercise(patient: Patient, exercise: Exercise, demo: string): Promise<void> {
    await this.change(this.api.beginExercise(patient.record, exercise.name, patient.code, demo));
    if (this.locked) return;
    const told = await this.api.exercise();
    if (this.locked || !this.signed) return;
    this.running = told;
    this.showExercise();
    this.watch.now();
  }

  /// The panel of the exercise that runs: made once for each.
  private exercisePanel(shown: { readonly number: number }, told: ExerciseNow): HTMLElement {
    if (this.panel?.number === shown.number) return this.panel.element;
    const { record, name, number } = told;
    const actions = {
      input: async (kind: string, values?: Readonly<Record<string, number>>) => {
        await this.change(this.api.exerciseInput(kind, number, values));
        this.watch.now();
      },
      note: (text: string) => this.change(this.api.addNote(record, text)),
      back: () => void this.readAgain(record),
      list: () => this.set({ kind: "none" }),
      again: () => void this.openToBegin(record, name),
    };
    const draft = this.draft.number === number ? this.draft.text : "";
    this.draft = { number: 0, text: "" };
    this.panel = new RunningPanel(number, told, actions, reportLanguage(), this.now, draft);
    return this.panel.element;
  }

  private async openToBegin(record: string, name: string): Promise<void> {
    await this.open(record);
    if (this.shown.kind === "view" && this.shown.patient.record === record) this.confirm(this.shown.patient, this.shown.course, name);
  }

  private confirm(patient: Patient, course: Course | undefined, name: string): void {
    if (this.running && isUnderWay(this.running)) return this.trouble(words.begin.runs);
    const exercise = this.exercises.find((one) => one.name === name) ?? { name, title: name, titleDe: "", kind: "", measure: "" };
    this.set({ kind: "confirm", patient, course, exercise });
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
    this.content.replaceChildren(this.alert, this.strip.element, ...elements);
  }

  private detail(status: Status): HTMLElement {
    const { shown, exercises, templates, offer, windows } = this;
    const context: PatientContext = { status, exercises, templates, offer, windows };
    if (shown.kind === "new") return patientForm(undefined, context, (fields) => this.save(undefined, fields), () => this.set({ kind: "none" }));
    if (shown.kind === "exercise" && this.running) return this.exercisePanel(shown, this.running);
    if (shown.kind === "none" || shown.kind === "exercise") return el("div", { class: "people-detail", tabindex: 0, role: "group", "aria-label": words.exercises.title }, el("p", { class: "people-box hint" }, words.list.choose), exerciseList(exercises));
    if (shown.kind === "deleted") return deletedReport(shown.report);
    if (shown.kind === "accounts") return this.accountsView(shown.accounts);
    const { patient, course } = shown;
    const { record } = patient;
    const back = () => this.set({ kind: "view", patient, course });
    if (shown.kind === "confirm") return confirmPanel(patient, shown.exercise, (demo) => this.beginExercise(patient, shown.exercise, demo), back);
    if (shown.kind === "edit") return patientForm(patient, context, (fields) => this.save(patient, fields), back);
    return patientView(patient, context, course, {
      edit: () => this.set({ kind: "edit", patient, course }),
      back: () => this.set({ kind: "none" }),
      begin: (exercise) => this.confirm(patient, course, exercise),
      calibrate: () => this.offer.begin(record, this.running),
      change: (fields) => this.save(patient, fields),
      report: (day) => this.change(this.api.report(record, reportLanguage(), day)),
      fhir: (day) => this.change(this.api.fhir(record, day)),
      export: () => this.change(this.api.export(record)),
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

  private accountsView(accounts: readonly Account[]): HTMLElement {
    const { signed } = this;
    if (!signed) return el("div", {});
    const actions = this.accountActions(signed);
    return this.mayAdminister ? accountsPanel(accounts, actions) : ownPasswordPanel(signed.account, actions);
  }

  private show(): void {
    if (!this.status || !this.signed || this.locked) return;
    const { shown } = this;
    const chosen = "patient" in shown ? shown.patient.record : shown.kind === "exercise" ? shown.record : "";
    this.showStrip();
    const list = patientList(this.patients, this.unreadable, chosen, (record) => void this.open(record), () => this.set({ kind: "new" }));
    const scrolled = this.content.querySelector(".people-list")?.scrollTop ?? 0; // the list stays where it is
    const columns = el("div", { class: "people-columns", "data-detail": String(shown.kind !== "none") }, list, this.detail(this.status));
    this.put(columns);
    list.scrollTop = scrolled;
  }
}
