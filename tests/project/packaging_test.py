#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""packaging_test.py ROOT: the files of debian/, without building a package. scripts/try_packages tries the packages themselves.

Checks with programs that packages/packaging.txt names are left out where these are not installed.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree
from pathlib import Path

ROOT = Path(sys.argv.pop(1)).resolve()
DEBIAN = ROOT / "debian"


def text(name: str) -> str:
    return (ROOT / name).read_text()


def output(*command: object, given: str | None = None) -> str:
    done = subprocess.run([str(word) for word in command], input=given, capture_output=True, text=True)
    return done.stdout + done.stderr + ("" if done.returncode == 0 else f"\n(exit status {done.returncode})")


def paragraphs(name: str) -> list[dict[str, str]]:
    """Fields of a file in the form of debian/control."""
    found = []
    for block in re.split(r"\n\s*\n", text(name)):
        fields = re.findall(r"^([A-Za-z0-9-]+):((?:.*(?:\n[ \t].*)*))", block, re.MULTILINE)
        if fields:
            found.append({key: value.strip() for key, value in fields})
    return found


def names_in(field: str) -> set[str]:
    return {re.split(r"[ (\[]", entry.strip())[0] for entry in field.split(",") if entry.strip()}


def unless_installed(program: str):
    return unittest.skipUnless(shutil.which(program), f"{program} is not installed")


class Control(unittest.TestCase):
    source, *binaries = paragraphs("debian/control")

    def test_names_the_packages_that_install_md_names(self) -> None:
        documented = re.findall(r"^\| `([a-z0-9-]+)` \|", text("docs/install.md"), re.MULTILINE)
        self.assertEqual([binary["Package"] for binary in self.binaries], documented)

    def test_builds_with_what_run_builds_with(self) -> None:
        needed = {words[0] for line in text("packages/run.txt").splitlines() if (words := line.split("#")[0].split())}
        essential = {"g++"}  # of every package build
        page = {"nodejs", "npm"}  # the source package has the page that they build
        self.assertEqual(needed - names_in(self.source["Build-Depends"]) - essential - page, set())
        self.assertEqual(names_in(self.source["Build-Depends"]) & page, set())

    def test_installs_something_into_each_package(self) -> None:
        for binary in self.binaries:
            self.assertTrue((DEBIAN / f"{binary['Package']}.install").read_text().strip(), binary["Package"])

    def test_installs_files_of_its_own_that_exist(self) -> None:
        for listing in DEBIAN.glob("*.install"):
            for line in listing.read_text().splitlines():
                if line.startswith("debian/"):
                    self.assertTrue((ROOT / line.split()[0]).exists(), f"{listing.name}: {line}")

    def test_states_the_licence_of_all_that_is_bundled_in_the_page(self) -> None:
        lock = json.loads(text("web/package-lock.json"))["packages"]
        left_out = {"node_modules/tslib"}  # the bundler needs nothing of it
        shipped = (path for path, package in lock.items() if path and not package.get("dev") and path not in left_out)
        bundled = [path.rsplit("node_modules/", 1)[1] for path in shipped]
        self.assertGreater(len(bundled), 4)
        copyright_file = text("debian/copyright")
        for name in bundled:
            self.assertIn(f"/node_modules/{name}/*", copyright_file)


class Service(unittest.TestCase):
    unit = text("debian/phalanx.phalanx-station.service")

    def analyze(self, *arguments: str) -> str:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "phalanx-station.service"
            # Only the program and its manual page are not on this machine.
            file.write_text(re.sub(r"^Documentation=.*$", "", self.unit.replace("/usr/bin/phalanx", "/bin/true"), flags=re.MULTILINE))
            return output("systemd-analyze", *arguments, file)

    @unless_installed("systemd-analyze")
    def test_is_understood_by_systemd(self) -> None:
        self.assertEqual(self.analyze("verify"), "")

    @unless_installed("systemd-analyze")
    def test_has_the_exposure_that_install_md_states(self) -> None:
        if not output("systemd-analyze", "--version").startswith("systemd 252 "):
            self.skipTest("another version of systemd has another scale")
        measured = re.search(r"Overall exposure level[^:]*: ([0-9.]+)", self.analyze("security", "--offline=true", "--no-pager"))
        stated = re.search(r"an exposure of ([0-9.]+)", text("docs/install.md"))
        self.assertEqual(measured[1], stated[1])

    def test_starts_a_command_that_runs_as_its_own_user(self) -> None:
        self.assertRegex(self.unit, r"(?m)^ExecStart=/usr/bin/phalanx run --quiet \$STATION_SCENE \$STATION_OPTIONS$")
        self.assertRegex(self.unit, r"(?m)^User=phalanx$")
        self.assertRegex(text("debian/etc/default/phalanx-station"), r'(?m)^STATION_SCENE=\n(.*\n)*STATION_OPTIONS="--port 8480"$')

    @unless_installed("systemd-sysusers")
    def test_has_a_user_in_both_groups(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "etc").mkdir()
            (Path(folder) / "etc" / "group").write_text("dialout:x:20:\n")
            (Path(folder) / "etc" / "passwd").write_text("")
            self.assertNotIn("exit status", output("systemd-sysusers", f"--root={folder}", "-", given=text("debian/phalanx.sysusers")))
            groups = (Path(folder) / "etc" / "group").read_text()
            self.assertRegex(groups, r"(?m)^dialout:x:20:phalanx$")
            self.assertRegex(groups, r"(?m)^realtime:x:[0-9]+:phalanx$")
            self.assertRegex((Path(folder) / "etc" / "passwd").read_text(), r"(?m)^phalanx:x:.*:/var/lib/phalanx:/usr/sbin/nologin$")


