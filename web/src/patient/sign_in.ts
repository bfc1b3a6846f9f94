// SPDX-License-Identifier: Apache-2.0
// The sign-in of a screen at a station with accounts. STOP needs none. The session's secret is in the memory of this page only, and for a
// moment in that of the tab while the page is opened again in another language.
import { el, setShown, setText } from "../panels/dom";
import { PeopleApi, PeopleError, type Fetch } from "../people/api";
import { session } from "../wire/memory";
import { words } from "./words";

const kAlivePart = 3; // reports to the station within the time after which it locks a session
const kRetryMs = 3000; // after which a station that did not say whether it has accounts is asked again
const kLeftMs = 10_000; // after which a field that is left loses the focus: Space in it would be a blank and no STOP
const kHandedOver = "phalanx.patient.session";
const kAllowed = ["patient_screen", "therapist", "administrator", "owner"];

export interface SignIn {
  readonly element: HTMLElement;
  readonly needed: boolean; // the station wants it
  readonly later: boolean; // a person chose to do it later
  /// Asks the station whether it has accounts. @param page  secret of this page
  check(page: string): Promise<void>;
  /// The station has refused what the patient sent because this screen is not signed in.
  refused(): void;
  /// Wants the form again after "Later".
  open(): void;
  /// Keeps the session for this tab's next page, which takes it and removes it.
  handOver(): void;
}

/// Session that a page leaves to the next one in its tab.
interface HandedOver {
  readonly page: string;
  readonly session: string;
  readonly idle: number; // [s]
}

/// Takes what the page before has left, once.
function handedOver(): HandedOver | undefined {
  const text = session.get(kHandedOver);
  if (text === "") return undefined;
  session.set(kHandedOver, "");
  try {
    const { page, session: secret, idle } = JSON.parse(text) as Partial<HandedOver>;
    return typeof page === "string" && typeof secret === "string" && typeof idle === "number" ? { page, session: secret, idle } : undefined;
  } catch {
    return undefined;
  }
}

/// Requests with the secret of a session that began before this page.
const withSession = (secret: string): Fetch => (address, options) => fetch(address, { ...options, headers: { ...(options.headers as Record<string, string>), "X-Phalanx-Session": secret } });

export function signIn(changed: () => void, api: (page: string, get?: Fetch) => PeopleApi = (page, get) => new PeopleApi(page, get)): SignIn {
  let needed = false;
  let later = false;
  let page = "";
  let signedIn: HandedOver | undefined;
  let before = handedOver();
  let retry: ReturnType<typeof setTimeout> | undefined;
  let left: ReturnType<typeof setTimeout> | undefined;
  let alive: ReturnType<typeof setInterval> | undefined;
  const account = el("input", { type: "text", id: "screen-account", autocomplete: "username", maxlength: 64, spellcheck: "false", autocapitalize: "none" });
  const password = el("input", { type: "password", id: "screen-password", autocomplete: "current-password", maxlength: 256 });
  const refused = el("p", { class: "sign-in-refused", role: "alert", hidden: true });
  const send = el("button", { type: "submit", class: "soft" }, words.signIn.submit);
  const notNow = el("button", { type: "button", class: "soft sign-in-later" }, words.signIn.later);
  const element = el(
    "form",
    { class: "card sign-in", "aria-labelledby": "sign-in-title", novalidate: true, hidden: true },
    el("h2", { id: "sign-in-title" }, words.signIn.title), el("p", {}, words.signIn.more),
    el("label", { for: account.id }, words.signIn.account), account, el("label", { for: password.id }, words.signIn.password), password, refused, el("div", { class: "sign-in-buttons" }, send, notNow),
  );
  const need = (value: boolean) => {
    if (needed === value && !later) return;
    needed = value;
    later = false;
    changed();
  };
  for (const field of [account, password]) {
    const used = () => {
      clearTimeout(left);
      left = setTimeout(() => field.blur(), kLeftMs);
    };
    field.addEventListener("focus", used);
    field.addEventListener("input", used);
    field.addEventListener("blur", () => clearTimeout(left));
  }
  notNow.addEventListener("click", () => {
    later = true;
    account.blur();
    password.blur();
    password.value = "";
    changed();
  });
  const keepAlive = (made: PeopleApi, secret: string, idle: number) => {
    signedIn = { page, session: secret, idle };
    clearInterval(alive);
    if (idle > 0) alive = setInterval(() => void made.alive().catch(() => undefined), (1000 * idle) / kAlivePart);
  };
  /// @returns whether the session of the page before still holds
  const takeOver = async (from: HandedOver): Promise<boolean> => {
    const made = api(from.page, withSession(from.session));
    const holds = await made.alive().then(() => true, () => false);
    if (holds) keepAlive(made, from.session, from.idle);
    return holds;
  };
  const ask = async (secret: string): Promise<void> => {
    clearTimeout(retry);
    let accounts: boolean;
    try {
      ({ accounts } = await api(secret).status());
    } catch (reason) {
      const trouble = reason instanceof PeopleError ? reason.trouble : "gone";
      if (secret !== page) return;
      if (trouble === "none" || trouble === "forbidden") return need(false); // it keeps no patients, or never lets this address sign in
      retry = setTimeout(() => void ask(secret), kRetryMs);
      return;
    }
    const from = before?.page === secret ? before : undefined;
    before = undefined;
    const holds = accounts && from !== undefined && (await takeOver(from));
    if (secret === page) need(accounts && !holds);
  };
  const say = (text: string) => {
    setText(refused, text);
    setShown(refused, text !== "");
  };
  const enter = async () => {
    const made = api(page);
    const signed = await made.signIn(account.value.trim(), password.value);
    if (!kAllowed.includes(signed.role)) {
      await made.signOut();
      return say(words.signIn.forbidden);
    }
    say("");
    keepAlive(made, signed.session, signed.idle);
    need(false);
  };
  element.addEventListener("submit", (event) => {
    event.preventDefault();
    if (send.disabled) return;
    send.disabled = true;
    void enter()
      .catch((reason: unknown) => say(reason instanceof PeopleError && reason.trouble === "gone" ? words.signIn.gone : words.signIn.failed))
      .finally(() => {
        send.disabled = false;
        password.value = "";
      });
  });
  return {
    element,
    get needed() {
      return needed;
    },
    get later() {
      return later;
    },
    async check(secret) {
      if (secret === page) return; // the same page as before: it is signed in already, or the form is open
      page = secret;
      signedIn = undefined;
      clearInterval(alive);
      await ask(secret);
    },
    refused() {
      signedIn = undefined;
      need(true);
    },
    open() {
      later = false;
      changed();
    },
    handOver() {
      if (signedIn) session.set(kHandedOver, JSON.stringify(signedIn));
    },
  };
}
