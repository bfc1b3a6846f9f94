# SPDX-License-Identifier: Apache-2.0
"""fuzz_calls.py [CALLS [SEED]]: calls of everything in the package with wild arguments.

Any exception of Python is an answer. A crash, or a report of a sanitizer, ends the process. The last line says
how many calls were made and how many of them were refused.
"""
import faulthandler
import inspect
import os
import pathlib
import random
import subprocess
import sys
import tempfile

import numpy as np
import phalanx
from phalanx import _core

from support import BALL, ball, box

NAMES = ["", "force_n", "rate_hz", "grasp_teapot", "force.stiffness_n_per_mm", "objects.0.diameter_mm",
         "objects.7.kind", "objects", "a\0b", "\ud800", "é" * 300, "x" * 5000, "../..", "[", "\n=", "off", BALL]
NUMBERS = [0, 1, -1, 2, 5, 19, 20, 255, 2**31 - 1, 2**31, 2**63 - 1, 2**63, 2**64, -(2**63), 10**40, 0.0, -0.0, 0.05,
           0.5, 1.0, 1e-300, -1e-5, 1e18, 1e308, float("nan"), float("inf"), -float("inf")]
TYPES = ["f8", "f4", "f2", ">f8", "i8", "i4", "u1", ">i2", "?", "c16", "O", "U3", "S2", "M8[s]", "m8[s]",
         [("a", "f8"), ("b", "i4")]]
SHAPES = [(), (0,), (1,), (3,), (20,), (19,), (0, 3), (1, 3), (8, 3), (12, 3), (3, 8), (0, 20), (2, 20), (5, 20), (20, 2),
          (2, 2, 20), (1,) * 32]
# What runs for long, ends the process, or is no function of the package.
LEFT_OUT = {"Study.run"}


class Angry:
    """Raises wherever it can be asked."""

    def _raise(self, *arguments):
        raise ArithmeticError("angry")

    __array__ = __index__ = __float__ = __len__ = __getitem__ = __iter__ = __fspath__ = __call__ = __str__ = _raise


class Text(str):
    """A text of another class."""


def wild_array(dice):
    shape, kind = dice.choice(SHAPES), dice.choice(TYPES)
    count = int(np.prod(shape))
    values = np.array([dice.choice(NUMBERS[:9] + NUMBERS[15:]) for _ in range(count)], float)
    with np.errstate(all="ignore"):
        try:
            array = values.reshape(shape).astype(kind)
        except (ValueError, TypeError):
            array = np.zeros(shape, kind)
    change = dice.randrange(6)
    if change == 1 and array.ndim:
        array = array[::-1]
    elif change == 2:
        array = np.asfortranarray(array)
    elif change == 3:
        array.flags.writeable = False
    elif change == 4 and array.ndim:
        array = np.repeat(array, 2, axis=0)[::2]
    elif change == 5:
        array = np.broadcast_to(array, (2, *shape)) if array.ndim < 32 else array
    return array


def wild_value(dice, known, depth=0):
    kind = dice.randrange(13 if depth < 3 else 6)
    if kind == 0:
        return dice.choice([None, True, False, Ellipsis, NotImplemented])
    if kind in (1, 2):
        return dice.choice(NUMBERS)
    if kind == 3:
        return dice.choice(NAMES)
    if kind == 4:
        return dice.choice([b"", b"\xff" * 9, bytearray(8), memoryview(b"12345678"), Text("rate_hz"), 1j, Angry(),
                            object(), len, range(3), pathlib.Path("none.toml"), {1, 2}, Angry, phalanx,
                            np.float32(0.5), np.int8(3), np.datetime64("now")])
    if kind == 5:
        return dice.choice(known)
    if kind == 6:
        return [wild_value(dice, known, depth + 1) for _ in range(dice.randrange(5))]
    if kind == 7:
        return tuple(wild_value(dice, known, depth + 1) for _ in range(dice.randrange(4)))
    if kind == 8:
        return {dice.choice(NAMES): wild_value(dice, known, depth + 1) for _ in range(dice.randrange(3))}
    if kind == 9:
        return dice.choice([lambda *a: None, lambda: None, lambda *a: 1 / 0, iter([1, 2]), (i for i in "ab")])
    return wild_array(dice)


