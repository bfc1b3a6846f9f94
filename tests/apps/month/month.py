#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the registry's rows with what NumPy makes of the recordings, from the formulas in docs/exercises.md.

month.py SCORES_PY RESULTS_JSON EXPORTS: RESULTS_JSON has the rows of `phalanx patient results --json`. EXPORTS has a folder for each
recording, with the tables `observations` and `events` of `phalanx session export`. Each exercise of a recording must have one row, and
each row an exercise. All scores of trials and rows are calculated again: they agree to 1e-9 of max(1, |value|), or have no value on both
sides. A row that may not be scored must have no score. It writes what it has counted as JSON; if something differs, it says what, and
exits 1.
"""

import csv
import importlib.util
import json
import math
import pathlib
import sys
import tomllib

import numpy as np

TOLERANCE = 1e-9
DIGITS = ["thumb", "index", "middle", "ring", "little"]
LEAD_IN = 2.0  # of a tracking trial [s]
SWING = 0.5


def require(so, what):
    if not so:
        sys.exit(what)


class Comparison:
    """Counts comparisons, and keeps the largest difference."""

    def __init__(self):
        self.numbers, self.without, self.largest, self.measures = 0, 0, 0.0, {}

    def value(self, place, measure, mine, theirs):
        """mine and theirs: a number, or None where there is no score."""
        require((mine is None) == (theirs is None), f"{place}: {mine} by NumPy, {theirs} in the registry")
        if mine is None:
            self.without += 1
            return
        difference = abs(mine - theirs) / max(1.0, abs(mine))
        require(difference <= TOLERANCE, f"{place}: {mine} by NumPy, {theirs} in the registry")
        self.largest = max(self.largest, difference)
        self.numbers += 1
        self.measures[measure] = self.measures.get(measure, 0) + 1


def columns_of(file):
    """Columns by name, as text. A torn table ends with its last whole line."""
    csv.field_size_limit(1 << 24)
    with open(file, newline="", encoding="utf-8") as lines:
        head, *rows = csv.reader(lines)
    return dict(zip(head, zip(*rows))) if rows else {name: () for name in head}


class Exercise:
    """One exercise of a recording: what it began with, and its steps as a table for scores.py."""

    def __init__(self, scores, begin, columns):
        self.file, self.person = tomllib.loads(begin["file"]), tomllib.loads(begin["person"])
        first = next((i for i, place in enumerate(zip(columns["station"], columns["tick"]))
                      if (int(float(place[0])), int(float(place[1]))) == (begin["station"], begin["tick"])), None)
        require(first is not None, "the first step of an exercise is not in its recording")
        self.table = scores.table_of({name: cells[first:] for name, cells in columns.items()})
        self.times = np.array(self.table["time_s"], dtype=float)
        self.place = {t: i for i, t in enumerate(self.times)}

    @property
    def measure(self):
        return self.file["measure"]

    @property
    def digits(self):
        return self.file["digits"].split() if "digits" in self.file else DIGITS

    def rows(self, trial):
        require(trial["begin_s"] in self.place and trial["end_s"] in self.place, "a trial's begin or end is no step")
        return self.place[trial["begin_s"]], self.place[trial["end_s"]]

    def task(self, scores, trial):
        """The task of scores.py, and what its scores' names begin with."""
        first, last = self.rows(trial)
        digits = self.digits
        task = {"measure": self.measure, "first": first, "last": last, "digits": digits,
                "felt": self.person["felt"].split(), "calibration_independent": self.person["calibration_independent"],
                "joints": [joint for digit in digits for joint in scores.joints_of(digit)]}
        turn = trial.get("condition", "").split()[-1:]
        if self.measure in ("press_and_hold", "force_tracking"):
            task |= {"target": trial["target"], "tolerance": trial["tolerance"]}
        if self.measure == "force_tracking":
            t = self.times[first:last + 1] - self.times[first]
            task["first"] = first + int(np.nonzero(t >= LEAD_IN)[0][0])
            t = t[task["first"] - first:]
            task["target"] = trial["target"] * (1 + SWING * np.sin(2 * np.pi * trial["rate_hz"] * (t - LEAD_IN)))
            task["longest_lag"] = min(1.0, 0.45 / trial["rate_hz"])
        elif self.measure == "squeeze_release":
            task["release_cue"] = self.file["trial_s"] / 2
        elif self.measure == "own_force":
            task |= {"measure": "squeeze_release", "digits": turn}
        elif self.measure == "pinch":
            task["finger"] = turn[0]
        elif self.measure == "opposition":
            task["digits"] = turn
        elif self.measure == "independence":
            task |= {"measure": "motion_independence", "instructed": turn[0]}
        elif self.measure == "smoothness":
            task["digit"] = turn[0]
        return task, f"{turn[0]}_" if turn and self.measure != "opposition" else ""

    def trial_scores(self, scores, trial):
        """Scores by name; None: there is none."""
        if self.measure == "entry_check":
            return self.entry_scores(scores, trial)
        task, prefix = self.task(scores, trial)
        found = {prefix + name: value for name, value, _, _ in scores.scores_of(self.table, task)}
        if self.measure == "pinch":
            band = {"measure": "press_and_hold", "digits": ["thumb", task["finger"]], "target": trial["target"],
                    "tolerance": trial["tolerance"]}
            slipped = found[prefix + "hold_time_s"] is None
            for name, value, _, _ in scores.scores_of(self.table, task | band):
                if name.startswith("time_in_target"):
                    found[prefix + name] = None if slipped else value
            if not self.person["detects_slips"]:
                found = dict.fromkeys(found)
        return found

    def entry_scores(self, scores, trial):
        first, last = self.rows(trial)
        steps, found = scores.Steps(self.table, first, last), {}
        steps.check()
        for digit in [digit for digit in self.digits if digit in self.person["felt"].split()]:
            joints = [joint for joint in scores.flexion_joints(digit)
                      if all(origin == "measured" for origin in steps.column[f"origin_{joint}"])]
            value = {"flexion": None, "release": None}
            if joints and self.person["calibration_independent"]:
                bent = steps.angles(joints).sum(axis=0)
                peak = int(np.argmax(bent))
                value = {"flexion": bent[peak] - bent[:peak + 1].min(), "release": bent[peak] - bent[peak:].min()}
            for name, angle in value.items():
                found[f"entry_{name}_{digit}_deg"] = None if angle is None else float(np.degrees(angle))
        return found

    def success(self, trial, found):
        """Whether a trial of a training succeeds; None: it does not count."""
        rule = self.file.get("success")
        if rule is None:
            return None
        turn = trial.get("condition", "").split()[-1:]
        names = [rule["score"]] + [name for digit in turn for name in
                                   (f"{digit}_{rule['score']}", rule["score"].replace("_", f"_{digit}_", 1))]
        value = next(found[name] for name in names if name in found)
        bound = self.spanned("success", trial, rule.get("at_most", rule.get("at_least")))
        return None if value is None else value <= bound if "at_most" in rule else value >= bound

    def spanned(self, key, trial, otherwise):
        span = self.file.get("difficulty", {}).get(key)
        return otherwise if span is None else span[0] + trial["difficulty"] * (span[1] - span[0])


