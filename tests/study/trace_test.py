#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""trace_test.py PROGRAM: the traced limits of studies/devices.toml are within a step of the scanned ones, for a fifth of the trials."""

from __future__ import annotations

import csv
import subprocess
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

PROGRAM = Path(sys.argv[1]).resolve()
STUDY = Path(__file__).resolve().parents[2] / "studies" / "devices.toml"


class Trace(unittest.TestCase):
    def results(self, folder: Path, search: str) -> list[dict[str, str]]:
        text = STUDY.read_text()
        heading = "[stiffness]\n"
        self.assertEqual(text.count(heading), 1)
        file = folder / f"{search}.toml"
        file.write_text(text.replace(heading, f'{heading}search = "{search}"\n'))
        out = folder / search
        subprocess.run([PROGRAM, "study", file, "--out", out, "--jobs", "1", "--quiet"], check=True)
        with open(out / "study.csv", newline="") as table:
            return list(csv.DictReader(table))

    def test_the_boundary_of_the_devices_is_traced_with_a_fifth_of_the_trials(self) -> None:
        with tempfile.TemporaryDirectory(prefix="trace") as name:
            scan = self.results(Path(name), "scan")
            trace = self.results(Path(name), "trace")
        step = tomllib.loads(STUDY.read_text())["stiffness"]["step_n_per_mm"]
        self.assertEqual(len(scan), len(trace))
        self.assertGreater(len(scan), 1)
        for scanned, traced in zip(scan, trace):
            with self.subTest(point=scanned["point"]):
                self.assertAlmostEqual(float(traced["k_lim_n_per_mm"]), float(scanned["k_lim_n_per_mm"]), delta=step + 1e-9)
        trials = [sum(int(point["trials"]) for point in points) for points in (trace, scan)]
        print(f"{trials[0]} trials instead of {trials[1]}")
        self.assertLessEqual(5 * trials[0], trials[1])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
