# SPDX-License-Identifier: Apache-2.0
"""An environment for learning control, in the form of gymnasium, without that package.

A policy moves the joints of a hand and learns to press an object with a target force. reset() and step() have
the arguments and results of gymnasium.Env; spaces are plain dataclasses with the fields of gymnasium's Box.
"""
from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from phalanx._core import DIGITS, JOINTS, Scene, Snapshot, Stepper

__all__ = ["Box", "HandEnv"]


@dataclass(frozen=True)
class Box:
    """Vectors between two bounds, as gymnasium.spaces.Box.

    low, high: bounds of each component, both included.
    names: what each component is, with its unit.
    """

    low: NDArray[np.float64]
    high: NDArray[np.float64]
    names: tuple[str, ...] = field(default=())

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of a vector of this space."""
        return self.low.shape

    @property
    def dtype(self) -> np.dtype[np.float64]:
        """Type of a vector's components."""
        return np.dtype(np.float64)

    def contains(self, x: ArrayLike) -> bool:
        """Returns True for a vector of this shape within the bounds."""
        vector = np.asarray(x)
        if vector.dtype.kind not in "fiu" or vector.shape != self.shape:
            return False
        return bool(np.all(vector >= self.low) and np.all(vector <= self.high))

    def sample(self, generator: np.random.Generator) -> NDArray[np.float64]:
        """Draws a vector, uniform between finite bounds.

        Raises ValueError if a bound is infinite.
        """
        if not (np.all(np.isfinite(self.low)) and np.all(np.isfinite(self.high))):
            raise ValueError("sample: a bound of this space is infinite; draw from the action space")
        return generator.uniform(self.low, self.high)


