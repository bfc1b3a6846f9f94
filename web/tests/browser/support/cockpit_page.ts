// SPDX-License-Identifier: Apache-2.0
// One browser page with the cockpit: what a person finds on it, by the names that a screen reader says.
import { fromBinary } from "@bufbuild/protobuf";
import type { Locator, Page } from "playwright-core";
import { HandSource, type State } from "../../../src/gen/phalanx/cockpit_pb";
import { GeometrySchema, type Geometry } from "../../../src/gen/phalanx/geometry_pb";
import { SafetyState } from "../../../src/gen/phalanx/tick_pb";
import { english, type Strings } from "../../../src/strings";
import type { ViewProbe } from "../../../src/view3d/hand_view";
import type { MeshPreviewProbe } from "../../../src/view3d/mesh_preview";
import { Stream } from "./stream";
import { kHangMs, until } from "./until";

const kStill = 2e-4; // [rad]

export class CockpitPage {
  readonly stream: Stream;
  readonly errors: string[] = [];
  texts: Strings = english.texts; // of the language that the page is in

  constructor(readonly page: Page) {
    this.stream = new Stream(page);
    page.on("pageerror", (error) => this.errors.push(String(error.stack ?? error)));
    page.setDefaultTimeout(kHangMs);
  }

  async go(url: string): Promise<void> {
    await this.page.goto(url);
    await this.ready();
  }

  /// The stream runs and the hand is drawn.
  async ready(): Promise<void> {
    await until("a picture of the hand", async () => ((await this.probe())?.shown.length ?? 0) > 0 && this.stream.newest !== undefined, () => this.brief());
  }

  probe(): Promise<ViewProbe | undefined> {
    return this.page.evaluate(() => window.phalanx?.view());
  }

  /// The preview of the user's own object; undefined: nothing is drawn.
  preview(): Promise<MeshPreviewProbe | undefined> {
    return this.page.evaluate(() => window.phalanx.preview());
  }

  state(): Promise<State | undefined> {
    return this.page.evaluate(() => window.phalanx?.state());
  }

  lost(): Promise<boolean> {
    return this.page.evaluate(() => window.phalanx.lost());
  }

  /// The same and the words beside it, of one moment.
  verdictInWords(): Promise<{ verdict: string | null; words: string }> {
    return this.page.locator("[data-verdict]").evaluate((light: HTMLElement) => ({ verdict: light.getAttribute("data-verdict"), words: light.innerText }));
  }

  number(): Promise<number> {
    return this.page.evaluate(() => window.phalanx.page());
  }

  /// What the light says: none, steady, shakes or unknown.
  verdict(): Promise<string | null> {
    return this.page.locator("[data-verdict]").getAttribute("data-verdict");
  }

  /// The shapes as the station serves them, not as the page keeps them.
  async geometry(): Promise<Geometry> {
    const url = new URL(`geometry/${this.stream.state!.geometry}`, this.page.url());
    return fromBinary(GeometrySchema, await (await this.page.request.get(url.href)).body());
  }

  // ---- by their names

  button(name: string): Locator {
    return this.page.getByRole("button", { name, exact: true });
  }

  switch(name: string): Locator {
    return this.page.getByRole("switch", { name, exact: true });
  }

  /// A name may be followed by a hint.
  fieldLike(name: string): Locator {
    return this.page.getByRole("textbox", { name });
  }

  field(name: string): Locator {
    return this.page.getByRole("textbox", { name, exact: true });
  }

  choice(name: string): Locator {
    return this.page.getByRole("combobox", { name, exact: true });
  }

  slider(name: string): Locator {
    return this.page.getByRole("slider", { name, exact: true });
  }

  get stopButton(): Locator {
    return this.page.getByRole("button", { name: this.texts.stop.button });
  }

  get stopBox(): Locator {
    return this.page.getByRole("region", { name: this.texts.stop.region });
  }

  get stiffnessField(): Locator {
    return this.field(this.texts.force.stiffnessField);
  }

  async tab(name: keyof Strings["tabs"]): Promise<void> {
    await this.page.getByRole("tab", { name: this.texts.tabs[name], exact: true }).click();
  }

  // ---- what a person does

