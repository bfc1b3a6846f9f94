# SPDX-License-Identifier: Apache-2.0
"""The environment for learning control."""
import unittest

import numpy as np
import phalanx
from phalanx.env import Box, HandEnv

from support import ball


def close_until_pressed(env):
    """A policy of one line: bend until the force is on target, then hold."""
    observation, info = env.reset(seed=4)
    for _ in range(10_000):
        gap = info["target_n"] - info["force_n"]
        action = np.zeros(env.action_space.shape)
        action[0] = np.clip(3.0 * gap / info["target_n"], -1, 1) * (0.2 if info["force_n"] > 0 else 1.0)
        observation, reward, terminated, truncated, info = env.step(action)
        if terminated or truncated:
            return terminated, reward, info
    raise AssertionError("no end")


class Episodes(unittest.TestCase):
    def test_results_have_the_form_of_gymnasium(self):
        env = HandEnv(ball())
        observation, info = env.reset(seed=1)
        self.assertTrue(env.observation_space.contains(observation))
        self.assertEqual(len(env.observation_space.names), observation.size)
        self.assertIsInstance(info, dict)
        result = env.step(env.action_space.sample(np.random.default_rng(0)))
        self.assertEqual([type(part) for part in result], [np.ndarray, float, bool, bool, dict])
        self.assertTrue(env.observation_space.contains(result[0]))
        self.assertAlmostEqual(result[4]["time_s"] - info["time_s"], env.period_s)

    def test_a_simple_policy_reaches_the_target(self):
        env = HandEnv(ball())
        terminated, reward, info = close_until_pressed(env)
        self.assertTrue(terminated)
        self.assertLess(abs(info["force_n"] - info["target_n"]), 0.1 * info["target_n"])
        self.assertGreater(reward, -0.2)
        with self.assertRaisesRegex(RuntimeError, "reset"):
            env.step(np.zeros(env.action_space.shape))

    def test_an_episode_without_contact_is_truncated(self):
        env = HandEnv(ball(), seconds=0.2)
        env.reset(seed=1)
        ends = [env.step(np.zeros(4))[2:4] for _ in range(10)]
        self.assertEqual(ends, [(False, False)] * 9 + [(False, True)])

    def test_a_seed_gives_the_same_episodes(self):
        def targets(seed):
            env = HandEnv(ball())
            return [env.reset(seed=seed)[1]["target_n"]] + [env.reset()[1]["target_n"] for _ in range(3)]

        self.assertEqual(targets(7), targets(7))
        self.assertNotEqual(targets(7), targets(8))
        env, other = HandEnv(ball()), HandEnv(ball())
        for each in (env, other):
            each.reset(seed=3)
        generator = np.random.default_rng(5)
        for _ in range(20):
            action = env.action_space.sample(generator)
            np.testing.assert_array_equal(env.step(action)[0], other.step(action)[0])

    def test_a_stated_target_and_two_digits(self):
        env = HandEnv(ball(), ["index", "middle"], target_n=(1.0, 3.0))
        observation, info = env.reset(options={"target_n": 2.5})
        self.assertEqual((env.action_space.shape, observation[-1], info["target_n"]), ((8,), 2.5, 2.5))
        with self.assertRaisesRegex(ValueError, "target_n"):
            env.reset(options={"target_n": 9.0})

    def test_wrong_arguments_are_refused(self):
        for arguments in ({"digits": ["toe"]}, {"digits": []}, {"target_n": (2.0, 1.0)}, {"seconds": 0.0},
                          {"action_hz": float("nan")}):
            with self.assertRaises(ValueError, msg=str(arguments)):
                HandEnv(ball(), **arguments)
        env = HandEnv(ball())
        with self.assertRaises(RuntimeError):
            env.step(np.zeros(4))
        env.reset()
        for error, action in ((ValueError, np.zeros(3)), (ValueError, np.full(4, np.nan)), (TypeError, ["a"] * 4)):
            with self.assertRaises(error):
                env.step(action)

    def test_a_box_tells_its_vectors(self):
        space = Box(np.array([0.0, -np.inf]), np.array([1.0, 0.0]))
        self.assertTrue(space.contains([1.0, -5.0]))
        for other in ([2.0, 0.0], [0.5], ["a", "b"], [np.nan, 0.0]):
            self.assertFalse(space.contains(other))
        with self.assertRaisesRegex(ValueError, "infinite"):
            space.sample(np.random.default_rng(0))


if __name__ == "__main__":
    unittest.main()
