// SPDX-License-Identifier: Apache-2.0
// The people who sign in: an administrator, or the owner of a computer without accounts, adds and changes them. All others change their own
// password.
import { el, newId, section } from "../panels/dom";
import { form, type FieldPlan } from "./form";
import type { Account } from "./shapes";
import { words } from "./words";

export interface AccountActions {
  add(fields: Readonly<Record<string, unknown>>): Promise<void>;
  setRole(name: string, role: string): Promise<void>;
  setPassword(name: string, password: string): Promise<void>;
  remove(name: string): Promise<void>;
}

const kRoles: readonly string[] = ["therapist", "administrator", "patient_screen", "look_on"];
const kLongestName = 32;
const kLongestPassword = 256;

const roleChoices = () => kRoles.map((value) => ({ value, text: words.roles[value] ?? value }));
const passwordPlan = (label: string): FieldPlan => ({ name: "password", label, kind: "secret", hint: words.accounts.passwordHint, longest: kLongestPassword });

function passwordForm(name: string, actions: AccountActions): HTMLElement {
  return form([passwordPlan(words.accounts.newPassword)], {}, words.accounts.setPassword, (values) => actions.setPassword(name, String(values["password"])));
}

function accountItem({ name, role }: Account, actions: AccountActions): HTMLElement {
  const texts = words.accounts;
  const roles = form([{ name: "role", label: texts.role, kind: "choice", choices: roleChoices() }], { role }, texts.setRole, (values) => actions.setRole(name, String(values["role"])));
  const remove = form([{ name: "confirm", label: texts.confirm(name), kind: "text", longest: kLongestName }], {}, texts.remove, (values) => {
    if (values["confirm"] !== name) throw new Error(texts.wrongName);
    return actions.remove(name);
  });
  return el(
    "li",
    { class: "account" },
    el("details", {}, el("summary", {}, el("strong", {}, name), el("span", { class: "quiet-text" }, words.roles[role] ?? role)), roles, passwordForm(name, actions), remove),
  );
}

/// @param accounts  empty: there are none, and the owner of the computer uses the page
export function accountsPanel(accounts: readonly Account[], actions: AccountActions): HTMLElement {
  const texts = words.accounts;
  const id = newId("accounts");
  const first = accounts.length === 0;
  const plans: readonly FieldPlan[] = [
    { name: "name", label: texts.name, kind: "text", hint: texts.nameHint, longest: kLongestName },
    { name: "role", label: texts.role, kind: "choice", choices: first ? roleChoices().filter(({ value }) => value === "administrator") : roleChoices() },
    passwordPlan(words.signIn.password),
  ];
  return el(
    "section",
    { class: "people-box people-patient", "aria-labelledby": id },
    el("h2", { id, tabindex: -1 }, texts.title),
    first ? el("p", { class: "hint" }, texts.first) : el("ul", { class: "accounts" }, ...accounts.map((one) => accountItem(one, actions))),
    section(texts.add, form(plans, {}, texts.add, actions.add)),
    el("p", { class: "hint" }, texts.lost),
  );
}

/// Of an account that may not change others.
export function ownPasswordPanel(name: string, actions: AccountActions): HTMLElement {
  const id = newId("password");
  return el("section", { class: "people-box people-patient", "aria-labelledby": id }, el("h2", { id, tabindex: -1 }, words.accounts.own), passwordForm(name, actions));
}