  /// Opens a choice and takes one of it, by the value that stands in a scene's file.
  async choose(name: string, value: string): Promise<void> {
    const box = this.choice(name);
    await box.click();
    await this.page.locator(`[id="${await box.getAttribute("aria-controls")}"] [data-value="${value}"]`).click();
  }

  /// Switches the simulated patient on, or off: the sliders then move the hand.
  async setPatient(on: boolean): Promise<void> {
    await this.tab("touch");
    if ((await this.switch(this.texts.hand.patient).getAttribute("aria-checked")) !== String(on)) await this.switch(this.texts.hand.patient).click();
    const source = on ? HandSource.HAND_PATIENT : HandSource.HAND_SLIDERS;
    await this.untilState(`the source ${HandSource[source]}`, (state) => state.source === source && (on || state.slider.length > 0) && !state.stationGone);
  }

  /// Opens the sliders of single joints.
  async openSingleJoints(): Promise<void> {
    await this.page.getByText(this.texts.hand.single, { exact: true }).click();
  }

  /// Opens the dialog of the user's own object by its card.
  async openOwnObject(): Promise<void> {
    await this.tab("touch");
    await this.page.locator(".card-own").click();
    await this.page.getByRole("dialog", { name: this.texts.object.own }).waitFor();
  }

  async setStiffness(newtonPerMm: number): Promise<void> {
    await this.stiffnessField.fill(String(newtonPerMm));
    await this.stiffnessField.press("Enter");
  }

  // ---- waiting

  /// @throws Error at once where the station is in fault, unless that is what is waited for
  untilState(what: string, is: (state: State) => boolean): Promise<true> {
    return until(
      what,
      () => {
        const { state } = this.stream;
        if (state !== undefined && is(state)) return true as const;
        if (state?.fault) throw new Error(`waited for: ${what}, when a fault came. ${this.brief()}`);
        return false;
      },
      () => this.brief(),
    );
  }

  untilRunning(): Promise<true> {
    return this.untilState("the station runs", (state) => !state.stationGone && state.safety === SafetyState.SAFETY_RUNNING);
  }

  untilStopped(): Promise<true> {
    return this.untilState("the station has stopped", (state) => state.heldStopped && state.safety === SafetyState.SAFETY_STOPPED);
  }

  /// So much later by the station's clock: there is more to see in the plots.
  async untilLater(seconds: number): Promise<void> {
    const begun = this.stream.newest!.time;
    await until(`${seconds} s more`, () => this.stream.newest!.time - begun >= seconds, () => this.brief());
  }

  /// The hand stands still: from step to step no joint moves by a hundredth of a degree.
  async untilAtRest(): Promise<void> {
    await until(
      "a hand at rest",
      async () => {
        const [first, ...later] = await this.stream.next(4);
        return later.every(({ hcpAngle }) => hcpAngle.every((angle, joint) => Math.abs(angle - first!.hcpAngle[joint]!) < kStill));
      },
      () => this.brief(),
    );
  }

  /// A contact with force at full factor.
  untilTouching(newtons = 0.2): Promise<true> {
    return until(
      `a force of ${newtons} N`,
      () => {
        const tick = this.stream.newest;
        return tick !== undefined && tick.contact.some((contact) => contact.touching && contact.force * tick.factor > newtons) && (true as const);
      },
      () => this.brief(),
    );
  }

  /// In a few words, for messages of tests that fail.
  brief(): string {
    const { state, newest } = this.stream;
    if (!state) return "no state has come";
    const contacts = newest?.contact.map((contact) => `${contact.segment}: ${contact.force.toFixed(2)} N`).join(", ") ?? "";
    return (
      `scene ${state.scene}, ${SafetyState[state.safety]}${state.heldStopped ? ", held" : ""}${state.fault ? `, fault ${state.fault.name} (${state.fault.meaning}; tick ${state.fault.tick})` : ""}` +
      `${state.busy ? `, busy: ${state.busy}` : ""}${state.trouble ? `, trouble: ${state.trouble}` : ""}; tick ${newest?.tick}, contacts [${contacts}]; last notice: ${this.stream.notices.at(-1)?.text ?? "none"}`
    );
  }
}
