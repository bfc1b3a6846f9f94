#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""slurm_test.py PROGRAM SCRIPT: a study as a job array of a Slurm with one node, which this test starts and ends.

One task is cancelled and repeated. Exit code 77 (skipped), with the reason, if Slurm is not installed.
"""

from __future__ import annotations

import getpass
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM, SCRIPT = (Path(argument).resolve() for argument in sys.argv[1:3])
TASKS = 3
LONGEST = 1500.0  # [s]; below the time limit of the test, so that its failure has words

STUDY = """
scene = "stability_press"
seeds = 6
[stiffness]
min_n_per_mm = 0.2
max_n_per_mm = 2.0
step_n_per_mm = 0.2
search = "trace"
[[axis]]
key = "patient.press_n"
values = [2, 2.5, 3, 3.5, 4, 4.5, 5]
"""

SETTINGS = """
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={port}
SlurmdPort={next_port}
AuthType=auth/munge
AuthInfo=socket={folder}/munge
SlurmUser={user}
SlurmdUser={user}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def free_ports() -> int:
    """A port that is free, as is the next one."""
    while True:
        with socket.socket() as one, socket.socket() as other:
            one.bind(("127.0.0.1", 0))
            port = one.getsockname()[1]
            try:
                other.bind(("127.0.0.1", port + 1))
            except OSError:
                continue
            return port


def until(condition, what: str) -> None:
    end = time.monotonic() + LONGEST
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"not within {LONGEST:.0f} s: {what}")
        time.sleep(0.1)


class Slurm:
    """munged, slurmctld and slurmd in a folder of their own, as this user."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf"), "PHALANX": str(PROGRAM)}
        for name in ("state", "spool"):
            (folder / name).mkdir()
        port = free_ports()
        (folder / "slurm.conf").write_text(SETTINGS.format(
            host=socket.gethostname().split(".")[0], port=port, next_port=port + 1, folder=folder, user=getpass.getuser(),
            cpus=os.cpu_count()))
        (folder / "key").write_bytes(os.urandom(128))
        (folder / "key").chmod(0o600)
        self.processes = []
        self.start("munged", "--foreground", "--force", f"--key-file={folder}/key", f"--socket={folder}/munge",
                   f"--pid-file={folder}/munged.pid", f"--log-file={folder}/munged.log", f"--seed-file={folder}/seed")
        until((folder / "munge").exists, "the socket of munged")
        self.start("slurmctld", "-D")
        self.start("slurmd", "-D")
        until(lambda: "idle" in self.ask("sinfo", "--noheader", "--format=%T"), "a node that is idle")

    def start(self, *command: str) -> None:
        with open(self.folder / f"{command[0]}.out", "wb") as log:
            self.processes.append(subprocess.Popen(command, env=self.environment, stdout=log, stderr=log))

    def ask(self, *command: str) -> str:
        return subprocess.run(command, env=self.environment, cwd=self.folder, capture_output=True, text=True).stdout.strip()

    def submit(self, *arguments: str) -> str:
        done = subprocess.run(["sbatch", "--parsable", "--cpus-per-task=1", *arguments], env=self.environment, cwd=self.folder,
                              capture_output=True, text=True)
        if done.returncode != 0:
            raise AssertionError(done.stderr)
        return done.stdout.strip()

    def ended(self, job: str) -> bool:
        return self.ask("squeue", "--noheader", "--jobs", job) == ""

    def end(self) -> None:
        self.ask("scancel", "--user", getpass.getuser())
        for process in reversed(self.processes):
            process.terminate()
        for process in self.processes:
            try:
                process.wait(30)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


class StudyArray(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="slurm"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.slurm = Slurm(self.folder)
        self.addCleanup(self.slurm.end)
        (self.folder / "study.toml").write_text(STUDY)

    def points(self, task: int) -> int:
        """The finished points of a task's journal; its first line is a header."""
        journal = self.folder / "out" / f"points.{task}-of-{TASKS}.jsonl"
        return max(0, journal.read_bytes().count(b"\n") - 1) if journal.exists() else 0

    def run_array(self, tasks: str) -> str:
        return self.slurm.submit(f"--array={tasks}", "--output=task-%a.log", str(SCRIPT), "study.toml", "out", str(TASKS))

    def test_a_cancelled_task_goes_on_and_the_whole_is_that_of_one_process(self) -> None:
        first = self.run_array(f"1-{TASKS}")
        until(lambda: self.points(1) >= 1, "a first point of task 1")
        self.slurm.ask("scancel", f"{first}_1")
        until(lambda: self.slurm.ended(first), "the end of the other tasks")
        done = self.points(1)

        again = self.run_array("1")
        merge = self.slurm.submit(f"--dependency=afterok:{again}", "--output=merge.log", str(SCRIPT), "merge", "out")
        until(lambda: self.slurm.ended(merge), "the merging")
        self.assertIn(f"{done} of them from earlier runs", (self.folder / "task-1.log").read_text(), "no point twice")

        subprocess.run([PROGRAM, "study", "study.toml", "--out", "alone", "--quiet"], cwd=self.folder, check=True)
        for name in ("study.csv", "points.jsonl"):
            self.assertEqual(sorted((self.folder / "out" / name).read_bytes().splitlines()),
                             sorted((self.folder / "alone" / name).read_bytes().splitlines()), name)

    def test_a_task_outside_an_array_is_refused_in_words(self) -> None:
        job = self.slurm.submit("--output=refused.log", str(SCRIPT), "study.toml", "out", "3")
        until(lambda: self.slurm.ended(job), "the end of the job")
        self.assertIn("submit it with sbatch --array=1-3", (self.folder / "refused.log").read_text())


if __name__ == "__main__":
    os.environ["PATH"] += ":/usr/sbin:/sbin"
    missing = [name for name in ("munged", "slurmctld", "slurmd", "sbatch") if shutil.which(name) is None]
    if missing:
        print(f"skipped: {', '.join(missing)} not found; install munge, slurmctld, slurmd and slurm-client")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1], verbosity=2)