def normal(x):
    return 0.5 * math.erfc(-x / math.sqrt(2))


def threshold(trials):
    """Feel and find: the posterior of ln theta from the sent stiffnesses and the answers."""
    low, high, cells = math.log(0.01), math.log(2.5), 120
    width = (high - low) / cells
    x = low + width * (np.arange(cells) + 0.5)
    bounds = [math.log(math.log1p(w)) for w in (0.05, 0.8)]
    posterior = np.exp(-0.5 * (np.maximum(0, np.maximum(bounds[0] - x, x - bounds[1])) / 0.6) ** 2)
    right = 0
    for trial in trials:
        value = {score["name"]: score.get("value") for score in trial["scores"]}
        r = math.log(value["sent_second_n_per_mm"] / value["sent_first_n_per_mm"])
        first = np.array([0.025 + 0.95 * normal(r / theta) for theta in np.exp(x)])
        softer = int(value["answer"])
        posterior *= first if softer == 1 else 1 - first
        posterior /= posterior.sum()
        right += (softer == 1) == (r > 0)
    w = np.expm1(np.exp(x))
    posterior /= posterior.sum()

    def quantile(share):
        below = np.concatenate(([0.0], np.cumsum(posterior)))
        i = int(np.nonzero(below[1:] >= share)[0][0])
        return 100 * math.expm1(math.exp(x[i] + width * ((share - below[i]) / posterior[i] - 0.5)))
    return {"stiffness_threshold_percent": 100 * np.sum(posterior / np.sqrt(w)) ** -2.0,
            "stiffness_threshold_low_percent": quantile(0.028), "stiffness_threshold_high_percent": quantile(0.972),
            "stiffness_right_percent": 100 * right / len(trials)}


def at_least(k, n, p):
    return sum(math.comb(n, i) * p ** i * (1 - p) ** (n - i) for i in range(k, n + 1))


