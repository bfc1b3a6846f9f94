// SPDX-License-Identifier: Apache-2.0
// The start of the page of patients. Its only connection to the device is STOP, which needs no session.
import { el } from "../panels/dom";
import { unreviewedMark } from "../panels/language_choice";
import { Look, lookSwitches } from "../panels/look";
import { listenToStopKeys } from "../panels/stop_keys";
import { strings } from "../strings";
import { hearCalibration } from "../wire/calibration_channel";
import { postStop } from "../wire/http";
import { session } from "../wire/memory";
import { offerSession } from "../wire/shared_session";
import { PeopleApi } from "./api";
import { PeoplePage } from "./page";
import { stopBar } from "./stop_bar";
import { words } from "./words";

const kSecret = "phalanx.secret"; // of the cockpit's page that opened this tab, as in main.ts
const kCheckMs = 1000;
const inputs = ["pointerdown", "pointermove", "keydown", "wheel", "touchstart"] as const;

document.documentElement.lang = strings.locale;
document.title = words.title;
const look = new Look(() => {});
const api = new PeopleApi(session.get(kSecret));
const page = new PeoplePage(api);
const stop = stopBar(() => postStop(session.get(kSecret)));

listenToStopKeys(window, stop.stop);
offerSession(() => api.secret); // to the page of recordings
hearCalibration((files) => page.setStation(files)); // from the cockpit
for (const input of inputs) window.addEventListener(input, () => page.idle.input(), { capture: true, passive: true });
setInterval(() => page.idle.check(), kCheckMs);
document.addEventListener("visibilitychange", () => page.idle.check());
window.addEventListener("pageshow", (event) => event.persisted && location.reload()); // from the browser's memory: its session has ended
window.addEventListener("pagehide", () => {
  page.leave(); // a page that the browser keeps shows nothing when it comes back
  void api.signOut();
});

const header = el(
  "header",
  { class: "header people-header" },
  el("h1", {}, words.heading),
  unreviewedMark(),
  page.account,
  el("div", { class: "header-tools" }, ...lookSwitches(look).elements, el("a", { href: "./", title: words.stop.cockpitHint }, words.stop.cockpit)),
);
document.getElementById("opening")?.remove();
document.getElementById("page")?.append(header, page.content, stop.element);
void page.begin();
