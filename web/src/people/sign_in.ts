// SPDX-License-Identifier: Apache-2.0
// Signing in, and the page while it is locked.
import { button, el, newId, setShown, setText } from "../panels/dom";
import { refusalText } from "./trouble";
import { words } from "./words";

function labelled(label: string, input: HTMLInputElement): HTMLElement {
  input.id = newId("sign-in");
  return el("div", { class: "field" }, el("label", { for: input.id }, label), input);
}

/// A form whose refusal stands beside its button. The password is forgotten when it has been sent.
function secretForm(title: string, parts: readonly (Node | null)[], password: HTMLInputElement | null, submit: string, send: () => Promise<void>): HTMLElement {
  const refused = el("p", { class: "refused", role: "alert", hidden: true });
  const press = el("button", { type: "submit", class: "primary" }, submit);
  const id = newId("gate");
  const form = el("form", { class: "people-box people-gate", "aria-labelledby": id, novalidate: true }, el("h2", { id }, title), ...parts, refused, press);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    if (press.disabled) return;
    press.disabled = true;
    setShown(refused, false);
    void send()
      .catch((reason: unknown) => {
        setText(refused, refusalText(reason));
        setShown(refused, true);
      })
      .finally(() => {
        press.disabled = false;
        if (password) password.value = "";
      });
  });
  return form;
}

export function signInForm(signIn: (account: string, password: string) => Promise<void>, why = ""): HTMLElement {
  const account = el("input", { type: "text", autocomplete: "username", maxlength: 64, spellcheck: "false", autocapitalize: "none" });
  const password = el("input", { type: "password", autocomplete: "current-password", maxlength: 256 });
  const parts = [
    el("p", { class: "hint", role: "status", hidden: why === "" }, why),
    labelled(words.signIn.account, account),
    labelled(words.signIn.password, password),
  ];
  return secretForm(words.signIn.title, parts, password, words.signIn.submit, () => signIn(account.value.trim(), password.value));
}

/// What stands in place of the patients while the page is locked.
/// @param account  empty: the owner, who has no password
export function lockPanel(account: string, unlock: (password: string) => Promise<void>, other: () => void): HTMLElement {
  const hint = el("p", { class: "hint", role: "status" }, words.lock.hint);
  if (account === "") return secretForm(words.lock.title, [hint], null, words.lock.goOn, () => unlock(""));
  const password = el("input", { type: "password", autocomplete: "current-password", maxlength: 256 });
  const known = el("input", { type: "text", autocomplete: "username", hidden: true, value: account }); // for the browser's store of passwords
  const form = secretForm(words.lock.title, [hint, known, labelled(words.lock.password(account), password)], password, words.lock.unlock, () => unlock(password.value));
  form.append(button(words.lock.other, other, { class: "quiet" }));
  return form;
}
