# SPDX-License-Identifier: Apache-2.0
"""Closed-loop trials and studies."""
import pathlib
import tempfile
import unittest

import numpy as np
import phalanx

from support import another_thread_runs_during

STUDY = """
description = "two stabilisers"
scene = "stability_press"
seeds = 1
[stiffness]
min_n_per_mm = 0.5
max_n_per_mm = 1.0
step_n_per_mm = 0.5
[[axis]]
key = "patient.bump_n"
values = [4.5]
[[variant]]
name = "none"
set = { "stabiliser.method" = "none" }
[[variant]]
name = "smoothing"
set = { "smoothing.min_n" = -0.1, "smoothing.max_n" = 0.1 }
"""


class Trials(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene = phalanx.Scene("stability_press")
        cls.loop = phalanx.ClosedLoop(cls.scene)

    def test_smoothing_steadies_the_press_of_s2(self):
        steady = self.loop.run(seed=1, columns=["time_s", "force_n", "torque_nm"])
        shaking = phalanx.ClosedLoop(phalanx.Scene("stability_press", set={"stabiliser.method": "none"})).run()
        self.assertTrue(steady.valid and steady.stable)
        self.assertFalse(shaking.stable)
        # The swing is that of the recorded force in the window.
        begin, end = self.loop.window_s
        window = (steady.run.time_s >= begin) & (steady.run.time_s < end)
        force = steady.run.force_n[window].max(axis=1)
        self.assertAlmostEqual(np.ptp(force), steady.force_swing_n, places=2)
        self.assertGreater(shaking.force_swing_n, 5 * steady.force_swing_n)

    def test_seeds_in_parallel_have_the_bits_of_single_trials(self):
        together = self.loop.run_seeds([3, 1, 2])
        self.assertEqual([trial.seed for trial in together], [3, 1, 2])
        single = self.loop.run(seed=2, columns=False)
        self.assertIsNone(single.run)
        for name in ("force_swing_n", "position_swing_m", "peak_depth_m", "ghost_energy_j", "stable", "valid"):
            self.assertEqual(getattr(together[2], name), getattr(single, name))

    def test_stiffness_and_press_replace_those_of_scene_and_patient(self):
        self.assertEqual(self.loop.stiffness_n_per_m, 900.0)
        soft = self.loop.run(stiffness_n_per_m=300, press_n=1.0, columns=False)
        hard = self.loop.run(stiffness_n_per_m=300, press_n=2.0, columns=False)
        self.assertLess(soft.mean_force_n, hard.mean_force_n)
        for error, arguments in (
            (ValueError, {"stiffness_n_per_m": 0}), (ValueError, {"stiffness_n_per_m": float("nan")}),
            (ValueError, {"press_n": -1}), (TypeError, {"press_n": "2"}), (TypeError, {"seed": -1}),
            (TypeError, {"seed": 1.5}), (ValueError, {"columns": ["no"]}), (TypeError, {"stiffness_n_per_m": True}),
        ):
            with self.assertRaises(error, msg=str(arguments)):
                self.loop.run(**arguments)

    def test_a_scene_without_contact_is_refused(self):
        with self.assertRaisesRegex(ValueError, "none of the digits"):
            phalanx.ClosedLoop(phalanx.Scene("stability_press", set={"objects.0.position_mm": [0, 900, 0]}))

    def test_another_thread_runs_during_trials(self):
        self.assertTrue(another_thread_runs_during(lambda: self.loop.run(columns=False)))
        self.assertTrue(another_thread_runs_during(lambda: self.loop.run_seeds([1])))


class Studies(unittest.TestCase):
    def test_a_study_gives_columns_and_continues_from_its_journal(self):
        study = phalanx.Study.from_text(STUDY)
        self.assertEqual((len(study), study.axes, study.title), (2, ["patient.bump_n"], "two stabilisers"))
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "study"
            seen = []
            first = study.run(out, progress=lambda done, total: seen.append((done, total)))
            self.assertEqual(seen, [(0, 2), (1, 2), (2, 2)])
            again = study.run(out, progress=lambda done, total: seen.append((done, total)))
            self.assertEqual(seen[3:], [(2, 2)])
        self.assertEqual(list(first["variant"]), ["none", "smoothing"])
        np.testing.assert_array_equal(first["patient.bump_n"], [4.5, 4.5])
        np.testing.assert_array_equal(first["k_lim_n_per_m"], [500.0, 1000.0])
        self.assertEqual(first["stable"].dtype, bool)
        for name, column in first.items():
            np.testing.assert_array_equal(column, again[name], err_msg=name)

    def test_progress_can_end_a_study_and_other_threads_run(self):
        study = phalanx.Study.from_text(STUDY)

        def stop(done, total):
            raise LookupError("enough")

        with self.assertRaisesRegex(LookupError, "enough"):
            study.run(progress=stop)
        self.assertTrue(another_thread_runs_during(study.check))

    def test_wrong_studies_are_refused_with_the_words_of_the_program(self):
        with self.assertRaisesRegex(phalanx.SceneError, "seed"):
            phalanx.Study.from_text(STUDY.replace("seeds", "sedes"))
        with self.assertRaisesRegex(phalanx.SceneError, "patient.bomp_n"):
            phalanx.Study.from_text(STUDY.replace("patient.bump_n", "patient.bomp_n")).check()
        with self.assertRaises(phalanx.SceneError):
            phalanx.Study("no/such/study.toml")
        with self.assertRaisesRegex(ValueError, "jobs = -1"):
            phalanx.Study.from_text(STUDY).run(jobs=-1)
        with tempfile.NamedTemporaryFile() as file:
            with self.assertRaises((ValueError, OSError, phalanx.Error)):
                phalanx.Study.from_text(STUDY).run(out=file.name)


if __name__ == "__main__":
    unittest.main()
