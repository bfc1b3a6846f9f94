#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""queue_program_test.py PROGRAM [CASE]: studies on a queue with the program itself, on a server that this test starts as an ordinary user.

Four workers in two network namespaces are killed, and the server with them; then the server's certificate and password. With PHALANX_FULL
workers are killed to the end of 105 points, otherwise at most four times within 30. Exit code 77 (skipped), with the reason, if
PostgreSQL is not installed.
"""

from __future__ import annotations

import os
import random
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM = Path(sys.argv[1]).resolve()
PLACES = "/usr/lib/postgresql/15/bin:/usr/local/bin:/usr/bin"
NOBODY = 65534
NETWORK = "10.213.77"  # of the pairs of interfaces
LONGEST = 1500.0  # [s]; below the time limit of the test, so that its failure has words
FULL = bool(os.environ.get("PHALANX_FULL"))
MOST_KILLS = 1000 if FULL else 4  # of workers
KILL_EVERY = 5.0  # [s]; later if no point was finished since the last kill, sooner if a tenth of them was

STUDY = f"""
scene = "stability_press"
seeds = {3 if FULL else 2}
[[axis]]
key = "patient.press_n"
from = 2
to = 5
step = {0.15 if FULL else 0.6}
[[axis]]
key = "device.scale.sheath_friction"
values = [0.5, 0.75, 1, 1.25, 1.5]
"""
SMALL = """
scene = "stability_press"
seeds = 1
[[axis]]
key = "patient.press_n"
values = [2, 3, 4]
"""


def program_of_postgres(name: str) -> str | None:
    return shutil.which(name, path=PLACES)


def ordinary_user() -> dict[str, object]:
    """Arguments of subprocess: PostgreSQL refuses to run as root."""
    return {"user": NOBODY, "group": NOBODY, "extra_groups": []} if os.geteuid() == 0 else {}


def free_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Server:
    """PostgreSQL in a folder of its own, on a socket there and, with `addresses`, on a port of these with TLS."""

    def __init__(self, folder: Path, addresses: tuple[str, ...] = ()) -> None:
        self.folder, self.addresses, self.process = folder, addresses, None
        self.port = free_port() if addresses else 5432
        if os.geteuid() == 0:
            os.chown(folder, NOBODY, NOBODY)
        (folder / "password").write_text("sesame\n")
        (folder / "password").chmod(0o644)
        self.call("initdb", "-D", folder / "data", "-U", "phalanx", "--auth-local=trust", "--auth-host=scram-sha-256",
                  f"--pwfile={folder}/password", "--no-sync", "--locale=C", "-E", "UTF8")
        if addresses:
            with open(folder / "data" / "pg_hba.conf", "a") as rules:
                rules.write(f"hostssl all all {NETWORK}.0/24 scram-sha-256\n")
            for name in ("server.crt", "server.key"):
                shutil.copy(folder.parent / name, folder / "data")
                os.chmod(folder / "data" / name, 0o600)
                if os.geteuid() == 0:
                    os.chown(folder / "data" / name, NOBODY, NOBODY)
        self.start()

    def call(self, name: str, *arguments: object) -> str:
        done = subprocess.run([program_of_postgres(name), *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                              **ordinary_user())
        if done.returncode != 0:
            raise AssertionError(f"{name}: {done.stderr}")
        return done.stdout

    def sql(self, statement: str) -> str:
        return self.call("psql", "-h", self.folder, "-p", self.port, "-U", "phalanx", "-d", "postgres", "-qAtc", statement).strip()

    def start(self) -> None:
        """Again and again: after a kill, the server's other processes end a little later, and keep its folder until then."""
        options = ["-k", str(self.folder), "-c", f"listen_addresses={','.join(self.addresses)}", "-p", str(self.port)]
        if self.addresses:
            options += ["-c", "ssl=on"]
        end = time.monotonic() + LONGEST
        while True:
            if self.process is None or self.process.poll() is not None:
                with open(self.folder / "log", "ab") as log:
                    self.process = subprocess.Popen([program_of_postgres("postgres"), "-D", str(self.folder / "data"), *options],
                                                    cwd=self.folder, stdout=log, stderr=log, **ordinary_user())
            ready = subprocess.run([program_of_postgres("pg_isready"), "-q", "-h", self.folder, "-p", str(self.port)], check=False)
            if ready.returncode == 0:
                return
            if time.monotonic() > end:
                raise AssertionError((self.folder / "log").read_text())
            time.sleep(0.05)

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()

    def end(self) -> None:
        self.process.send_signal(signal.SIGQUIT)
        self.process.wait()

    def url(self, address: str = "") -> str:
        if address:
            return f"postgresql://phalanx@{address}:{self.port}/postgres?sslrootcert={self.folder.parent}/ours.crt"
        return f"postgresql://phalanx@/postgres?host={self.folder}&port={self.port}"


