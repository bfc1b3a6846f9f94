# SPDX-License-Identifier: Apache-2.0
"""installed_test.py BUILD SOURCE: the installed package, moved to another folder, finds the data beside it."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv.pop(2))
BUILD = pathlib.Path(sys.argv.pop(1))

PROGRAM = """
import importlib.metadata
import phalanx
print(phalanx.data_folder())
print(phalanx._core.__file__)
assert importlib.metadata.version("phalanx") == phalanx.__version__
print(len(phalanx.scenes()), phalanx.simulate(phalanx.Scene("index_ball"), seconds=0.05).tick[-1])
"""


class Installed(unittest.TestCase):
    def test_it_is_found_and_finds_its_data_where_it_was_moved_to(self):
        with tempfile.TemporaryDirectory() as folder:
            first, moved = pathlib.Path(folder) / "first", pathlib.Path(folder) / "moved"
            subprocess.run(["cmake", "--install", BUILD, "--component", "python", "--prefix", first], check=True,
                           capture_output=True)
            parts = sorted(part.name for part in (first / "lib/python3/dist-packages").iterdir())
            self.assertEqual(parts[0], "phalanx")
            self.assertRegex(" ".join(parts[1:]), r"^phalanx-[0-9.]+[.]dist-info$")
            first.rename(moved)
            data = moved / "share" / "phalanx"
            data.mkdir(parents=True)
            for part in ("assets", "scenes"):
                (data / part).symlink_to(SOURCE / part)
            environment = {**os.environ, "PYTHONPATH": str(moved / "lib/python3/dist-packages")}
            environment.pop("PHALANX_DATA_DIR", None)
            lines = subprocess.run([sys.executable, "-c", PROGRAM], env=environment, check=True, capture_output=True,
                                   text=True).stdout.splitlines()
        self.assertEqual(lines[0], str(data))
        self.assertTrue(lines[1].startswith(str(moved)), lines[1])
        self.assertEqual(lines[2].split()[1], "10")


if __name__ == "__main__":
    unittest.main()
