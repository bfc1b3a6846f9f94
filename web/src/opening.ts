// SPDX-License-Identifier: Apache-2.0
// The first script, and a small one: what index.html holds is painted, in the chosen language once this script is there, then the page
// itself comes and takes its place.
import { strings } from "./strings";

const kUnseenMs = 250; // a hidden page is not painted

document.documentElement.lang = strings.locale;
document.querySelector("#opening p")?.replaceChildren(strings.opening);
const bringIn = () => void import("./main"); // once, for any number of calls
requestAnimationFrame(() => setTimeout(bringIn)); // what is asked for in a frame's callback comes after its paint
setTimeout(bringIn, kUnseenMs);
