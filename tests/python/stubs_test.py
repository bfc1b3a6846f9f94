# SPDX-License-Identifier: Apache-2.0
"""stubs_test.py FOLDER: the stubs of python/ agree with the module, and mypy accepts a user's program."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PYTHON = pathlib.Path(sys.argv.pop(1))
ALLOWLIST = pathlib.Path(__file__).with_name("stubtest_allowlist.txt")

PROGRAM = """
import numpy as np
import phalanx
from phalanx.env import HandEnv

scene = phalanx.Scene("index_ball", set={"rate_hz": 500})
run = phalanx.simulate(scene, seconds=0.5)
largest: float = float(run.force_n.max())
mean: float = float(np.mean(run.force_n[run.contact]))
trial: phalanx.Trial = phalanx.ClosedLoop(scene).run(seed=1)
if trial.run is not None:
    print(trial.run.time_s[-1], phalanx.Status(trial.run.status[-1]))
observation, info = HandEnv(scene).reset(seed=1)
"""


def run(*command, folder):
    """Runs a tool of mypy with its cache in a folder of the test."""
    return subprocess.run(command, cwd=folder, capture_output=True, text=True,
                          env={**os.environ, "MYPY_CACHE_DIR": str(folder)})


class Stubs(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def test_they_are_what_make_stubs_writes(self):
        made = self.folder / "_core.pyi"
        subprocess.run([sys.executable, PYTHON / "make_stubs.py", made], check=True)
        self.assertEqual(made.read_text(), (PYTHON / "phalanx" / "_core.pyi").read_text(),
                         "run python/make_stubs.py python/phalanx/_core.pyi")

    def test_stubtest_finds_no_difference(self):
        result = run("stubtest", "phalanx._core", "--allowlist", str(ALLOWLIST), folder=self.folder)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_stubtest_finds_a_difference_that_is_made(self):
        package = self.folder / "stubs" / "phalanx"
        package.mkdir(parents=True)
        for name in ("__init__.py", "env.py", "py.typed"):
            (package / name).write_text((PYTHON / "phalanx" / name).read_text())
        stub = (PYTHON / "phalanx" / "_core.pyi").read_text()
        (package / "_core.pyi").write_text(stub.replace("def reset(self)", "def rest(self)"))
        os.environ["MYPYPATH"] = str(package.parent)
        self.addCleanup(os.environ.pop, "MYPYPATH")
        result = run("stubtest", "phalanx._core", "--allowlist", str(ALLOWLIST), folder=self.folder)
        self.assertEqual(result.returncode, 1)
        self.assertIn("Stepper.rest", result.stdout)

    def test_mypy_accepts_a_program_and_refuses_a_wrong_one(self):
        program = self.folder / "program.py"
        program.write_text(PROGRAM)
        right = run("mypy", "--strict", "program.py", folder=self.folder)
        self.assertEqual(right.returncode, 0, right.stdout)
        program.write_text(PROGRAM + "phalanx.simulate(3)\nscene.nonsense\n")
        wrong = run("mypy", "--strict", "program.py", folder=self.folder)
        self.assertIn('"Scene" has no attribute "nonsense"', wrong.stdout)
        self.assertIn('"simulate" has incompatible type "int"', wrong.stdout)


if __name__ == "__main__":
    unittest.main()
