// SPDX-License-Identifier: Apache-2.0
// An operator and two viewers: who may do what, who is told, and what a reload changes: nothing.
import { beforeAll, describe, expect, it } from "vitest";
import { strings } from "../../src/strings";
import { stiffnessKey, valueOf } from "./support/settings";
import type { CockpitPage } from "./support/cockpit_page";
import { stage, unseen, type Station } from "./support/stage";
import { until } from "./support/until";

const play = stage();
let station: Station;
let anna: CockpitPage;
let bert: CockpitPage;
let cleo: CockpitPage;

beforeAll(async () => {
  station = await play.station();
  anna = await play.open(station.url, unseen);
  bert = await play.open(station.url, unseen);
  cleo = await play.open(station.url, unseen);
  await anna.untilRunning();
});

const controls = (cockpit: CockpitPage) => [
  cockpit.stiffnessField, cockpit.slider(strings.force.stiffness), cockpit.switch(strings.calm.smoothing), cockpit.choice(strings.hand.side),
  cockpit.switch(strings.hand.patient),
];

async function untilMayOperate(cockpit: CockpitPage, may: boolean): Promise<void> {
  for (const control of controls(cockpit)) {
    await until(`${String(control)} is ${may ? "on" : "off"}`, async () => (await control.isEnabled()) === may, () => cockpit.brief());
  }
}

/// Takes control as a person does: asks, confirms.
async function takeControl(cockpit: CockpitPage): Promise<string> {
  await cockpit.button(strings.role.take).first().click();
  const dialog = cockpit.page.getByRole("dialog", { name: strings.role.confirmTitle });
  const text = await dialog.innerText();
  await dialog.getByRole("button", { name: strings.role.confirm, exact: true }).click();
  return text;
}

async function sayName(cockpit: CockpitPage, name: string): Promise<void> {
  await cockpit.tab("people");
  await cockpit.fieldLike(strings.people.name).fill(name);
  await cockpit.button(strings.people.save).click();
  await cockpit.tab("touch");
}

async function untilTold(cockpit: CockpitPage, code: string, ...words: string[]): Promise<void> {
  await until(
    `a notice ${code} with ${words.join(", ")}`,
    () => cockpit.stream.notices.some((notice) => notice.code === code && words.every((word) => `${notice.who} ${notice.text}`.includes(word))),
    () => cockpit.stream.notices.map((notice) => `${notice.code}: ${notice.who}: ${notice.text}`).join("\n"),
  );
}

describe("roles", () => {
  it("gives the first page control, and tells the others why they have none", async () => {
    await untilMayOperate(anna, true);
    for (const viewer of [bert, cleo]) {
      await untilMayOperate(viewer, false);
      const why = viewer.page.getByText(strings.role.other(strings.page(await anna.number())));
      await until("who has control is said", () => why.isVisible(), () => viewer.page.locator(".role-strip").innerText());
      expect(await viewer.stopButton.isEnabled()).toBe(true);
    }
    await anna.untilState("three pages", (state) => state.pages === 3);
  });

  it("calls people by their names", async () => {
    await sayName(anna, "Anna");
    await sayName(bert, "Bert");
    const label = `Anna (${strings.page(await anna.number())})`;
    await until(`Cleo reads that ${label} has control`, async () => cleo.page.getByText(strings.role.other(label)).isVisible(), async () => cleo.page.locator(".role-strip").innerText());
  });

  it("tells everybody what the operator changes", async () => {
    await anna.setStiffness(0.7);
    for (const page of [anna, bert, cleo]) {
      await untilTold(page, "set", "Anna", stiffnessKey, "0.7"); // as sent
      await until("the number in the field", async () => (await page.stiffnessField.inputValue()) === "0.7");
    }
    await cleo.tab("people");
    expect(await cleo.page.getByRole("listitem").filter({ hasText: strings.settings.labels[stiffnessKey]! }).filter({ hasText: "Anna" }).count()).toBeGreaterThan(0);
    await cleo.tab("touch");
  });

  it("refuses what a viewer sends past the page's own controls", async () => {
    // As with the developer tools of a browser: the fieldset is enabled by hand. In one step, since the next state disables it again.
    await bert.stiffnessField.evaluate((field: HTMLInputElement) => {
      field.closest("fieldset")!.disabled = false;
      field.value = "3";
      field.dispatchEvent(new Event("change", { bubbles: true }));
    });
    await until("the host's refusal beside the control", async () => (await bert.page.getByRole("alert").filter({ hasText: /control|operat/i }).count()) > 0, () => bert.brief());
    await anna.stream.next(20);
    expect(anna.stream.newest!.stiffness).toBeLessThan(1000);
    expect(Number(valueOf(anna.stream.state!, stiffnessKey))).toBeCloseTo(0.7, 12);
  });

  it("lets another page take control, openly", async () => {
    const asked = await takeControl(bert);
    expect(asked).toContain("Anna");
    await untilMayOperate(bert, true);
    await untilMayOperate(anna, false);
    for (const page of [anna, bert, cleo]) await untilTold(page, "operator_taken", "Anna", "Bert");
    await bert.setStiffness(0.9);
    await untilTold(anna, "set", "Bert", stiffnessKey, "0.9");
  });

  it("lets the operator give it back, and anybody take it then", async () => {
    await bert.tab("people");
    await bert.button(strings.role.release).click();
    await bert.tab("touch");
    await untilMayOperate(bert, false);
    await until("Cleo reads that nobody has control", async () => cleo.page.getByText(strings.role.nobody).isVisible(), () => cleo.brief());
    await takeControl(cleo);
    await untilMayOperate(cleo, true);
    for (const page of [anna, bert]) await untilMayOperate(page, false);
  });

  it("keeps the role, the number and the stream of a page that reloads in mid-session", async () => {
    const number = await cleo.number();
    const before = cleo.stream.newest!.tick;
    await cleo.page.reload();
    await cleo.ready();
    await untilMayOperate(cleo, true);
    expect(await cleo.number()).toBe(number);
    expect(cleo.stream.newest!.tick, "the station began anew").toBeGreaterThan(before);
    expect(cleo.stream.newest!.stiffness).toBeCloseTo(900, 2);
    const history = () => cleo.page.evaluate(() => window.phalanx.history());
    await until("the history begins", async () => (await history()).samples > 0);
    const { end } = await history(); // not the number of samples: the history may be full
    await until("the history goes on", async () => (await history()).end > end + 0.5);
    expect(cleo.stream.notices.some((notice) => notice.code === "set" && notice.who.includes("Bert") && notice.text.includes("0.9")), "what happened before the reload").toBe(true);
    await anna.untilState("the same operator, and three pages", (state) => state.operatorPage === number && state.pages === 3);
  });
});
