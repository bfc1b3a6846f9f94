#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Calculates the scores of trials with NumPy, from the formulas in docs/exercises.md, section "Scores".

scores.py TABLE TRIALS [TABLE TRIALS ...]: for each table of observed steps (observations.csv of `phalanx session export`) a list of
trials (JSON). Each trial is an object:
  measure                            range_of_motion, total_active_motion, press_and_hold, force_tracking, squeeze_release, pinch,
                                     opposition, motion_independence or smoothness
  first, last                        rows of the trial, counted from 0, both included; without them, all rows
  digits, felt, joints               lists of names
  finger, digit, instructed          a name
  target, tolerance, settle_time, longest_lag, least_peak, release_cue, least_force, hold_time, least_range, least_speed,
  calibration_independent            parameters in SI units, as in docs/exercises.md; target of force_tracking: a list
Writes CSV: table, trial (both counted from 0), score, value, origin, reason. Either the value or the reason is empty.
"""

import csv
import json
import sys

import numpy as np

DIGITS = ["thumb", "index", "middle", "ring", "little"]
RATE = 100.0
LEAST_SAMPLE_RATE = 20.0
ORIGINS = ["unknown", "measured", "completed", "fixed", "scripted"]


def resampled(time, x):
    points = int(np.floor(RATE * (time[-1] - time[0]) + 1e-9)) + 1
    return np.interp(time[0] + np.arange(points) / RATE, time, x)


class Invalid(Exception):
    """There is no score; the text says why."""


def joints_of(digit):
    """All joints of a digit: flexion, abduction, two hinges."""
    if digit == "thumb":
        return ["thumb_cmc_flexion", "thumb_cmc_abduction", "thumb_mcp_flexion", "thumb_ip_flexion"]
    return [f"{digit}_{joint}" for joint in ("mcp_flexion", "mcp_abduction", "pip_flexion", "dip_flexion")]


def flexion_joints(digit):
    return [name for name in joints_of(digit) if "abduction" not in name and "cmc" not in name]


class Steps:
    """The steps of a trial, as columns."""

    def __init__(self, table, first, last):
        self.column = {name: cells[first:last + 1] for name, cells in table.items()}
        self.t = self.numbers("time_s")

    def numbers(self, name):
        return np.array([float(cell) if cell else np.nan for cell in self.column[name]])

    def flags(self, name):
        return np.array([float(cell) == 1 for cell in self.column[name]])

    def check(self):
        if len(self.t) < 2:
            raise Invalid("fewer than two steps")
        if any(self.column["fault"]):
            raise Invalid("a step has a fault")
        if not np.all(np.isfinite(self.t)) or np.any(np.diff(self.t) <= 0):
            raise Invalid("time does not increase")
        if self.t[-1] - self.t[0] > 3600:
            raise Invalid("too long")

    def weights(self):
        return np.append(np.diff(self.t), 0.0)

    def angles(self, joints):
        """The angles of joints that are measured, one row each [rad]."""
        for joint in joints:
            if any(origin != "measured" for origin in self.column[f"origin_{joint}"]):
                raise Invalid(f"{joint} is not measured")
        angles = np.array([self.numbers(f"angle_{joint}_rad") for joint in joints])
        if not np.all(np.isfinite(angles)):
            raise Invalid("an angle is not finite")
        return angles

    def flexion(self, digit):
        return self.angles(flexion_joints(digit)).sum(axis=0)

    def pad(self, digit):
        pad = np.array([self.numbers(f"pad_{digit}_{axis}_m") for axis in "xyz"])
        if not np.all(np.isfinite(pad)):
            raise Invalid("a pad is not finite")
        return pad

    def resampled(self, x):
        return resampled(self.t, x)

    def sampled(self, x):
        """x at 100 Hz, interpolated between the device's samples."""
        time = self.numbers("sample_time_s")
        if not np.all(np.isfinite(time)) or np.any(np.diff(time) < 0):
            raise Invalid("times of the samples are not known or go back")
        new = np.concatenate(([True], np.diff(time) > 0))
        time = time[new]
        if len(time) < 2 or len(time) - 1 < LEAST_SAMPLE_RATE * (time[-1] - time[0]):
            raise Invalid("too few samples a second")
        return resampled(time, x[new])

    def sensed(self, digits):
        return all(np.all(~np.isnan(self.numbers(f"measured_force_{digit}_n"))) for digit in digits)

    def forces(self, digits, felt):
        """The forces of digits by name [N]."""
        for digit in digits:
            if digit not in felt:
                raise Invalid(f"{digit} is not felt")
        if not np.all(self.flags("torque_on")) or not np.all(self.numbers("factor") >= 1):
            raise Invalid("torques are off or ramped")
        for digit in digits:
            missing = np.isnan(self.numbers(f"measured_force_{digit}_n"))
            if np.any(missing) and not np.all(missing):
                raise Invalid("a sensor has values in a part of the steps")
        kind = "measured_force" if self.sensed(digits) else "force"
        forces = {digit: self.numbers(f"{kind}_{digit}_n") for digit in digits}
        if not all(np.all(np.isfinite(force)) for force in forces.values()):
            raise Invalid("a force is not finite")
        return forces


