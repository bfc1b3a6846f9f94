// SPDX-License-Identifier: Apache-2.0
// The start of the patient's screen.
import { listenToStopKeys } from "../panels/stop_keys";
import type { Socket } from "../wire/connection";
import { linkExpired, postStop, streamUrl } from "../wire/http";
import { session } from "../wire/memory";
import { Station } from "./connection";
import { keep, optionsOf } from "./options";
import { PatientPage } from "./page";
import { nothingKnown } from "./state";
import { keepAwake } from "./wake_lock";
import { words } from "./words";

const kSecret = "phalanx.patient.secret"; // of this page alone: a tab that another page opened inherits that one's memory
const kMillisecond = 1e-3;

const options = optionsOf(location.search);
document.documentElement.lang = words.locale;
document.title = words.title;

const secret = { get: () => session.get(kSecret), set: (value: string) => void session.set(kSecret, value) };
const station: Station = new Station({
  openSocket: () => new WebSocket(streamUrl(location.href)) as unknown as Socket,
  secret,
  postStop,
  linkExpired,
  changed: () => {
    page.take(station.known);
    if (station.known.connected === "open") void page.signIn.check(secret.get());
  },
  stopping: (progress) => page.stopping(progress),
});
const page = new PatientPage(
  {
    stop: () => station.stop(),
    pause: () => station.pause(),
    rate: (kind, value) => station.rate(kind, value),
    chosen: (chosen, language) => {
      keep(chosen);
      if (!language) return;
      page.signIn.handOver();
      location.reload();
    },
  },
  options,
  nothingKnown,
);

document.getElementById("opening")?.remove();
document.getElementById("page")?.append(page.element);
listenToStopKeys(window, () => station.stop());
for (const input of ["pointerdown", "keydown"]) window.addEventListener(input, () => page.sound.wake(), { capture: true, passive: true });
const size = () => page.size(window.innerWidth, window.innerHeight);
window.addEventListener("resize", size);
size();
let last = performance.now();
const draw = (now: number) => {
  requestAnimationFrame(draw); // first: a frame that fails is not the last one
  page.frame((now - last) * kMillisecond);
  last = now;
};
requestAnimationFrame(draw);
keepAwake();
station.start();
