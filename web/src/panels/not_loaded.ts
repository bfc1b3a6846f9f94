// SPDX-License-Identifier: Apache-2.0
// What stands in the place of a part of the page that could not be loaded.
import { strings } from "../strings";
import { button, el } from "./dom";

export const reloadButton = (): HTMLButtonElement => button(strings.reload, () => location.reload());

export const notLoaded = (what: string): HTMLElement => el("div", { class: "not-loaded", role: "alert" }, el("p", {}, what), reloadButton());
