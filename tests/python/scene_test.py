# SPDX-License-Identifier: Apache-2.0
"""Scenes: from names, files, text and arrays; keys; errors."""
import copy
import os
import pathlib
import pickle
import tempfile
import unittest

import numpy as np
import phalanx

from support import BALL, ball, box


class Keys(unittest.TestCase):
    def test_a_key_reads_as_it_was_set_and_else_its_default(self):
        scene = ball()
        self.assertEqual(scene["rate_hz"], 200)
        self.assertEqual(scene["objects.0.diameter_mm"], 60)
        self.assertEqual(scene["force.law"], "hooke")
        scene["force.stiffness_n_per_mm"] = 0.9
        scene["rate_hz"] = np.int64(500)
        scene["objects.0.position_mm"] = np.array([1.0, 2.0, 3.5])
        self.assertEqual(scene["force.stiffness_n_per_mm"], 0.9)
        self.assertEqual(scene.rate_hz, 500.0)
        self.assertEqual(scene["objects.0.position_mm"], [1.0, 2.0, 3.5])
        self.assertIsNone(scene["hand.profile"])

    def test_a_refused_value_changes_nothing_and_names_key_value_and_range(self):
        scene = ball()
        with self.assertRaises(phalanx.SceneError) as refused:
            scene["rate_hz"] = -3
        self.assertIn("rate_hz", str(refused.exception))
        self.assertIn("-3", str(refused.exception))
        self.assertEqual(scene["rate_hz"], 200)
        self.assertIsInstance(refused.exception, ValueError)
        self.assertIsInstance(refused.exception, phalanx.Error)

    def test_several_keys_are_set_together_or_not_at_all(self):
        scene = ball()
        with self.assertRaises(phalanx.SceneError):
            scene.set({"rate_hz": 500, "force.law": "none of these"})
        self.assertEqual(scene["rate_hz"], 200)

    def test_an_unknown_key_is_refused_with_the_words_of_the_program(self):
        with self.assertRaisesRegex(phalanx.SceneError, "stiffness_n_per_mm"):
            ball()["force.stiffnes_n_per_mm"] = 1.0
        with self.assertRaisesRegex(KeyError, "force.stiffness_n_per_mm"):
            ball()["force.stiffnes_n_per_mm"]

    def test_values_of_other_types_are_refused(self):
        for value in (None, object(), {1, 2}, b"bytes", complex(1, 2), [[[[[[[[[[1]]]]]]]]]]):
            with self.assertRaises(TypeError, msg=repr(value)):
                ball()["rate_hz"] = value
        endless = []
        endless.append(endless)
        with self.assertRaises(TypeError):
            ball()["rate_hz"] = endless
        with self.assertRaises(phalanx.SceneError):
            ball()["rate_hz"] = float("nan")

    def test_a_copy_does_not_follow_and_nothing_is_pickled(self):
        scene = ball()
        copies = [scene.copy(), copy.copy(scene), copy.deepcopy(scene)]
        scene["rate_hz"] = 400
        self.assertEqual([each["rate_hz"] for each in copies], [200] * 3)
        for each in (phalanx.Stepper(scene), phalanx.scene_keys()["rate_hz"], phalanx.motion_of(scene)):
            with self.assertRaisesRegex(TypeError, "cannot copy"):
                copy.copy(each)
        with self.assertRaisesRegex(TypeError, "pickle"):
            pickle.dumps(scene)

    def test_no_object_is_made_without_its_constructor(self):
        for each in vars(phalanx).values():
            if isinstance(each, type) and type(each).__name__ == "pybind11_type":
                for make in (each.__new__, object.__new__):
                    with self.assertRaisesRegex(TypeError, "is not safe", msg=each.__name__):
                        make(each)

        class Forgetful(phalanx.Scene):
            def __init__(self):
                pass

        class Named(phalanx.Scene):
            def __init__(self):
                super().__init__("index_ball")

        with self.assertRaisesRegex(TypeError, "__init__"):
            Forgetful()
        self.assertEqual(Named().name, "index_ball")

    def test_setting_a_key_often_costs_no_more(self):
        scene = ball()
        for i in range(50):
            scene["rate_hz"] = 200 + i
            scene["force.stiffness_n_per_mm"] = 0.5 + 0.01 * i
        self.assertEqual(scene["rate_hz"], 249)
        self.assertAlmostEqual(scene["force.stiffness_n_per_mm"], 0.99)

    def test_the_table_of_keys_is_that_of_the_program(self):
        keys = phalanx.scene_keys()
        self.assertEqual(keys["force.stiffness_n_per_mm"].unit, "N/mm")
        self.assertEqual(keys["rate_hz"].default, 200)
        self.assertIn("hooke", keys["force.law"].range)
        self.assertGreater(len(keys), 100)


