# SPDX-License-Identifier: Apache-2.0
"""Steps and whole motions: results, memory, errors, threads."""
import gc
import threading
import unittest
import weakref

import numpy as np
import phalanx

from support import another_thread_runs_during, ball


class Steps(unittest.TestCase):
    def setUp(self):
        self.stepper = phalanx.Stepper(ball())

    def test_the_first_step_is_the_open_hand_without_force(self):
        snapshot = self.stepper.step(self.stepper.open_angle_rad)
        self.assertEqual(snapshot.status, 0)
        self.assertEqual(snapshot.force_n.shape, (16,))
        self.assertEqual(np.abs(snapshot.torque_nm).max(), 0.0)
        np.testing.assert_array_equal(snapshot.hcp_angle_rad, self.stepper.open_angle_rad)

    def test_step_by_step_rows_and_simulate_give_the_same_bits(self):
        scene = ball()
        motion = phalanx.motion_of(scene)
        run = phalanx.simulate(scene)
        rows = np.array([motion.at(t) for t in run.time_s])
        together = self.stepper.steps(rows)
        self.stepper.reset()
        single = [self.stepper.step(row) for row in rows]
        self.assertGreater(run.force_n.max(), 0.1)
        for name in run.columns:
            np.testing.assert_array_equal(getattr(run, name), getattr(together, name), err_msg=name)
            np.testing.assert_array_equal(getattr(run, name), [getattr(s, name) for s in single], err_msg=name)

    def test_a_force_is_stiffness_times_depth(self):
        run = phalanx.simulate(ball(force__stiffness_n_per_mm=0.7))
        pressed = run.contact & (run.depth_m > 0)
        self.assertGreater(pressed.sum(), 10)
        np.testing.assert_allclose(run.force_raw_n[pressed], 700.0 * run.depth_m[pressed], rtol=1e-12)

    def test_a_later_step_does_not_change_a_snapshot(self):
        rows = np.array([phalanx.motion_of(ball()).at(0.7)])
        first = self.stepper.step(self.stepper.open_angle_rad)
        before = first.hcp_angle_rad.copy()
        view = first.hcp_angle_rad
        self.stepper.step(rows[0])
        np.testing.assert_array_equal(view, before)

    def test_poses_are_those_of_the_steps(self):
        run = phalanx.simulate(ball(), columns=["hcp_angle_rad", "hcp_position_m", "hcp_rotation"])
        position, rotation = self.stepper.poses(run.hcp_angle_rad[100])
        np.testing.assert_array_equal(position, run.hcp_position_m[100])
        np.testing.assert_array_equal(rotation, run.hcp_rotation[100])
        for matrix in rotation:
            np.testing.assert_allclose(matrix @ matrix.T, np.eye(3), atol=1e-12)
            self.assertAlmostEqual(np.linalg.det(matrix), 1.0)

    def test_parameters_can_be_exchanged_between_steps(self):
        held = np.array(phalanx.motion_of(ball()).at(0.7))
        path = np.vstack([np.linspace(self.stepper.open_angle_rad, held, 100), np.tile(held, (200, 1))])
        soft = self.stepper.steps(path).force_n[-1].max()
        self.stepper.use_parameters_of(ball(force__stiffness_n_per_mm=0.1))
        softer = self.stepper.steps(np.tile(held, (400, 1))).force_n[-1].max()
        self.assertLess(softer, 0.5 * soft)
        with self.assertRaisesRegex(ValueError, "rate_hz"):
            self.stepper.use_parameters_of(ball(rate_hz=1000))

    def test_wrong_samples_are_refused(self):
        open_hand = self.stepper.open_angle_rad
        cases = [
            (ValueError, open_hand[:19], "shape"),
            (ValueError, np.zeros((20, 1)), "shape"),
            (TypeError, ["0"] * 20, "type"),
            (TypeError, np.array([None] * 20), "type"),
            (TypeError, open_hand.astype(complex), "type"),
            (TypeError, None, "array"),
            (TypeError, {}, "type"),
            (ValueError, np.full(20, np.nan), "finite"),
            (ValueError, np.full(20, -np.inf), "finite"),
        ]
        for error, angle, words in cases:
            with self.assertRaisesRegex(error, words):
                self.stepper.step(angle)
        with self.assertRaisesRegex(ValueError, "time_s"):
            self.stepper.step(open_hand, float("inf"))
        with self.assertRaisesRegex(TypeError, "time_s"):
            self.stepper.step(open_hand, "now")
        with self.assertRaisesRegex(ValueError, "shape"):
            self.stepper.steps(np.zeros((3, 20)), time_s=[0.0, 0.1])
        with self.assertRaisesRegex(ValueError, "digit = 5"):
            self.stepper.confirm_opening(5)
        with self.assertRaisesRegex(ValueError, "segment = -1"):
            self.stepper.segment_mesh(-1)

    def test_the_sample_guard_sees_a_broken_sensor_if_it_is_asked_for(self):
        self.stepper.step(self.stepper.open_angle_rad)
        broken = np.array(self.stepper.open_angle_rad)
        broken[4] = np.nan
        snapshot = self.stepper.step(broken, allow_nonfinite=True)
        self.assertTrue(phalanx.Status(snapshot.status) & phalanx.Status.SAMPLE_NOT_FINITE)
        self.assertTrue(np.isfinite(snapshot.torque_nm).all())

    def test_status_has_the_bits_of_the_program(self):
        self.assertEqual([bit.name.lower() for bit in phalanx.Status], list(phalanx.STATUS_BITS))
        self.assertEqual([int(bit) for bit in phalanx.Status], [1 << i for i in range(14)])


