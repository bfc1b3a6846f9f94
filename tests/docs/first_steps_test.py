# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of docs/first-steps.md as a reader types them, and compares what they print with the page.

first_steps_test.py ROOT PROGRAM
"""
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT, PROGRAM = (Path(one).resolve() for one in sys.argv[1:3])
del sys.argv[1:3]
BLOCK = re.compile(r"^```(sh|text)\n(.*?)^```$", re.M | re.S)
# `./run` goes on until Ctrl-C. Here it ends by itself, without waiting for a real-time processor, and prints no address.
STATION = ["run", "--headless", "--seconds", "0.5", "--no-realtime"]
WITHOUT_PAGE = {"Cockpit: http://127.0.0.1:8480/"}


class FirstSteps(unittest.TestCase):
    def test_the_commands_print_what_the_page_says(self):
        text = (ROOT / "docs/first-steps.md").read_text(encoding="utf-8")
        commands, compared, printed = 0, 0, ""
        with tempfile.TemporaryDirectory() as folder:
            for kind, block in BLOCK.findall(text):
                for line in block.splitlines():
                    if kind == "sh":
                        self.assertTrue(line.startswith("./run"), line)
                        words = line.split()[1:] or STATION
                        done = subprocess.run([PROGRAM, *words], cwd=folder, capture_output=True, text=True)
                        self.assertEqual(done.returncode, 0, f"{line}\n{done.stdout}{done.stderr}")
                        printed = done.stdout + done.stderr
                        commands += 1
                    elif line not in WITHOUT_PAGE:
                        self.assertIn(line, printed.splitlines())
                        compared += 1
            for file in re.findall(r"`(out/[\w./-]+\.\w+)`", text):
                self.assertTrue(Path(folder, file).is_file(), file)
            self.assertEqual(Path(folder, "out/soft/plot.svg").read_bytes(), (ROOT / "docs/pictures/grasp_teapot.svg").read_bytes(),
                             "the picture of the page is another one")
        self.assertGreaterEqual(commands, 5)
        self.assertGreaterEqual(compared, 6)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
