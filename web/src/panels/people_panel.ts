// SPDX-License-Identifier: Apache-2.0
// The open pages, the operator, the name and the language of this page, and the list of changes.
import { Notice_Level, type Notice } from "../gen/phalanx/cockpit_pb";
import { mayTake } from "../state/roles";
import { strings } from "../strings";
import { lasting } from "../wire/memory";
import { refusal, type App } from "./app";
import { clockTime } from "./as_text";
import { button, el, section, setShown, setText } from "./dom";
import { languageChoice } from "./language_choice";
import { eventWords, whoText } from "./plain_words";
import { operatorName } from "./role_strip";
import { row } from "./setting_controls";

const words = strings.people;

/// @param own  number of this page
function noticeItem(notice: Notice, own: number | undefined): HTMLElement {
  const level = strings.notice.levels[notice.level] ?? "";
  return el(
    "li",
    { class: "notice", "data-level": Notice_Level[notice.level]?.toLowerCase() },
    el("time", {}, clockTime(notice.unixTime)),
    el("span", { class: "notice-level" }, level),
    el("span", { class: "notice-who" }, whoText(notice.who, own)),
    el("span", { class: "notice-text" }, eventWords(notice.code, notice.text)),
  );
}

export const kNameKey = "phalanx.name";

function nameRow(app: App): HTMLElement {
  // No list of the browser's own: an open one would take Esc for itself.
  const field = el("input", { type: "text", maxlength: 40, autocomplete: "off", value: lasting.get(kNameKey) });
  const made = row(words.name, field, "", words.nameHint);
  const save = button(words.save, () => void send());
  made.element.querySelector(".row-control")?.append(save);
  async function send(): Promise<void> {
    lasting.set(kNameKey, field.value.trim());
    made.refuse(refusal(await app.host.setName(field.value.trim())));
  }
  field.addEventListener("keydown", (event) => {
    if (event.key === "Enter") void send();
  });
  return made.element;
}

/// Opens the page of patients in a tab of its own. That tab gets this page's memory (rel=opener): the log of changes then names the account
/// that signs in there beside this page.
function patientsLink(app: App): HTMLElement {
  const link = el("p", {}, el("a", { href: "people.html", target: "_blank", rel: "opener" }, words.patients), el("small", { class: "link-hint" }, words.patientsHint));
  const update = () => setShown(link, app.store.welcome?.mayOperate ?? false);
  app.store.on(["state", "connection"], update);
  update();
  return link;
}

export function peoplePanel(app: App): HTMLElement {
  const facts = el("dl", { class: "facts" });
  const release = button(strings.role.release, () => void go());
  const take = button(strings.role.take, app.takeControl, { class: "primary" });
  const error = el("p", { class: "refused", role: "alert", hidden: true });
  const urls = el("ul", { class: "urls" });
  const urlBox = el("div", {}, el("h3", {}, words.elsewhere), urls);
  const log = el("ol", { class: "notices" });
  const empty = el("p", { class: "hint" }, words.logEmpty);
  async function go(): Promise<void> {
    setText(error, refusal(await app.host.releaseControl()));
    setShown(error, error.textContent !== "");
  }
  const update = () => {
    const { state, welcome, role } = app.store;
    const me = welcome ? strings.page(welcome.page) : strings.dash;
    const operator = role === "mine" ? words.named(operatorName(app)) : operatorName(app);
    const wanted = [words.thisPage, me, words.operator, operator];
    if (facts.dataset["shown"] !== wanted.join()) {
      facts.dataset["shown"] = wanted.join();
      facts.replaceChildren(...wanted.map((text, i) => el(i % 2 === 0 ? "dt" : "dd", {}, text)));
    }
    setText(looking, strings.people.looking(state?.pages ?? 0));
    setShown(release, role === "mine");
    setShown(take, mayTake(role));
    const links = welcome?.viewerUrl ?? [];
    setShown(urlBox, links.length > 0);
    if (urls.dataset["shown"] !== links.join()) {
      urls.dataset["shown"] = links.join();
      urls.replaceChildren(...links.map((url) => el("li", {}, el("code", {}, url))));
    }
  };
  const notices = () => {
    const own = app.store.welcome?.page;
    log.replaceChildren(...[...app.store.notices].reverse().map((notice) => noticeItem(notice, own)));
    setShown(empty, app.store.notices.length === 0);
  };
  const looking = el("p", { class: "hint" });
  app.store.on(["state", "connection"], update);
  app.store.on(["notice"], notices);
  update();
  notices();
  return el(
    "div",
    {},
    section(words.title, looking, facts, error, el("div", { class: "buttons" }, release, take), urlBox, patientsLink(app)),
    section(words.thisPage, nameRow(app), languageChoice(app)),
    section(words.log, empty, log),
  );
}