class Memory(unittest.TestCase):
    """An array of a run is the memory that C++ computed into."""

    def test_arrays_share_the_memory_of_the_run(self):
        run = phalanx.simulate(ball(), columns=["force_n", "point_m", "gdp_rotation"])
        for name in run.columns:
            one, two = getattr(run, name), getattr(run, name)
            self.assertIsNot(one, two)
            self.assertEqual(one.ctypes.data, two.ctypes.data)
            self.assertTrue(np.shares_memory(one, two))
            self.assertFalse(one.flags.owndata)
            self.assertEqual(type(one.base).__name__, "PyCapsule")
            with self.assertRaises(ValueError):
                one[0] = 1.0

    def test_an_array_keeps_the_memory_alive_and_lets_go_of_it(self):
        run = phalanx.simulate(ball(), columns=["force_n"])
        alone = run._owners
        force = run.force_n
        self.assertEqual(run._owners, alone + 1)
        part = force[10:20, ::2]
        del force
        gc.collect()
        self.assertEqual(run._owners, alone + 1)
        del part
        gc.collect()
        self.assertEqual(run._owners, alone)
        force = run.force_n
        expected = force.copy()
        del run
        gc.collect()
        np.testing.assert_array_equal(force, expected)

    def test_views_of_a_snapshot_keep_it_alive(self):
        stepper = phalanx.Stepper(ball())
        snapshot = stepper.step(stepper.open_angle_rad)
        view = snapshot.point_m
        self.assertIs(view.base, snapshot)
        self.assertEqual(view.ctypes.data, snapshot.point_m.ctypes.data)
        seen = weakref.ref(view)
        del snapshot, stepper
        gc.collect()
        self.assertEqual(view.shape, (16, 3))
        del view
        self.assertIsNone(seen())

    def test_meshes_are_the_models_memory(self):
        stepper = phalanx.Stepper(ball())
        vertices, triangles = stepper.object_mesh()
        again, _ = stepper.object_mesh()
        self.assertTrue(np.shares_memory(vertices, again))
        self.assertEqual(triangles.dtype, np.int32)
        np.testing.assert_allclose(np.linalg.norm(vertices, axis=1), 0.03, atol=1e-12)
        segment, _ = stepper.segment_mesh(phalanx.segment("index-finger-phalanx-distal"))
        del stepper
        gc.collect()
        self.assertTrue(np.isfinite(segment).all() and np.isfinite(vertices).all())

    def test_a_column_that_was_not_chosen_is_an_attribute_error(self):
        run = phalanx.simulate(ball(), columns=["force_n"])
        with self.assertRaisesRegex(AttributeError, "depth_m is not in this run"):
            run.depth_m
        self.assertEqual(list(run.as_dict()), ["force_n"])
        with self.assertRaisesRegex(ValueError, "there is no 'forc_n'"):
            phalanx.simulate(ball(), columns=["forc_n"])

    def test_a_motion_that_needs_too_much_memory_is_refused(self):
        with self.assertRaisesRegex(ValueError, "8 GiB"):
            phalanx.simulate(ball(rate_hz=2000), seconds=86400)