class Permissions(unittest.TestCase):
    def test_are_those_that_realtime_md_states(self) -> None:
        limits = [line for line in text("debian/etc/security/limits.d/phalanx-realtime.conf").splitlines() if not line.startswith("#")]
        self.assertEqual(len(limits), 2)
        for line in limits:
            self.assertIn(line, text("docs/realtime.md"))
        rule = 'ACTION=="add", SUBSYSTEM=="usb-serial", DRIVER=="ftdi_sio", ATTR{latency_timer}="1"'
        self.assertIn(rule, text("docs/realtime.md"))
        self.assertIn(rule, text("debian/phalanx.udev").splitlines())

    def test_of_serial_ports_are_rules_of_udev(self) -> None:
        lines = [line for line in text("debian/phalanx.udev").replace("\\\n", "").splitlines() if line and not line.startswith("#")]
        match = r'[A-Z]+(\{[A-Za-z_]+\})?(==|!=)"[^"]*"'
        assignment = r'[A-Z]+(\{[A-Za-z_]+\})?\+?="[^"]*"'
        for line in lines:
            self.assertRegex(line, rf"^({match}|{assignment})(, *({match}|{assignment}))*$")
        given = next(line for line in lines if "uaccess" in line)
        for wanted in ('GROUP="dialout"', 'MODE="0660"', 'TAG+="uaccess"', 'ENV{ID_MM_DEVICE_IGNORE}="1"'):
            self.assertIn(wanted, given)
        self.assertEqual({line for line in lines if line.startswith("LABEL")}, {'LABEL="phalanx_end"'})


class Launcher(unittest.TestCase):
    entry = dict(re.findall(r"(?m)^([A-Za-z]+)=(.*)$", text("debian/desktop/phalanx.desktop")))

    @unless_installed("desktop-file-validate")
    def test_is_a_desktop_entry(self) -> None:
        self.assertEqual(output("desktop-file-validate", DEBIAN / "desktop" / "phalanx.desktop"), "")

    def test_starts_what_the_package_installs(self) -> None:
        places = dict(line.split() for line in text("debian/phalanx.install").splitlines() if line.startswith("debian/"))
        self.assertEqual("/" + places["debian/desktop/open-cockpit"] + "/open-cockpit", self.entry["Exec"])
        self.assertEqual(places["debian/desktop/phalanx.svg"], "usr/share/icons/hicolor/scalable/apps")
        self.assertEqual(self.entry["Icon"], "phalanx")
        picture = xml.etree.ElementTree.parse(DEBIAN / "desktop" / "phalanx.svg").getroot()
        self.assertEqual(picture.get("viewBox"), "0 0 128 128")


class Scripts(unittest.TestCase):
    def test_explain_themselves_and_refuse_unknown_options(self) -> None:
        for name in ("make_packages", "try_packages", "check_reproducible"):
            self.assertIn(f"scripts/{name}", output(ROOT / "scripts" / name, "--help"))
            self.assertRegex(output(ROOT / "scripts" / name, "--no-such-option"), r"unknown option '--no-such-option'(.|\n)*status 2")


class SourcesOfThePage(unittest.TestCase):
    def test_are_written_from_the_source_maps(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            page, out = Path(folder) / "page", Path(folder) / "out"
            (page / "assets").mkdir(parents=True)
            (page / "assets" / "main.js").write_text("a()")
            sources = {"sources": ["../../src/main.ts", "../../node_modules/three/three.js"], "sourcesContent": ["one", "two"]}
            (page / "assets" / "main.js.map").write_text(json.dumps(sources))
            self.assertEqual(output(ROOT / "scripts" / "page_sources", page, out), "")
            self.assertEqual((out / "assets/main.js/src/main.ts").read_text(), "one")
            self.assertEqual((out / "assets/main.js/node_modules/three/three.js").read_text(), "two")
            self.assertEqual([file.name for file in page.rglob("*.*")], ["main.js"])
            (page / "assets" / "helper.js").write_text("b();c()")
            (page / "assets" / "helper.js.map").write_text(json.dumps({"sources": [], "sourcesContent": []}))
            (page / "assets" / "main.js").unlink()
            self.assertEqual(output(ROOT / "scripts" / "page_sources", page, out), "")
            self.assertRegex((out / "assets/helper.js").read_text(), r"^// .*\nb\(\);\nc\(\)$")
            (page / "assets" / "other.js").write_text("b()")
            self.assertRegex(output(ROOT / "scripts" / "page_sources", page, out), "has no source map")


if __name__ == "__main__":
    unittest.main()