class HandEnv:
    """Press an object with the fingers until their force is on target.

    An action is the speed of each moved joint, in parts of `speed_rad_per_s`. An observation is, in this
    order: the measured angles of the moved joints [rad], their shown angles [rad], their torques [Nm], the
    force on each of their digits [N], and the target force of all digits together [N].

    The reward of a step is -|force - target| / target - 0.01 mean(action^2), where force is the sum of the
    magnitudes on all 16 segments [N], also on those that are not in the observation. An episode terminates when
    this force has been within `tolerance` of the target for `hold_s`. It is truncated after `seconds`.

    scene: Scene, or what Scene() takes.
    digits: names of the digits that move.
    target_n: range from which the target force is drawn [N].
    tolerance: deviation that counts as on target, as a part of the target [-].
    hold_s: time on target that ends an episode [s].
    seconds: longest episode [s].
    action_hz: actions a second; the step runs at the scene's rate meanwhile [Hz].
    speed_rad_per_s: largest speed of a joint [rad/s].

    Raises ValueError for an argument out of range, SceneError for a scene that cannot be used.
    """

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(
        self,
        scene: Scene | str = "index_ball",
        digits: Sequence[str] = ("index",),
        *,
        target_n: tuple[float, float] = (0.5, 2.0),
        tolerance: float = 0.1,
        hold_s: float = 0.5,
        seconds: float = 10.0,
        action_hz: float = 50.0,
        speed_rad_per_s: float = 1.0,
    ) -> None:
        unknown = [digit for digit in digits if digit not in DIGITS]
        if unknown or not digits:
            raise ValueError(f"digits: {unknown or 'none is given'}; known: {', '.join(DIGITS)}")
        if not 0.0 < target_n[0] <= target_n[1] < math.inf:
            raise ValueError(f"target_n = {target_n}: give two forces > 0, the smaller one first")
        for name, value in (("tolerance", tolerance), ("hold_s", hold_s), ("seconds", seconds),
                            ("action_hz", action_hz), ("speed_rad_per_s", speed_rad_per_s)):
            if not 0.0 < value < math.inf:
                raise ValueError(f"{name} = {value}: must be finite and > 0")
        self._stepper = Stepper(scene if isinstance(scene, Scene) else Scene(scene))
        self._digits = [DIGITS.index(digit) for digit in dict.fromkeys(digits)]
        self._joints = np.array([4 * digit + joint for digit in self._digits for joint in range(4)])
        self._target_range = target_n
        self._tolerance = tolerance
        self._speed = speed_rad_per_s
        self._ticks = max(1, round(self._stepper.rate_hz / action_hz))
        self._period_s = self._ticks / self._stepper.rate_hz
        self._hold_steps = math.ceil(hold_s / self._period_s)
        self._most_steps = math.ceil(seconds / self._period_s)
        self._generator = np.random.default_rng()
        self._ready = False
        self._angle = np.array(self._stepper.open_angle_rad)
        self._target = target_n[0]
        self._steps = 0
        self._held = 0

        names = [JOINTS[joint] for joint in self._joints]
        count = len(names)
        low, high = self._stepper.min_angle_rad[self._joints], self._stepper.max_angle_rad[self._joints]
        endless = np.full(count, math.inf)
        forces = np.full(len(self._digits), math.inf)
        self.action_space = Box(-np.ones(count), np.ones(count), tuple(f"{name} speed [-]" for name in names))
        self.observation_space = Box(
            np.concatenate([low, low, -endless, 0.0 * np.ones_like(forces), [target_n[0]]]),
            np.concatenate([high, high, endless, forces, [target_n[1]]]),
            tuple(f"{name} {what}" for what in ("measured [rad]", "shown [rad]", "torque [Nm]") for name in names)
            + tuple(f"{DIGITS[digit]} force [N]" for digit in self._digits)
            + ("target force [N]",),
        )

    @property
    def period_s(self) -> float:
        """Time between two actions [s]."""
        return self._period_s

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float64], dict[str, Any]]:
        """Begins an episode at the open hand.

        seed: of the targets of this and later episodes; None: they continue.
        options: {"target_n": force} states the target instead of drawing it.

        Raises ValueError if that target is outside the environment's target_n.
        """
        if seed is not None:
            self._generator = np.random.default_rng(seed)
        self._target = float(self._generator.uniform(*self._target_range))
        if options and "target_n" in options:
            stated = float(options["target_n"])
            if not self._target_range[0] <= stated <= self._target_range[1]:
                raise ValueError(f"target_n = {stated}: must be within {self._target_range}")
            self._target = stated
        self._stepper.reset()
        self._angle = np.array(self._stepper.open_angle_rad)
        self._steps = 0
        self._held = 0
        self._ready = True
        snapshot = self._stepper.step(self._angle)
        return self._observation(snapshot), self._info(snapshot)

    def step(
        self, action: ArrayLike
    ) -> tuple[NDArray[np.float64], float, bool, bool, dict[str, Any]]:
        """Moves the joints for one period.

        action: speed of each moved joint, -1 to 1; larger values are clipped.
        Returns observation, reward, terminated, truncated and info, as gymnasium.

        Raises RuntimeError before reset() and after the end of an episode, TypeError or ValueError for an action of
        another type or shape, or with a number that is not finite.
        """
        if not self._ready:
            raise RuntimeError("step: the episode has ended, or none has begun; call reset() first")
        wanted = np.asarray(action)
        if wanted.dtype.kind not in "fiu":
            raise TypeError(f"action: the array's type is {wanted.dtype}; give real numbers")
        if wanted.shape != self.action_space.shape:
            raise ValueError(f"action: the shape is {wanted.shape}; expected {self.action_space.shape}")
        if not np.all(np.isfinite(wanted)):
            raise ValueError("action: every number must be finite")
        wanted = np.clip(wanted.astype(np.float64), -1.0, 1.0)
        low, high = self._stepper.min_angle_rad, self._stepper.max_angle_rad
        for _ in range(self._ticks):
            self._angle[self._joints] += wanted * self._speed / self._stepper.rate_hz
            self._angle = np.clip(self._angle, low, high)
            snapshot = self._stepper.step(self._angle)
        force = float(snapshot.force_n.sum())
        deviation = abs(force - self._target) / self._target
        self._held = self._held + 1 if deviation <= self._tolerance else 0
        self._steps += 1
        terminated = self._held >= self._hold_steps
        truncated = not terminated and self._steps >= self._most_steps
        self._ready = not (terminated or truncated)
        reward = -deviation - 0.01 * float(np.mean(wanted**2))
        return self._observation(snapshot), reward, terminated, truncated, self._info(snapshot)

    def close(self) -> None:
        """Ends the episode."""
        self._ready = False

    def _observation(self, snapshot: Snapshot) -> NDArray[np.float64]:
        forces = [snapshot.force_n[3 * digit : 3 * digit + 3].sum() for digit in self._digits]
        return np.concatenate([
            snapshot.hcp_angle_rad[self._joints],
            snapshot.gdp_angle_rad[self._joints],
            snapshot.torque_nm[self._joints],
            forces,
            [self._target],
        ])

    def _info(self, snapshot: Snapshot) -> dict[str, Any]:
        return {"time_s": snapshot.time_s, "status": snapshot.status, "target_n": self._target,
                "force_n": float(snapshot.force_n.sum())}