def has_points(server: Server) -> bool:
    if server.sql("SELECT to_regclass('phalanx.points')") == "":
        return False
    return server.sql("SELECT count(*) FROM phalanx.points") != "0"


class Namespace:
    """A network namespace, held by a process that sleeps in it, and connected with this one by a pair of virtual interfaces.

    `address` is this side's; empty where this user may not make such a pair: processes then reach the server by its socket, which is in
    the file system and so in every namespace. `enter` begins a command in it; empty where this user may not make a namespace.
    """

    def __init__(self, number: int) -> None:
        self.enter: list[str] = []
        self.address = ""
        self.holder = None
        for options in (["--net"], ["--user", "--map-root-user", "--net"]):
            holder = subprocess.Popen(["unshare", *options, "sh", "-c", "echo ready; exec sleep infinity"], stdout=subprocess.PIPE,
                                      stderr=subprocess.DEVNULL)
            if holder.stdout.readline() == b"ready\n":
                self.holder = holder
                self.enter = ["nsenter", *(["--user", "--preserve-credentials"] if len(options) > 1 else []), "--net", "-t",
                              str(holder.pid), "--"]
                self.connect(number)
                return
            holder.communicate()

    def connect(self, number: int) -> None:
        here, there = (f"phx{os.getpid() % 100000}{side}{number}" for side in "ab")
        first, second = (f"{NETWORK}.{4 * number + host}" for host in (1, 2))
        for command in (["ip", "link", "add", here, "type", "veth", "peer", "name", there, "netns", str(self.holder.pid)],
                        ["ip", "address", "add", f"{first}/30", "dev", here], ["ip", "link", "set", here, "up"],
                        [*self.enter, "ip", "address", "add", f"{second}/30", "dev", there],
                        [*self.enter, "ip", "link", "set", there, "up"]):
            if shutil.which("ip") is None or subprocess.run(command, capture_output=True, check=False).returncode != 0:
                return
        self.address = first

    def end(self) -> None:
        if self.holder is not None:
            self.holder.kill()
            self.holder.communicate()  # with the namespace the pair of interfaces goes