def mean(w, x):
    return np.sum(w * x) / np.sum(w)


def held(t, x, hold, inner, outer):
    """The outer extreme over windows [t_i, t_i + hold] of the inner extreme within each."""
    last = np.searchsorted(t, t + hold, side="right")
    values = [inner(x[i:last[i]]) for i in range(len(t)) if t[i] + hold <= t[-1]]
    if not values:
        raise Invalid("shorter than the hold")
    return outer(values)


def rise_time(t, force, level):
    high = np.nonzero(force >= 0.9 * level)[0]
    if len(high) == 0:
        raise Invalid("never reached 90 %")
    b = high[0]
    below = np.nonzero(force[:b + 1] < 0.1 * level)[0]
    if len(below) == 0:
        raise Invalid("was there before the trial")
    return t[b] - t[below[-1] + 1]


def independent(trial):
    if not trial.get("calibration_independent", False):
        raise Invalid("the calibration depends on the person's reach")


def range_of_motion(steps, trial, put):
    for joint in trial["joints"]:
        with put.group(f"rom_{joint}_deg", f"max_{joint}_deg", f"min_{joint}_deg") as group:
            steps.check()
            independent(trial)
            angle = np.degrees(steps.angles([joint])[0])
            hold = trial.get("hold_time", 0.1)
            high = held(steps.t, angle, hold, np.min, np.max)
            low = held(steps.t, angle, hold, np.max, np.min)
            group.values(high - low, high, low)


def total_active_motion(steps, trial, put):
    for digit in trial["digits"]:
        with put.group(f"tam_{digit}_deg", f"flexion_{digit}_deg", f"deficit_{digit}_deg") as group:
            steps.check()
            independent(trial)
            angles = np.degrees(steps.angles(flexion_joints(digit)))
            hold = trial.get("hold_time", 0.1)
            fist = held(steps.t, angles.sum(axis=0), hold, np.min, np.max)
            deficit = held(steps.t, np.maximum(angles, 0).sum(axis=0), hold, np.max, np.min)
            group.values(fist - deficit, fist, deficit)


def press_and_hold(steps, trial, put):
    target, delta = trial["target"], trial.get("tolerance", 0.1)
    with put.group("mean_force_n", "sd_force_n", "cv", "time_in_target_s", "time_in_target_share", "rise_time_s") as group:
        steps.check()
        force = sum(steps.forces(trial["digits"], trial["felt"]).values())
        counts = np.nonzero(steps.t - steps.t[0] >= trial.get("settle_time", 1.0))[0]
        if len(counts) < 2:
            raise Invalid("shorter than the time to settle")
        w, f = steps.weights()[counts], force[counts]
        average = mean(w, f)
        sd = np.sqrt(mean(w, (f - average) ** 2))
        inside = np.sum(w[np.abs(f - target) <= delta * target])
        group.one("mean_force_n", lambda: average)
        group.one("sd_force_n", lambda: sd)
        group.one("cv", lambda: ratio(sd, average))
        group.one("time_in_target_s", lambda: inside)
        group.one("time_in_target_share", lambda: inside / np.sum(w))
        group.one("rise_time_s", lambda: rise_time(steps.t, force, target))


