# SPDX-License-Identifier: Apache-2.0
"""Recordings of the program itself. PHALANX_PROGRAM is its path."""
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np
import phalanx

from support import another_thread_runs_during


def phalanx_program(*arguments, folder):
    """Runs the program with its files in a folder of the test."""
    environment = {**os.environ, "HOME": str(folder), "XDG_CONFIG_HOME": str(folder),
                   "XDG_DATA_HOME": str(folder), "PHALANX_KEYS": str(folder / "keys")}
    result = subprocess.run([os.environ["PHALANX_PROGRAM"], *map(str, arguments)], cwd=folder, env=environment,
                            capture_output=True, text=True, timeout=120)
    if result.returncode != 0:
        raise AssertionError(f"{arguments}: {result.returncode}\n{result.stdout}\n{result.stderr}")


class Recordings(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        phalanx_program("run", "index_ball", "--headless", "--seconds", "0.6", "--record", cls.folder / "plain",
                        folder=cls.folder)
        cls.file = next((cls.folder / "plain").glob("*.mcap"))
        cls.recording = phalanx.Recording(cls.file)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_the_summary_says_what_it_is(self):
        self.assertEqual(self.recording.state, "whole")
        self.assertEqual(self.recording.scene, "index_ball")
        self.assertFalse(self.recording.encrypted)
        self.assertGreater(self.recording.steps, 100)
        self.assertEqual(self.recording.version, phalanx.__version__)

    def test_tables_are_columns_that_own_the_memory_of_c(self):
        tables = self.recording.tables()
        self.assertEqual(set(tables), {"steps", "samples", "angles", "channels", "hand", "segments", "events"})
        steps = tables["steps"]
        self.assertEqual(steps["tick"].size, self.recording.steps)
        self.assertEqual(steps["torque_nm"].shape, (steps["tick"].size, 20))
        self.assertTrue((np.diff(steps["time_s"]) >= 0).all())
        self.assertFalse(steps["torque_nm"].flags.owndata)
        self.assertEqual(type(steps["torque_nm"].base).__name__, "PyCapsule")
        self.assertEqual(len(tables["events"]["text"]), tables["events"]["time_s"].size)
        self.assertEqual(tables["hand"]["force_n"].shape[1], 5)

    def test_tables_equal_the_programs_own_export(self):
        out = self.folder / "csv"
        phalanx_program("session", "export", self.file, "--format", "csv", "--out", out, folder=self.folder)
        exported = np.genfromtxt(out / "steps.csv", delimiter=",", names=True)
        steps = self.recording.table("steps")
        np.testing.assert_array_equal(steps["host_time_s"], exported["host_time_s"])
        column = phalanx.joint("index_mcp_flexion")
        np.testing.assert_array_equal(steps["torque_nm"][:, column], exported["torque_nm_index_mcp_flexion"])

    def test_a_range_and_columns_can_be_chosen(self):
        tables = self.recording.tables(["angles"], ["angle"], from_s=0.25, to_s=0.5)
        self.assertEqual(list(tables), ["angles"])
        time = tables["angles"]["time_s"]
        self.assertTrue(((time >= 0.25) & (time < 0.5)).all() and time.size > 10)
        with self.assertRaisesRegex(ValueError, "there is no part 'step'"):
            self.recording.tables(["step"])
        with self.assertRaisesRegex(ValueError, "there is no column 'torq'"):
            self.recording.tables(columns=["torq"])
        with self.assertRaisesRegex(ValueError, "from_s"):
            self.recording.tables(from_s=-1)
        with self.assertRaises(ValueError):
            self.recording.tables(from_s=2, to_s=1)

    def test_the_motion_plays_in_another_scene_and_the_replay_is_exact(self):
        motion = self.recording.motion()
        run = phalanx.simulate(phalanx.Scene("index_ball"), motion, columns=["hcp_angle_rad"])
        self.assertGreater(len(run), 50)
        replay = self.recording.replay()
        self.assertEqual((replay["compared"], replay["different"]), (self.recording.steps, 0))
        self.assertIsNone(replay["first_difference"])

    def test_another_thread_runs_while_a_recording_is_read(self):
        self.assertTrue(another_thread_runs_during(lambda: self.recording.table("steps")))

    def test_progress_can_end_the_reading(self):
        def stop(part):
            raise LookupError("enough")

        with self.assertRaisesRegex(LookupError, "enough"):
            self.recording.tables(progress=stop)

    def test_an_encrypted_recording_is_read_with_its_key_file(self):
        registry = ["--keys", self.folder / "keys", "--data", self.folder / "data"]
        phalanx_program("patient", "add", "SIM01", "--side", "right", "--consent", "yes", *registry, folder=self.folder)
        phalanx_program("exercise", "run", "entry_check", "--patient", "SIM01", "--confirm", "SIM01", "--demo", "healthy",
                        "--seed", "1", "--seconds", "0.4", "--no-realtime", "--record", self.folder / "patient",
                        *registry, folder=self.folder)
        file = next((self.folder / "patient").glob("*.mcap.enc"))
        closed = phalanx.Recording(file)
        self.assertTrue(closed.encrypted)
        self.assertIn("key", closed.trouble)
        with self.assertRaisesRegex(phalanx.Error, "encrypted"):
            closed.tables()
        opened = phalanx.Recording(file, keys=self.folder / "keys")
        self.assertEqual(opened.table("steps")["tick"].size, opened.steps)
        self.assertEqual(opened.replay()["different"], 0)
        with self.assertRaisesRegex(phalanx.Error, "no key file"):
            phalanx.Recording(file, keys=self.folder / "other")

    def test_other_files_are_refused(self):
        with self.assertRaises(ValueError):
            phalanx.Recording(self.folder / "none.mcap")
        torn = self.folder / "torn.mcap"
        torn.write_bytes(self.file.read_bytes()[:20_000])
        recording = phalanx.Recording(torn)
        self.assertIn("no end", recording.state)
        with self.assertRaisesRegex(phalanx.Error, "torn.mcap"):
            recording.tables()


if __name__ == "__main__":
    unittest.main()
