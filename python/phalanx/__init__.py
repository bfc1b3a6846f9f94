# SPDX-License-Identifier: Apache-2.0
"""Haptic rendering of a whole hand: scenes, steps, closed-loop trials, studies and recordings.

    import phalanx
    run = phalanx.simulate(phalanx.Scene("grasp_teapot"), columns=["time_s", "force_n"])
    print(run.force_n.max(), "N")

Units are SI and part of every name: _m, _rad, _n, _nm (newton metre), _s. docs/python.md is the manual.
"""
import enum as _enum
from phalanx._core import (
    DIGITS,
    JOINTS,
    RENDERING_VERSION,
    SEGMENTS,
    STATUS_BITS,
    ClosedLoop,
    Error,
    Motion,
    Recording,
    Run,
    Scene,
    SceneError,
    SceneKey,
    Snapshot,
    Stepper,
    Study,
    Trial,
    __version__,
    data_folder,
    made,
    motion_of,
    scene_keys,
    scenes,
    simulate,
)


class Status(_enum.IntFlag):
    """Bits of Snapshot.status and Run.status: what happened in a step (docs/outputs.md)."""

    SAMPLE_NOT_FINITE = 1 << 0
    SAMPLE_OUT_OF_RANGE = 1 << 1
    SAMPLE_JUMP = 1 << 2
    TIME_NOT_INCREASING = 1 << 3
    START_INSIDE = 1 << 4
    SLID = 1 << 5
    SEARCH_EXHAUSTED = 1 << 6
    FORCE_LIMITED = 1 << 7
    TORQUE_LIMITED = 1 << 8
    TORQUE_RATE_LIMITED = 1 << 9
    COMMAND_NOT_FINITE = 1 << 10
    TRAJECTORY_EXHAUSTED = 1 << 11
    SAMPLE_STALE = 1 << 12
    OSCILLATING = 1 << 13


def joint(name: str) -> int:
    """Returns the number of a joint, for the columns with 20 values: joint("index_mcp_flexion").

    Raises ValueError for an unknown name.
    """
    return _index(name, JOINTS, "joint")


def segment(name: str) -> int:
    """Returns the number of a segment, for the columns with 16 values: segment("index-finger-phalanx-distal").

    Raises ValueError for an unknown name.
    """
    return _index(name, SEGMENTS, "segment")


def _index(name: str, names: tuple[str, ...], kind: str) -> int:
    if name not in names:
        raise ValueError(f"there is no {kind} {name!r}; known: {', '.join(names)}")
    return names.index(name)


__all__ = [
    "DIGITS",
    "JOINTS",
    "RENDERING_VERSION",
    "SEGMENTS",
    "STATUS_BITS",
    "ClosedLoop",
    "Error",
    "Motion",
    "Recording",
    "Run",
    "Scene",
    "SceneError",
    "SceneKey",
    "Snapshot",
    "Status",
    "Stepper",
    "Study",
    "Trial",
    "__version__",
    "data_folder",
    "joint",
    "made",
    "motion_of",
    "scene_keys",
    "scenes",
    "segment",
    "simulate",
]