def ratio(a, b):
    if not b > 0:
        raise Invalid("the mean is not above 0")
    return a / b


def correlation(a, b):
    a, b = a - a.mean(), b - b.mean()
    product = np.dot(a, a) * np.dot(b, b)
    return 0.0 if product <= 1e-24 else np.dot(a, b) / np.sqrt(product)


def find_lag(force, target, longest):
    """The lag [s] and the correlation there."""
    most = int(np.floor(RATE * longest + 1e-9))
    if len(force) - 1 < 2 * most:
        raise Invalid("shorter than twice the longest lag")
    if np.ptp(force) < 1e-6 or np.ptp(target) < 1e-6:
        raise Invalid("constant")
    n = len(force)
    r = {lag: correlation(force[max(lag, 0):n + min(lag, 0)], target[max(-lag, 0):n - max(lag, 0)])
         for lag in range(-most, most + 1)}
    best = max(r.values())
    lag = next(l for l in sorted(r, key=lambda l: (abs(l), l < 0)) if r[l] >= best - 1e-9)
    part = 0.0
    if abs(lag) < most:
        c = r[lag - 1] - 2 * r[lag] + r[lag + 1]
        if c < -1e-6:
            part = np.clip((r[lag - 1] - r[lag + 1]) / (2 * c), -0.5, 0.5)
    return (lag + part) / RATE, r[lag]


def force_tracking(steps, trial, put):
    with put.group("rmse_n", "rrmse", "time_in_target_s", "time_in_target_share", "lag_s", "correlation") as group:
        steps.check()
        force = sum(steps.forces(trial["digits"], trial["felt"]).values())
        target = np.array(trial["target"])
        w, largest = steps.weights(), target.max()
        if largest <= 0:
            raise Invalid("no target")
        error = np.sqrt(mean(w, (force - target) ** 2))
        inside = np.sum(w[np.abs(force - target) <= trial.get("tolerance", 0.1) * largest])
        group.one("rmse_n", lambda: error)
        group.one("rrmse", lambda: error / largest)
        group.one("time_in_target_s", lambda: inside)
        group.one("time_in_target_share", lambda: inside / np.sum(w))

        def lag():
            return find_lag(steps.resampled(force), steps.resampled(target), trial.get("longest_lag", 1.0))
        group.one("lag_s", lambda: lag()[0])
        group.one("correlation", lambda: lag()[1])


def squeeze_release(steps, trial, put):
    names = ["peak_force_n", "rise_time_s", "release_time_s"] + (["release_delay_s"] if "release_cue" in trial else [])
    with put.group(*names) as group:
        steps.check()
        t = steps.t
        force = sum(steps.forces(trial["digits"], trial["felt"]).values())
        peak = force.max()
        group.one("peak_force_n", lambda: peak)

        def strong():
            if peak < trial.get("least_peak", 0.5):
                raise Invalid("too weak")

        def release():
            strong()
            c = np.nonzero(force >= 0.9 * peak)[0][-1] + 1
            low = np.nonzero(force[c:] < 0.1 * peak)[0]
            if len(low) == 0:
                raise Invalid("not let go")
            return t[c], t[c + low[0]]

        def rise():
            strong()
            return rise_time(t, force, peak)

        def delay():
            seconds = release()[1] - t[0] - trial["release_cue"]
            if seconds < 0:
                raise Invalid("before the cue")
            return seconds
        group.one("rise_time_s", rise)
        group.one("release_time_s", lambda: release()[1] - release()[0])
        if "release_cue" in trial:
            group.one("release_delay_s", delay)


