// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { resolve } from "node:path";
import { beforeEach, describe, expect, it } from "vitest";
import { ToPageSchema, WelcomeSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { sceneCards } from "../../../src/panels/scene_cards";
import { strings } from "../../../src/strings";
import { kProtocol } from "../../../src/wire/connection";
import { fakeApp, kMe, type FakeApp } from "./fake_app";

const words = strings.scene;
const root = resolve(__dirname, "../../../..");
const scene = (name: string, purpose = "exercise", grasp = "") => ({ name, purpose, grasp, meaning: `${name} in one line` });
const shipped = [
  scene("bench_mug_1k", "benchmark"), scene("first_touch", "exercise", "sphere"), scene("grasp_mug", "exercise", "cylinder"), scene("index_ball"),
  scene("my_scene"), scene("open_jar", "exercise", "disk"), scene("pinch_key", "exercise", "lateral"), scene("squeeze_ball", "exercise", "sphere"),
  scene("stability_grasp", "study"), scene("tripod_pen", "exercise", "tripod"),
];
let fake: FakeApp;
let element: HTMLElement;
let own = 0;
const loaded: string[] = [];

beforeEach(() => {
  fake = fakeApp();
  own = 0;
  loaded.length = 0;
  const welcome = create(WelcomeSchema, { protocol: kProtocol, page: kMe, mayOperate: true, scene: shipped });
  fake.store.receive(create(ToPageSchema, { what: { case: "welcome", value: welcome } }));
  Object.assign(fake.app.host, {
    loadScene: (name: string) => {
      loaded.push(name);
      return Promise.resolve({ ok: fake.refuse === "", error: fake.refuse });
    },
  });
  element = sceneCards(fake.app, () => ++own);
});

const state = (name: string, deviceSimulated = true) => fake.state({ operatorPage: kMe, scene: name, deviceSimulated });
const shown = () => [...element.querySelectorAll<HTMLElement>(".card")].filter((card) => !card.hidden);
const texts = () => shown().map((card) => [...card.querySelectorAll("span")].map((span) => span.textContent).filter((text) => text !== "").join(", "));
const more = () => element.querySelector<HTMLButtonElement>("[aria-expanded]")!;

describe("the cards of scenes", () => {
  it("show first what a new user tries, then all exercises, in plain words; no benchmark and no study", () => {
    state("first_touch");
    expect(texts()).toEqual(["First touch, Whole hand", "Therapy ball, Whole hand", "Mug, Whole hand", "Door key, Key grip", "Pen, Three fingers", "Own object, mesh file"]);
    expect(more().textContent).toBe(words.all(8));
    more().click();
    expect(texts().slice(5)).toEqual(["Ball, Index finger", "my scene", "Jar lid, All fingertips", "Own object, mesh file"]);
    more().click();
    expect(shown().length).toBe(6);
    expect(shown().map((card) => card.dataset["optional"])).toEqual(["false", "false", "true", "true", "true", undefined]); // on low screens
  });

  it("mark the current scene, and show it always", () => {
    state("open_jar");
    const pressed = shown().filter((card) => card.getAttribute("aria-pressed") === "true");
    expect(pressed.map((card) => card.querySelector(".card-name")!.textContent)).toEqual(["Jar lid"]);
    expect(shown().length).toBe(6);
  });

  it("offer no scene that is made to shake where a device moves a hand", () => {
    state("grasp_mug", false);
    more().click();
    expect(texts().join()).not.toContain(words.names["first_touch"]);
    state("grasp_mug", true);
    expect(texts().join()).toContain(words.names["first_touch"]);
  });

  it("load a scene at one press, and say why one was refused, in words", async () => {
    state("first_touch");
    shown()[2]!.click();
    await Promise.resolve();
    expect(loaded).toEqual(["grasp_mug"]);
    fake.refuse = "grasp.type = sphere: this hand cannot";
    shown()[3]!.click();
    await new Promise((done) => setTimeout(done));
    expect(element.querySelector(".refused:not([hidden])")!.textContent).toBe("“Type of grasp” = Whole hand around a ball: this hand cannot");
  });

  it("end with the user's own object", () => {
    state("first_touch");
    shown().at(-1)!.click();
    expect(own).toBe(1);
  });
});

it("every exercise that is shipped has a plain name and a picture", () => {
  for (const file of readdirSync(resolve(root, "scenes"))) {
    const text = readFileSync(resolve(root, "scenes", file), "utf8");
    const name = file.replace(".toml", "");
    if (text.includes("\npurpose = ") || name === "wave") continue; // wave touches nothing
    expect(words.names[name], name).toBeTruthy();
    expect(existsSync(resolve(root, "web/src/pictures", `${name}.webp`)), name).toBe(true);
  }
});