class Motions(unittest.TestCase):
    def test_own_angles_are_played(self):
        scene = ball()
        stepper = phalanx.Stepper(scene)
        bent = np.array(stepper.open_angle_rad)
        bent[phalanx.joint("index_mcp_flexion")] += 0.2
        motion = phalanx.Motion([0.0, 0.5], [stepper.open_angle_rad, bent])
        run = phalanx.simulate(scene, motion, columns=["hcp_angle_rad", "time_s"])
        self.assertEqual(len(run), 100)
        column = run.hcp_angle_rad[:, phalanx.joint("index_mcp_flexion")]
        np.testing.assert_allclose(column - column[0], 0.2 * run.time_s / 0.5, atol=1e-12)

    def test_wrong_motions_are_refused(self):
        angles = np.zeros((2, 20))
        for error, time, angle in (
            (ValueError, [0.0, 0.0], angles), (ValueError, [1.0, 0.0], angles), (ValueError, [0.0], angles),
            (ValueError, [], np.zeros((0, 20))), (ValueError, [0.0, np.nan], angles),
            (ValueError, [0.0, 1.0], angles[:, :19]), (TypeError, ["a", "b"], angles),
            (ValueError, [0.0, 1.0], angles * np.nan),
        ):
            with self.assertRaises(error):
                phalanx.Motion(time, angle)
        for seconds in (-1, np.inf, np.nan, 1e300):
            with self.assertRaisesRegex(ValueError, "seconds"):
                phalanx.simulate(ball(), seconds=seconds)


class Threads(unittest.TestCase):
    def test_another_thread_runs_during_long_calls(self):
        scene = ball()
        stepper = phalanx.Stepper(scene)
        rows = np.tile(stepper.open_angle_rad, (2000, 1))
        self.assertTrue(another_thread_runs_during(lambda: phalanx.simulate(scene, columns=["tick"])))
        self.assertTrue(another_thread_runs_during(lambda: stepper.steps(rows, columns=["tick"])))
        self.assertTrue(another_thread_runs_during(lambda: phalanx.Stepper(scene)))

    def test_the_check_fails_for_a_call_that_keeps_the_lock(self):
        self.assertFalse(another_thread_runs_during(lambda: sum(range(20000)), tries=20))

    def test_progress_is_reported_and_can_end_a_run(self):
        seen = []
        phalanx.simulate(ball(), columns=[], progress=lambda done, total: seen.append((done, total)))
        self.assertEqual(seen[-1], (240, 240))
        self.assertEqual(sorted(seen), seen)

        def stop(done, total):
            if done > 100:
                raise KeyboardInterrupt("enough")

        with self.assertRaisesRegex(KeyboardInterrupt, "enough"):
            phalanx.simulate(ball(), progress=stop)
        with self.assertRaisesRegex(TypeError, "progress"):
            phalanx.simulate(ball(), progress=3)

    def test_two_threads_cannot_step_one_hand_at_once(self):
        stepper = phalanx.Stepper(ball())
        rows = np.tile(stepper.open_angle_rad, (5000, 1))
        done, refused = threading.Event(), []

        def steps():
            while not refused and not done.is_set():
                try:
                    stepper.steps(rows, columns=[])
                except phalanx.Error as error:
                    refused.append(str(error))

        other = threading.Thread(target=steps)
        other.start()
        try:
            for _ in range(100_000):
                try:
                    stepper.step(rows[0])
                except phalanx.Error as error:
                    refused.append(str(error))
                    break
        finally:
            done.set()
            other.join()
        self.assertIn("in use by another thread", refused[0])


if __name__ == "__main__":
    unittest.main()
