// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { entryCheck, overridesOf, ownForces, prescription, readCourse, readDeleted, readExercises, readPatient, readPatients, readSignedIn, readStatus, readTemplates, readUnreadable } from "../../../src/people/shapes";
import { scoreName, trendTitle } from "../../../src/people/words";

const strange: readonly unknown[] = [null, undefined, 7, "text", [], [[]], { patients: 3 }, { patients: [null, 7] }, { results: {}, tests: "x", notes: [null], trends: [[]] }];

describe("what the station answers", () => {
  it.each(strange)("is read without a failure, whatever it is: %j", (answer) => {
    for (const read of [readStatus, readSignedIn, readPatient, readPatients, readCourse, readExercises, readDeleted]) expect(() => read(answer)).not.toThrow();
    expect(readPatients(answer)).toEqual([]);
    expect(readExercises(answer)).toEqual([]);
  });

  it("needs accounts only if it says so", () => {
    expect(readStatus({ accounts: "yes" }).accounts).toBe(false);
    expect(readStatus({ accounts: true, symbols: ["sun", 3], tests: [{ kind: "grip", unit: "kg", least: 0, most: 100 }, {}] })).toEqual({
      accounts: true, exercises: false, symbols: ["sun"], tests: [{ kind: "grip", unit: "kg", least: 0, most: 100 }],
    });
  });

  it("lists patients by their codes", () => {
    const answer = { patients: [{ record: "b", code: "P09", side: "left", symbol: "sun", obstacles: ["expired"] }, { record: "a", code: "P07" }, { code: "P08" }] };
    expect(readPatients(answer).map(({ code, obstacles }) => [code, ...obstacles])).toEqual([["P07"], ["P09", "expired"]]);
  });

  it("has the nested fields of a patient", () => {
    const patient = readPatient({
      record: "a", entry: { flexion_deg: 40, release_deg: 25, date: "2026-05-04", suitable: true }, own_force_n: [0, 12.5, null],
      prescription: [{ exercise: "press", repetitions_per_day: 20, overrides: { "target.share": "0.3" } }, { note: "none" }],
    });
    expect(entryCheck(patient)).toEqual({ flexion: 40, release: 25, date: "2026-05-04" });
    expect(ownForces(patient)).toEqual([0, 12.5, 0]);
    expect(prescription(patient)).toEqual([{ exercise: "press", repetitions: 20, minutes: 0, note: "" }]);
    expect(overridesOf(patient, "press")).toEqual({ "target.share": "0.3" });
    expect(overridesOf(patient, "other")).toEqual({});
    expect(entryCheck(readPatient({}))).toBeUndefined();
  });

  it("has the newest result first, and a trend from its first to its last value", () => {
    const course = readCourse({
      results: [{ date: 1, exercise: "old" }, { date: 2, exercise: "new", scores: [{ name: "rmse_n", unit: "N", value: 1.5, origin: "measured", invalid: "" }] }],
      tests: [{ date: "2026-05-04", kind: "grip", value: 20 }, { date: "2026-06-01", kind: "grip", value: 24 }],
      trends: [{ title: "Grip", unit: "kg", points: [{ date: 1, value: 20 }, { date: 2, value: 22 }, { date: 3, value: 24 }], proven: true, verdict: "improved" }],
    });
    expect(course.results.map(({ exercise }) => exercise)).toEqual(["new", "old"]);
    expect(course.results[0]!.scores[0]).toEqual({ name: "rmse_n", label: "", unit: "N", value: 1.5, origin: "measured", invalid: "" });
    expect(course.tests.map(({ value }) => value)).toEqual([24, 20]);
    expect(course.trends[0]).toMatchObject({ first: 20, last: 24, count: 3, proven: true });
  });
});

describe("what a deletion or a damaged registry says", () => {
  it("has the files that are left, and counts, whether they are stated as numbers or as lists", () => {
    const answer = { exports_missing: ["/a"], plain_recordings: ["b.mcap"], bound_files: ["c.toml"], encrypted_recordings: 7, exports_removed: ["x", "y"], unreadable_rows: 1 };
    expect(readDeleted(answer)).toEqual({ left: ["/a", "b.mcap", "c.toml"], removed: 2, unreadable: 7, unknown: 1 });
    expect(readDeleted({})).toEqual({ left: [], removed: 0, unreadable: 0, unknown: 0 });
    expect(readUnreadable({ damaged: ["d", 3], without_key: 2 })).toEqual({ damaged: ["d"], withoutKey: 2 });
  });

  it("keeps what a template changes of an exercise", () => {
    const read = readTemplates({ templates: [{ name: "a", title: "A", lines: [{ exercise: "" }, { exercise: "press", repetitions_per_day: 15, overrides: { pain_limit: "3" } }] }, {}] });
    expect(read).toEqual([{ name: "a", title: "A", titleDe: "", lines: [{ exercise: "press", repetitions: 15, minutes: 0, note: "", overrides: { pain_limit: "3" } }] }]);
  });
});

describe("the name of a score", () => {
  it.each([["mean_n", "N", "mean"], ["tam_index_deg", "deg", "tam index"], ["cv", "-", "cv"], ["n", "N", "n"], ["rise_time_s", "s", "rise time"]])(
    "%s in %s is %s",
    (name, unit, words) => expect(scoreName({ name, label: "", unit })).toBe(words),
  );

  it("is the station's own, if it has one, in the language of the page", () => {
    const names = { rmse_n: { en: "error of the force", de: "Fehler der Kraft" } };
    const course = readCourse({ results: [{ date: 1, exercise: "press", scores: [{ name: "rmse_n", unit: "N" }] }], trends: [{ name: "press/rmse_n", unit: "N", points: [{ date: 1, value: 2 }] }], names });
    expect(scoreName(course.results[0]!.scores[0]!)).toBe("error of the force");
    expect(trendTitle(course.trends[0]!, readExercises({ exercises: [{ name: "press", title: "Press and hold" }] }))).toBe("Press and hold: error of the force");
  });
});
