# SPDX-License-Identifier: Apache-2.0
"""figures_test.py FOLDER: the figures of examples/python, with their numbers, short."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import phalanx

FOLDER = pathlib.Path(sys.argv.pop(1))
sys.path.insert(0, str(FOLDER))

import figure  # noqa: E402
import s1_fig8  # noqa: E402
import s2_fig4  # noqa: E402
import s2_fig5  # noqa: E402
import s2_limits  # noqa: E402


class Figures(unittest.TestCase):
    def write(self, drawn):
        """Writes a figure, and checks that all its texts are inside of it."""
        drawn.draw_without_rendering()
        edge = drawn.bbox
        for axes in drawn.axes:
            for text in (axes.title, axes._left_title, axes.xaxis.label, axes.yaxis.label, *axes.texts):
                if text.get_text() and text.get_visible():
                    box = text.get_window_extent()
                    self.assertTrue(box.x0 >= edge.x0 - 1 and box.x1 <= edge.x1 + 1, text.get_text())
        with tempfile.TemporaryDirectory() as folder:
            for ending, begins in ((".png", b"\x89PNG"), (".svg", b"<?xml")):
                out = pathlib.Path(folder) / f"figure{ending}"
                drawn.savefig(out)
                self.assertTrue(out.read_bytes().startswith(begins))
        figure.plt.close(drawn)

    def test_s1_fig8_loads_the_joints_between_contact_and_palm(self):
        played = s1_fig8.compute()
        touching = [[bool(s.snapshot.contact[i]) for i in s1_fig8.SEGMENTS] for s in played]
        self.assertEqual(touching, [[False, False, False], [True, False, False], [True, True, False],
                                    [True, True, True], [False, False, True], [False, False, True],
                                    [False, True, False]])
        for situation, touch in zip(played, touching):
            torque = situation.snapshot.torque_nm[s1_fig8.JOINTS]
            for joint in range(3):
                self.assertEqual(abs(torque[joint]) > 1e-9, any(touch[joint:]), situation.title)
            others = np.delete(situation.snapshot.torque_nm, [*s1_fig8.JOINTS, phalanx.joint("index_mcp_abduction")])
            self.assertEqual(np.abs(others).max(), 0.0)
        self.write(s1_fig8.draw(played))

    def test_s2_fig4_oscillates_without_smoothing_only(self):
        loop, trials = s2_fig4.compute()
        none, smoothing = trials.values()
        self.assertTrue(smoothing.stable and smoothing.valid)
        self.assertFalse(none.stable)
        index = phalanx.segment("index-finger-phalanx-distal")
        way = figure.into_object(smoothing.run, index)
        begin, end = loop.window_s
        window = (smoothing.run.time_s >= begin) & (smoothing.run.time_s < end)
        self.assertAlmostEqual(np.ptp(way[window]), smoothing.position_swing_m, delta=5e-5)
        self.write(s2_fig4.draw(loop, trials))

    def test_s2_fig5_is_a_stable_grasp_of_several_digits(self):
        loop, trial = s2_fig5.compute()
        self.assertTrue(trial.stable and trial.valid)
        digits = {int(segment) // 3 for segment in np.flatnonzero(trial.run.force_n.max(axis=0))}
        self.assertGreaterEqual(len(digits), 4)
        self.write(s2_fig5.draw(loop, trial))

    def test_s2_limits_has_the_two_numbers_of_s2_between_its_cells(self):
        bounds, stiffness = (None, 0.1), np.array([0.7, 1.0, 1.6])
        shares = s2_limits.compute(3, bounds, stiffness)
        np.testing.assert_array_equal(s2_limits.limits(shares, stiffness), [0.7, 1.6])
        self.write(s2_limits.draw(shares, bounds, stiffness))
        np.testing.assert_array_equal(s2_limits.limits(np.array([[1, 0.9], [1, 1], [0.5, 1]]), stiffness), [1.0, 0.0])

    def test_a_script_writes_the_file_that_is_asked_for(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "fig5.svg"
            subprocess.run([sys.executable, FOLDER / "s2_fig5.py", "--out", out, "--seed", "2"], check=True,
                           capture_output=True)
            self.assertIn("power grasp", out.read_text())


if __name__ == "__main__":
    unittest.main()