def identified(trials):
    """Object in the hand: counts of answers, and the exact interval."""
    counts, n = {}, len(trials)
    for trial in trials:
        answer = next(score["value"] for score in trial["scores"] if score["name"] == "answer")
        counts[trial["condition"], answer] = counts.get((trial["condition"], answer), 0) + 1
    right = sum(next(score["value"] for score in trial["scores"] if score["name"] == "right") for trial in trials)
    shown = {s: sum(c for (a, _), c in counts.items() if a == s) for s, _ in counts}
    answered = {r: sum(c for (_, a), c in counts.items() if a == r) for _, r in counts}
    plain = max(0.0, sum(c / n * math.log2(c * n / (shown[s] * answered[r])) for (s, r), c in counts.items()))

    def zero(rises):
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if rises(middle) < 0 else (low, middle)
        return (low + high) / 2
    right = int(right)
    return {"identified_percent": 100 * right / n,
            "identified_low_percent": 100 * (0.0 if right == 0 else zero(lambda p: at_least(right, n, p) - 0.025)),
            "identified_high_percent":
                100 * (1.0 if right == n else 1 - zero(lambda q: at_least(n - right, n, q) - 0.025)),
            "transmitted_plain_bit": plain,
            "transmitted_bit": max(0.0, plain - (len(shown) - 1) * (len(answered) - 1) / (2 * n * math.log(2)))}


def value_of(score):
    return score.get("value")


def compare_trials(scores, exercise, result, row, comparison):
    """Calculates the trials again. Returns the values of the whole exercise by name."""
    values, successes, counted = {}, 0, 0
    for trial in result["trials"]:
        place = f"{row['recording']}, {row['exercise']}, trial {trial['number']}"
        if trial.get("invalid"):
            require("success" not in trial, f"{place}: an invalid trial is judged")
            continue
        require("tolerance" not in trial or
                abs(exercise.spanned("tolerance", trial, exercise.file.get("tolerance")) - trial["tolerance"]) < 1e-12,
                f"{place}: its tolerance is not that of its difficulty")
        found = exercise.trial_scores(scores, trial)
        require(set(found) == {score["name"] for score in trial["scores"]}, f"{place}: other scores")
        for score in trial["scores"]:
            comparison.value(f"{place}, {score['name']}", exercise.measure, found[score["name"]], value_of(score))
            if found[score["name"]] is not None:
                values.setdefault(score["name"], []).append(found[score["name"]])
        success = exercise.success(trial, found)
        require(success is None or success == trial["success"], f"{place}: success {trial.get('success')}")
        counted += success is not None
        successes += success is True
    if result["kind"] == "training":
        require((successes, counted) == (result["successes"], result["counted"]) == (row["successes"], result["counted"]),
                f"{row['recording']}: {successes} successes of {counted} by NumPy")
    return {name: sum(each) / len(each) for name, each in values.items()}


def compare_row(scores, row, exercise, comparison):
    result = json.loads(row["detail"])
    place = f"{row['recording']}, {row['exercise']}"
    require(row["exercise"] == result["name"] == exercise.file["name"], f"{place}: another exercise")
    require(row["interrupted"] == result["interrupted"] and row["repetitions"] == result["repetitions"] and
            row["seconds"] == result["seconds"], f"{place}: row and result differ")
    if not row["valid"]:
        scored = [score["name"] for score in row["scores"] if "value" in score]
        require(not scored and row["invalid"], f"{place}: may not be scored, and has {scored}")
        return 0
    counted = [trial for trial in result["trials"] if not trial.get("invalid")]
    if exercise.measure in ("feel_and_find", "object_in_hand"):
        found = {} if not counted else threshold(counted) if exercise.measure == "feel_and_find" else identified(counted)
        found = {score["name"]: found.get(score["name"]) if "value" in score else None for score in row["scores"]}
    else:
        found = compare_trials(scores, exercise, result, row, comparison)
    for score in row["scores"]:
        comparison.value(f"{place}, {score['name']}", exercise.measure, found.get(score["name"]), value_of(score))
    return len(counted)


def main(scores_file, results_file, exports):
    spec = importlib.util.spec_from_file_location("scores", scores_file)
    scores = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(scores)
    rows = {}
    for row in json.loads(pathlib.Path(results_file).read_text(encoding="utf-8")):
        key = row["recording"], row["number"]
        require(key not in rows, f"{key}: doubled")
        rows[key] = row
    comparison, trials, valid, folders = Comparison(), 0, 0, sorted(pathlib.Path(exports).iterdir())
    left = dict(rows)
    for folder in folders:
        events = columns_of(folder / "events.csv")
        begins = [json.loads(text) for code, text in zip(events["code"], events["text"]) if code == "exercise_begin"]
        columns = columns_of(folder / "observations.csv") if begins else {}
        for begin in begins:
            row = left.pop((folder.name, begin["exercise"]), None)
            require(row is not None, f"{folder.name}, exercise {begin['exercise']}: lost")
            trials += compare_row(scores, row, Exercise(scores, begin, columns), comparison)
            valid += row["valid"]
    require(not left, f"rows without an exercise: {sorted(left)}")
    print(json.dumps({"recordings": len(folders), "rows": len(rows), "valid": valid, "trials": trials,
                      "numbers": comparison.numbers, "without": comparison.without, "largest": comparison.largest,
                      "measures": comparison.measures}))


if __name__ == "__main__":
    main(*sys.argv[1:])