def entries(known):
    """Returns every function, method and attribute of the package, as (name, function)."""
    found = []
    for name, value in vars(_core).items():
        if inspect.isclass(value) and not issubclass(value, BaseException):
            found.append((name, value))
            for object_ in [o for o in known if isinstance(o, value)] + [value]:
                for part in dir(value):
                    if part in ("__class__", "__dict__", "__doc__", "__subclasshook__", "__init_subclass__"):
                        continue
                    entry = f"{name}.{part}"
                    if entry in LEFT_OUT:
                        continue
                    if isinstance(inspect.getattr_static(value, part), property):
                        found.append((entry, lambda *a, o=object_, p=part, **k: getattr(o, p)))
                    elif not part.startswith("__") or part in ("__getitem__", "__setitem__", "__len__", "__init__", "__new__",
                                                               "__repr__", "__getstate__", "__reduce__"):
                        found.append((entry, lambda *a, o=object_, p=part, **k: getattr(o, p)(*a, **k)))
        elif callable(value) and not inspect.isclass(value):
            found.append((name, value))
    return found


def recording_in(folder):
    """Returns a short recording of the program PHALANX_PROGRAM."""
    # The program has no sanitizer; neither needs the library that is loaded before this interpreter's.
    environment = {name: value for name, value in os.environ.items() if name != "LD_PRELOAD"}
    subprocess.run([os.environ["PHALANX_PROGRAM"], "run", "index_ball", "--headless", "--seconds", "0.1", "--record",
                    folder], check=True, capture_output=True, env={**environment, "HOME": folder})
    return phalanx.Recording(next(pathlib.Path(folder).glob("*.mcap")))


def main():
    faulthandler.enable()
    calls = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    dice = random.Random(seed)
    with tempfile.TemporaryDirectory() as folder:
        recording = recording_in(folder)
        file = pathlib.Path(folder) / "noise.mcap"
        file.write_bytes(bytes(dice.randrange(256) for _ in range(3000)))
        scene = ball()
        stepper = phalanx.Stepper(scene)
        vertices, triangles = box()
        run = phalanx.simulate(scene, seconds=0.05)
        known = [scene, stepper, stepper.snapshot(), phalanx.motion_of(scene), run, run.force_n, vertices, triangles,
                 recording, np.array(stepper.open_angle_rad), np.tile(stepper.open_angle_rad, (5, 1)), file, str(file),
                 phalanx.Study.from_text('scene = "stability_press"\nseeds = 1\n'),
                 phalanx.ClosedLoop(phalanx.Scene("stability_press", set={"hand.meshes": "capsules"})),
                 phalanx.scene_keys()["rate_hz"]]
        functions = entries(known)
        by_name = {}
        for name, function in functions:
            by_name.setdefault(name, []).append(function)
        names = sorted(by_name)
        refused = 0
        for number in range(calls):
            name = names[number % len(names)] if number < len(names) else dice.choice(names)
            arguments = [wild_value(dice, known) for _ in range(dice.choice([0, 1, 1, 2, 2, 3, 4, 6]))]
            keywords = {}
            if dice.random() < 0.3:
                word = dice.choice(["set", "columns", "progress", "time_s", "seconds", "friction", "seed", "names", "from_s", "x"])
                keywords[word] = wild_value(dice, known)
            print(f"{number} {name}", file=sys.stderr, flush=True)
            try:
                dice.choice(by_name[name])(*arguments, **keywords)
            except Exception:
                refused += 1
        # It still works after all of that.
        again = phalanx.simulate(ball(), seconds=0.05)
        np.testing.assert_array_equal(again.gdp_angle_rad, run.gdp_angle_rad)
    print(f"{calls} calls of {len(names)} functions, {refused} refused, seed {seed}")
    return 0 if 0 < refused < calls else 1


if __name__ == "__main__":
    sys.exit(main())