class Sources(unittest.TestCase):
    def test_a_name_a_path_and_a_text_give_the_same_scene(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "ball.toml"
            file.write_text(BALL)
            forces = [
                phalanx.simulate(scene, columns=["force_n"]).force_n
                for scene in (phalanx.Scene(file), phalanx.Scene(os.fspath(file)), phalanx.Scene.from_text(BALL))
            ]
        self.assertGreater(forces[0].max(), 0.1)
        np.testing.assert_array_equal(forces[0], forces[1])
        np.testing.assert_array_equal(forces[0], forces[2])

    def test_the_shipped_scenes_are_listed(self):
        names = dict(phalanx.scenes())
        self.assertIn("grasp_teapot", names)
        self.assertEqual(phalanx.Scene("index_ball").description, names["index_ball"])

    def test_an_unknown_name_raises_and_suggests_a_near_one(self):
        with self.assertRaisesRegex(phalanx.SceneError, 'did you mean "grasp_teapot"'):
            phalanx.Scene("grasp_teapt")
        with self.assertRaises(phalanx.SceneError):
            phalanx.Scene("no/such/file.toml")
        with self.assertRaises(phalanx.SceneError):
            phalanx.Scene.from_text("[hand\n")
        with self.assertRaises(TypeError):
            phalanx.Scene(7)

    def test_arrays_make_an_object(self):
        keys = {"hand.meshes": "capsules", "hand.position_mm": [0, -100, 45], "hand.rotation_deg": [90, 0, 0]}
        hand = phalanx.Stepper(phalanx.Scene.from_text("", set=keys))
        position, rotation = hand.poses(hand.open_angle_rad)
        tip = phalanx.segment("index-finger-phalanx-distal")
        below = position[tip] - 0.01 * rotation[tip, :, 2] - [0, 0, 0.03]
        vertices, triangles = box(0.03, below)  # its top is 15 mm below the bone
        scene = phalanx.Scene.from_arrays(vertices, triangles, set=keys)
        out, corners = scene.mesh()
        np.testing.assert_array_equal(out, vertices)
        np.testing.assert_array_equal(corners, triangles)
        bent = np.array(hand.open_angle_rad)
        bent[phalanx.joint("index_mcp_flexion")] += 0.25
        path = np.linspace(hand.open_angle_rad, bent, 200)
        run = phalanx.Stepper(scene).steps(path, columns=["force_n", "normal"])
        self.assertGreater(run.force_n[-1, tip], 1.0)
        np.testing.assert_allclose(run.normal[-1, tip], [0, 0, 1], atol=1e-9)

    def test_arrays_replace_the_objects_of_a_scene(self):
        vertices, triangles = box(0.01, (0.0, 0.0, -1.0))
        away = ball().with_arrays(vertices.astype(np.float32), triangles.astype(np.uint16), friction=0.4)
        self.assertEqual(phalanx.simulate(away, columns=["force_n"]).force_n.max(), 0.0)
        self.assertGreater(phalanx.simulate(ball(), columns=["force_n"]).force_n.max(), 0.0)

    def test_wrong_arrays_are_refused(self):
        vertices, triangles = box()
        broken = vertices.copy()
        broken[3, 1] = np.nan
        outside = triangles.copy()
        outside[2, 0] = 8
        huge = triangles.astype(np.int64)
        huge[0, 0] = 2**32  # 0 in 32 bits
        cases = [
            (ValueError, vertices[:, :2], triangles, "shape"),
            (ValueError, vertices, triangles.ravel(), "shape"),
            (TypeError, vertices, triangles.astype(float), "integers"),
            (TypeError, vertices.astype(complex), triangles, "real"),
            (TypeError, "vertices", triangles, "array"),
            (TypeError, None, triangles, "array"),
            (ValueError, broken, triangles, "vertex 3"),
            (ValueError, vertices, outside, "names vertex 8"),
            (ValueError, vertices, huge, "names vertex 4294967296"),
            (ValueError, vertices, -triangles - 1, "names vertex -"),
            (ValueError, vertices, np.zeros((0, 3), int), "no triangle"),
        ]
        for error, points, corners, words in cases:
            with self.assertRaisesRegex(error, words):
                phalanx.Scene.from_arrays(points, corners)
        with self.assertRaisesRegex(ValueError, "friction = 3"):
            phalanx.Scene.from_arrays(vertices, triangles, friction=3)


if __name__ == "__main__":
    unittest.main()