class Queue(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="queue"))
        self.folder.chmod(0o755)
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        (self.folder / "server").mkdir()

    def study(self, *arguments: object, environment: dict[str, str] | None = None) -> subprocess.CompletedProcess:
        return subprocess.run([PROGRAM, "study", *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                              env={**os.environ, **(environment or {})}, timeout=LONGEST)

    def openssl(self, *arguments: str) -> None:
        subprocess.run(["openssl", *arguments], cwd=self.folder, check=True, capture_output=True)

    def make_certificates(self) -> None:
        for authority in ("ours", "other"):
            self.openssl("req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", f"/CN={authority}", "-keyout",
                         f"{authority}.key", "-out", f"{authority}.crt")
        self.openssl("req", "-newkey", "rsa:2048", "-nodes", "-subj", "/CN=localhost", "-keyout", "server.key", "-out", "server.csr")
        (self.folder / "names").write_text(f"subjectAltName=DNS:localhost,IP:{NETWORK}.1,IP:{NETWORK}.5\n")
        self.openssl("x509", "-req", "-in", "server.csr", "-CA", "ours.crt", "-CAkey", "ours.key", "-days", "2", "-extfile", "names",
                     "-out", "server.crt")

    def password_file(self) -> dict[str, str]:
        (self.folder / "pgpass").write_text("*:*:*:phalanx:sesame\n")
        (self.folder / "pgpass").chmod(0o600)
        return {"PGPASSFILE": str(self.folder / "pgpass")}


class Killed(Queue):
    def setUp(self) -> None:
        super().setUp()
        self.make_certificates()
        self.environment = {**os.environ, **self.password_file()}
        self.namespaces = [Namespace(0), Namespace(1)]
        for namespace in self.namespaces:
            self.addCleanup(namespace.end)
        if any(not namespace.enter for namespace in self.namespaces):
            print("no network namespaces for this user: all workers are in one, and use the server's socket")
        elif any(not namespace.address for namespace in self.namespaces):
            print("no interfaces between network namespaces for this user: the workers use the server's socket")
        self.server = Server(self.folder / "server", tuple(namespace.address for namespace in self.namespaces if namespace.address))
        self.addCleanup(self.server.end)
        (self.folder / "study.toml").write_text(STUDY)
        self.started: list[subprocess.Popen] = []
        self.addCleanup(lambda: [process.kill() or process.wait() for process in self.started if process.poll() is None])

    def begin(self, log: str, *command: object) -> subprocess.Popen:
        with open(self.folder / log, "ab") as output:
            process = subprocess.Popen([*map(str, command)], cwd=self.folder, stdout=output, stderr=output,
                                       env=self.environment)
        self.started.append(process)
        return process

    def worker(self, number: int) -> subprocess.Popen:
        namespace = self.namespaces[number % 2]
        return self.begin(f"worker-{number}.log", *namespace.enter, PROGRAM, "study", "work", "study.toml", "--queue",
                          self.server.url(namespace.address), "--jobs", 1)

    def log(self) -> str:
        return "".join(f"--- {file.name}\n{file.read_text()}" for file in sorted(self.folder.glob("*.log")))

    def test_no_kill_of_workers_or_server_loses_or_repeats_a_finished_point(self) -> None:
        seed = int(os.environ.get("PHALANX_SEED", random.randrange(1 << 30)))
        print(f"seed {seed} (repeat with PHALANX_SEED={seed})")
        chance = random.Random(seed)

        def run() -> subprocess.Popen:
            return self.begin("run.log", PROGRAM, "study", "run", "study.toml", "--queue", self.server.url(), "--lease", 2, "--out", "out")

        running = run()
        end = time.monotonic() + LONGEST
        while not has_points(self.server):
            self.assertIsNone(running.poll(), self.log())
            self.assertLess(time.monotonic(), end, "no points")
            time.sleep(0.05)
        # What the queue stores is written down by the server itself.
        self.server.sql("""CREATE TABLE public.stored (point integer);
          CREATE FUNCTION public.store() RETURNS trigger LANGUAGE plpgsql AS
            'BEGIN INSERT INTO public.stored VALUES (NEW.point); RETURN NULL; END';
          CREATE TRIGGER store AFTER UPDATE OF result ON phalanx.points FOR EACH ROW EXECUTE FUNCTION public.store();
          CREATE FUNCTION public.keep() RETURNS trigger LANGUAGE plpgsql AS
            'BEGIN RAISE EXCEPTION ''a finished point was touched''; END';
          CREATE TRIGGER keep BEFORE UPDATE ON phalanx.points FOR EACH ROW WHEN (OLD.result IS NOT NULL)
            EXECUTE FUNCTION public.keep()""")
        workers = [self.worker(i) for i in range(4)]

        def finished() -> int:
            return int(self.server.sql("SELECT count(*) FROM phalanx.points WHERE result IS NOT NULL"))

        points = int(self.server.sql("SELECT count(*) FROM phalanx.points"))
        kills = {"worker": 0, "server": 0, "run": 0}
        last, done_then, done_before = time.monotonic(), 0, set()
        while running.poll() is None:
            self.assertLess(time.monotonic(), end, self.log())
            time.sleep(0.1)
            done = finished()
            fresh = done - done_then
            if done == points or fresh == 0 or kills["worker"] == MOST_KILLS:
                continue
            if time.monotonic() - last < KILL_EVERY and fresh < points // 10:
                continue
            done_before = set(self.server.sql("SELECT point || ' ' || md5(result) FROM phalanx.points WHERE result IS NOT NULL").split("\n"))
            which = chance.randrange(4)
            workers[which].kill()  # of nsenter, which became the worker
            workers[which].wait()
            kills["worker"] += 1
            if kills["worker"] % 2 == 0:
                self.server.kill()
                self.server.start()
                kills["server"] += 1
            if kills["worker"] == 3:
                running.kill()
                running.wait()
                running = run()
                kills["run"] += 1
            now = set(self.server.sql("SELECT point || ' ' || md5(result) FROM phalanx.points WHERE result IS NOT NULL").split("\n"))
            self.assertLessEqual(done_before - {""}, now, "a finished point was lost")
            workers[which] = self.worker(which)
            last, done_then = time.monotonic(), done
        print(f"{points} points; killed: {kills}")
        self.assertEqual(running.returncode, 0, self.log())
        for worker in workers:
            self.assertEqual(worker.wait(LONGEST), 0, self.log())
        self.assertGreaterEqual(kills["worker"], 4 if FULL else 2)  # a fast computer has measured 30 points before the fourth
        self.assertGreaterEqual(kills["server"], 2 if FULL else 1)
        self.assertEqual(self.server.sql("SELECT count(*), count(DISTINCT point) FROM public.stored"), f"{points}|{points}")
        self.assertEqual(self.server.sql("SELECT sum(failures) FROM phalanx.points"), "0", "a kill of a worker is no failure of a point")

        self.assertEqual(self.study("study.toml", "--out", "alone", "--jobs", 1, "--quiet").returncode, 0)
        for name in ("study.csv", "points.jsonl"):
            self.assertEqual((self.folder / "out" / name).read_bytes(), (self.folder / "alone" / name).read_bytes(), name)


class Reached(Queue):
    """Who may reach the server, and how."""

    def setUp(self) -> None:
        super().setUp()
        (self.folder / "study.toml").write_text(SMALL)

    def test_over_tcp_the_certificate_is_checked_and_the_password_is_in_a_file(self) -> None:
        self.make_certificates()
        server = Server(self.folder / "server", ("127.0.0.1",))
        self.addCleanup(server.end)
        port = server.port
        known = self.password_file()

        def run(host: str, authority: str, environment: dict[str, str]) -> subprocess.CompletedProcess:
            url = f"postgresql://phalanx@{host}:{port}/postgres?sslrootcert={self.folder}/{authority}.crt"
            return self.study("work", "study.toml", "--queue", url, environment=environment)

        for host, authority, environment, words in (
                ("localhost", "other", known, "certificate verify failed"),
                ("localhost", "missing", known, "missing.crt"),
                ("127.0.0.1", "ours", known, 'does not match host name "127.0.0.1"'),
                ("localhost", "ours", {}, "password"),
                ("localhost", "ours", known, "phalanx study run")):  # reached: it has no study
            done = run(host, authority, environment)
            self.assertNotEqual(done.returncode, 0, (host, authority))
            self.assertIn(words, done.stderr, (host, authority))
            self.assertNotIn("sesame", done.stderr)
        url = server.url("localhost")
        running = subprocess.Popen([PROGRAM, "study", "run", "study.toml", "--queue", url, "--out", "out"], cwd=self.folder,
                                   env={**os.environ, **known}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        end = time.monotonic() + LONGEST
        while run("localhost", "ours", known).returncode != 0:  # until the study is there
            self.assertIsNone(running.poll(), "run has ended")
            self.assertLess(time.monotonic(), end, "no study")
            time.sleep(0.2)
        self.assertEqual(running.wait(LONGEST), 0)
        self.assertTrue((self.folder / "out" / "summary.json").exists())

    def test_what_is_wrong_is_refused_in_words(self) -> None:
        server = Server(self.folder / "server")
        self.addCleanup(server.end)
        for arguments, code, words in (
                (["run", "study.toml", "--out", "out", "--queue", "postgresql://me:sesame@host/d"], 2, "~/.pgpass"),
                (["run", "study.toml", "--out", "out", "--queue", "postgresql://host/d?sslmode=require"], 2, "sslmode"),
                (["run", "study.toml", "--out", "out", "--queue", "elsewhere"], 2, "postgresql://USER@HOST/DATABASE"),
                (["run", "study.toml", "--out", "out", "--queue", server.url().replace("/server", "/nowhere")], 1, "cannot be reached"),
                (["run", "study.toml", "--out", "out", "--queue", server.url(), "--jobs", "2"], 2, "study work"),
                (["run", "study.toml", "--out", "out", "--retry"], 2, "--queue"),
                (["run", "study.toml", "--queue", server.url()], 2, "--out"),
                (["work", "study.toml"], 2, "--queue"),
                (["work", "study.toml", "--queue", server.url()], 2, "phalanx study run")):
            done = self.study(*arguments)
            self.assertEqual(done.returncode, code, (arguments, done.stderr))
            self.assertIn(words, done.stderr, arguments)
            self.assertNotIn("sesame", done.stdout + done.stderr)

    def test_a_worker_of_a_changed_study_is_refused_and_run_without_a_queue_is_the_study_itself(self) -> None:
        server = Server(self.folder / "server")
        self.addCleanup(server.end)
        running = subprocess.Popen([PROGRAM, "study", "run", "study.toml", "--queue", server.url(), "--out", "out", "--quiet"], cwd=self.folder)
        self.addCleanup(lambda: running.poll() is None and (running.kill() or running.wait()))
        end = time.monotonic() + LONGEST
        while not has_points(server):
            self.assertIsNone(running.poll(), "run has ended")
            self.assertLess(time.monotonic(), end, "no points")
            time.sleep(0.05)
        (self.folder / "changed").mkdir()
        (self.folder / "changed" / "study.toml").write_text(SMALL.replace("4]", "5]"))
        refused = self.study("work", "changed/study.toml", "--queue", server.url())
        self.assertEqual(refused.returncode, 2, refused.stderr)
        self.assertIn("the study file has changed since", refused.stderr)
        done = self.study("work", "study.toml", "--queue", server.url(), "--jobs", 2)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("3 points measured, 0 failures; no point is left", done.stdout)
        self.assertEqual(running.wait(LONGEST), 0)
        self.assertEqual(self.study("run", "study.toml", "--out", "alone", "--quiet").returncode, 0)
        self.assertEqual((self.folder / "out" / "study.csv").read_bytes(), (self.folder / "alone" / "study.csv").read_bytes())


if __name__ == "__main__":
    missing = [name for name in ("initdb", "postgres", "psql", "pg_isready", "openssl", "unshare", "nsenter")
               if program_of_postgres(name) is None]
    if missing:
        print(f"skipped: {', '.join(missing)} not found; install postgresql-15, openssl and util-linux")
        sys.exit(1 if "PHALANX_CI" in os.environ else 77)
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