def pinch(steps, trial, put):
    finger, least = trial["finger"], trial.get("least_force", 0.2)
    with put.group("hold_time_s", "grip_force_n", "force_ratio", "slips") as group:
        steps.check()
        forces = steps.forces(["thumb", finger], trial["felt"])
        if any(np.any(steps.flags(f"slips_{digit}") & (force >= least)) for digit, force in forces.items()):
            raise Invalid("slipped")
        holds = np.ones(len(steps.t), dtype=bool)
        for digit, force in forces.items():
            holds &= steps.flags(f"touching_{digit}") & (force >= least)
        edges = np.flatnonzero(np.diff(np.concatenate(([0], holds.astype(int), [0]))))
        seconds, first, end = 0.0, 0, 0
        for begin, stop in zip(edges[::2], edges[1::2]):
            duration = steps.t[min(stop, len(holds) - 1)] - steps.t[begin]
            if duration > seconds:
                seconds, first, end = duration, begin, stop
        w = steps.weights()[first:end]
        thumb, other = forces["thumb"][first:end], forces[finger][first:end]

        def during(value):
            if seconds == 0:
                raise Invalid("never held")
            return value()
        group.one("hold_time_s", lambda: seconds)
        group.one("grip_force_n", lambda: during(lambda: mean(w, np.minimum(thumb, other))))
        group.one("force_ratio", lambda: during(lambda: mean(w, other) / mean(w, thumb)))
        group.one("slips", lambda: 0.0)


def opposition(steps, trial, put):
    for finger in trial["digits"]:
        with put.group(f"opposition_{finger}_mm", f"opposition_held_{finger}_mm") as group:
            steps.check()
            independent(trial)
            steps.angles(joints_of("thumb") + joints_of(finger))
            distance = 1000 * np.linalg.norm(steps.pad("thumb") - steps.pad(finger), axis=0)
            group.one(f"opposition_{finger}_mm", distance.min)
            group.one(f"opposition_held_{finger}_mm", lambda: held(steps.t, distance, trial.get("hold_time", 1.0), np.max, np.min))


def motion_independence(steps, trial, put):
    leading = trial["instructed"]
    others = [digit for digit in DIGITS if digit in trial["digits"] and digit != leading]
    with put.group("instructed_range_deg", *[f"enslaving_{digit}" for digit in others], "individuation_index") as group:
        steps.check()
        independent(trial)
        phi = steps.flexion(leading)
        group.one("instructed_range_deg", lambda: np.degrees(np.ptp(phi)))
        if np.ptp(phi) < trial.get("least_range", np.radians(10)):
            raise Invalid("moved too little")
        w = steps.weights()

        def slope(digit):
            other = steps.flexion(digit)
            a, b = phi - mean(w, phi), other - mean(w, other)
            return np.sum(w * a * b) / np.sum(w * a * a)
        for digit in others:
            group.one(f"enslaving_{digit}", lambda digit=digit: np.ptp(steps.flexion(digit)) / np.ptp(phi))
        group.one("individuation_index",
                  lambda: 1 - (1 + sum(abs(slope(digit)) for digit in others) - 1) / (len(others) + 1 - 1))


def sparc(speed, rate):
    points = 2 ** (int(np.ceil(np.log2(len(speed)))) + 4)
    spectrum = np.abs(np.fft.fft(speed, points))
    spectrum = spectrum / spectrum.max()
    spectrum = spectrum[np.arange(points) * rate / points <= 10.0]
    counts = np.nonzero(spectrum >= 0.05)[0]
    arc = spectrum[counts[0]:counts[-1] + 1]
    return -np.sum(np.sqrt((1 / (len(arc) - 1)) ** 2 + np.diff(arc) ** 2))


def smoothness(steps, trial, put):
    with put.group("sparc", "movement_time_s", "peak_speed_deg_per_s", "speed_peaks") as group:
        steps.check()
        path = steps.sampled(steps.flexion(trial["digit"]))
        if len(path) < 4:
            raise Invalid("too short")
        v = RATE * np.abs(np.concatenate((path[1:2] - path[:1], (path[2:] - path[:-2]) / 2, path[-1:] - path[-2:-1])))
        peak = v.max()
        if peak < trial.get("least_speed", 0.1):
            raise Invalid("too slow")
        moves = np.nonzero(v >= 0.05 * peak)[0]
        v = v[moves[0]:moves[-1] + 1]
        if len(v) < 4:
            raise Invalid("too short")

        def peak_speed():
            independent(trial)
            return np.degrees(peak)
        group.one("sparc", lambda: sparc(v, RATE))
        group.one("movement_time_s", lambda: (len(v) - 1) / RATE)
        group.one("peak_speed_deg_per_s", peak_speed)
        group.one("speed_peaks", lambda: speed_peaks(v, 0.1 * peak))


