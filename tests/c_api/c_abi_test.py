#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""c_abi_test.py ROOT: scripts/c_abi check finds changes of the binary interface, and lets others pass."""
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(sys.argv[1])
HEADER = (ROOT / "include/phalanx/phalanx.h").read_text()

# (what, part of the header, what stands there instead)
BREAKS = [
    ("a member with another type", "  double time_s;", "  float time_s;\n  float more;"),
    ("a member in the middle", "  double depth;", "  double before;\n  double depth;"),
    ("a longer array", "double point[3];", "double point[4];"),
    ("another parameter", "double* rate_hz);", "float* rate_hz);"),
    ("a function that is gone", "PHALANX_API phalanx_result phalanx_step(", "phalanx_result phalanx_step("),
]
HARMLESS = [
    ("a comment", "  double time_s;", "  /* a comment */\n  double time_s;"),
]


def check(text, folder):
    header = folder / "phalanx.h"
    header.write_text(text)
    return subprocess.run([ROOT / "scripts/c_abi", "check", header], capture_output=True, text=True)


failed = 0
with tempfile.TemporaryDirectory() as name:
    for wanted, cases in ((1, BREAKS), (0, HARMLESS)):
        for what, part, instead in cases:
            if part not in HEADER:
                sys.exit(f"{what}: the header has no {part!r}")
            result = check(HEADER.replace(part, instead, 1), pathlib.Path(name))
            if result.returncode != wanted:
                failed += 1
                print(f"{what}: exit code {result.returncode}, wanted {wanted}\n{result.stdout}{result.stderr}")
sys.exit(1 if failed else 0)
