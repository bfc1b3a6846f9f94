# SPDX-License-Identifier: Apache-2.0
"""What the tests of the package share."""
import sys
import threading

import numpy as np
import phalanx

# A ball of 60 mm under a hand of capsules: quick to load.
BALL = """
[hand]
meshes = "capsules"
position_mm = [24, -130, 54]
rotation_deg = [90, 0, 0]
[[objects]]
kind = "sphere"
diameter_mm = 60
[motion]
name = "press"
closure = 0.16
close_s = 0.5
hold_s = 0.2
open_s = 0.3
"""


def ball(**keys):
    """Returns the scene BALL; keys are written with __ in place of a dot."""
    return phalanx.Scene.from_text(BALL, set={key.replace("__", "."): value for key, value in keys.items()})


def box(size=0.02, centre=(0.0, 0.0, 0.0)):
    """Returns vertices (8, 3) and triangles (12, 3) of a cube."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
    return (corners - 0.5) * size + centre, np.array(triangles)


def another_thread_runs_during(call, tries=200):
    """Returns True if a second Python thread runs while `call` is inside C++.

    The switch interval keeps the interpreter from changing threads by itself. The other thread, which waits
    for the lock (GIL), can then run only if `call` releases it. Whether the system wakes it up before a short
    call ends is a matter of chance, so the call is repeated; a call that keeps the lock never passes.
    """
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e6)
    try:
        for _ in range(tries):
            go, ran = threading.Event(), []
            other = threading.Thread(target=lambda: (go.wait(), ran.append(True)))
            other.start()  # returns once the thread runs; it waits for `go` at the latest when we wait for it
            go.set()
            call()
            seen = bool(ran)
            other.join()
            if seen:
                return True
        return False
    finally:
        sys.setswitchinterval(interval)