def speed_peaks(v, change):
    """Maxima before which v rose by `change` and after which it fell by it; begin and end count as rise and fall."""
    peaks, i, n = 0, 0, len(v)
    while i < n:
        # From i on v rises: its next maximum ends where v has fallen by more than `change` below the largest value since.
        top = np.maximum.accumulate(v[i:])
        falls = np.nonzero(v[i:] < top - change)[0]
        peaks += 1
        if len(falls) == 0:
            break
        i += falls[0]
        bottom = np.minimum.accumulate(v[i:])
        rises = np.nonzero(v[i:] > bottom + change)[0]
        if len(rises) == 0:
            break
        i += rises[0]
    return peaks


class Group:
    """Scores that one error makes invalid together."""

    def __init__(self, names, put):
        self.names, self.put, self.done = list(names), put, {}

    def __enter__(self):
        return self

    def one(self, name, calculate):
        try:
            self.done[name] = (float(calculate()), "")
        except Invalid as why:
            self.done[name] = (None, str(why))

    def values(self, *values):
        self.done = {name: (float(value), "") for name, value in zip(self.names, values)}

    def __exit__(self, kind, error, trace):
        if error is not None and kind is not Invalid:
            return False
        for name in self.names:
            self.put.score(name, *self.done.get(name, (None, str(error))))
        return True


class Put:
    """Collects the scores of one trial."""

    def __init__(self, origin):
        self.origin, self.scores = origin, []

    def group(self, *names):
        return Group(names, self)

    def score(self, name, value, why):
        self.scores.append((name, value, self.origin, why))


def origin_of(steps, trial):
    measure = trial["measure"]
    if measure == "pinch":
        digits = ["thumb", trial["finger"]]
    elif measure in ("press_and_hold", "force_tracking", "squeeze_release"):
        digits = trial["digits"]
    else:
        return "measured"
    return "measured" if steps.sensed(digits) else "rendered"


MEASURES = {measure.__name__: measure for measure in (
    range_of_motion, total_active_motion, press_and_hold, force_tracking, squeeze_release, pinch, opposition,
    motion_independence, smoothness)}


def short_name(name):
    """The name here of a column of the export: with its unit last."""
    for kind, unit in (("angle", "rad"), ("pad", "m"), ("force", "n"), ("measured_force", "n")):
        if name.startswith(f"{kind}_{unit}_"):
            return f"{kind}_{name[len(kind) + len(unit) + 2:]}_{unit}"
    return name.replace("angle_origin_", "origin_")


def table_of(columns):
    """The table of the scores from the columns of the export, which begin at an exercise's first step."""
    table = {short_name(name): cells for name, cells in columns.items()}
    time = np.array(table["host_time_s"], dtype=float)
    table["time_s"] = [repr(float(t)) for t in time - time[:1]]
    table["fault"] = ["" if float(cell) == 0 else cell for cell in table["observation_fault"]]
    for name in [name for name in table if name.startswith("origin_")]:
        table[name] = [ORIGINS[int(float(cell))] for cell in table[name]]
    return table


def read_table(file):
    """The table of a file."""
    with open(file, newline="", encoding="utf-8") as lines:
        head, *rows = csv.reader(lines)
    return table_of(dict(zip(head, map(list, zip(*rows)))))


def scores_of(table, trial):
    """The scores of one trial: name, value or None, origin, reason."""
    steps = Steps(table, trial.get("first", 0), trial.get("last", len(table["time_s"]) - 1))
    put = Put(origin_of(steps, trial))
    MEASURES[trial["measure"]](steps, trial, put)
    return put.scores


def main(arguments):
    if not arguments or len(arguments) % 2:
        sys.exit(__doc__)
    writer = csv.writer(sys.stdout, lineterminator="\n")
    writer.writerow(["table", "trial", "score", "value", "origin", "reason"])
    for number, (table_file, trials_file) in enumerate(zip(arguments[::2], arguments[1::2])):
        table = read_table(table_file)
        with open(trials_file, encoding="utf-8") as file:
            trials = json.load(file)
        for index, trial in enumerate(trials):
            for name, value, origin, why in scores_of(table, trial):
                writer.writerow([number, index, name, "" if value is None else repr(value), origin, why])


if __name__ == "__main__":
    main(sys.argv[1:])
