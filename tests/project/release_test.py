#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""release_test.py ROOT: one version everywhere, and a bill of materials that is complete and well formed.

The version stands in CMakeLists.txt; whatever else names one must agree with it.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(sys.argv.pop(1)).resolve()


def text(name: str) -> str:
    return (ROOT / name).read_text()


def found(pattern: str, name: str) -> str:
    match = re.search(pattern, text(name), re.MULTILINE)
    if match is None:
        raise AssertionError(f"{name}: nothing matches {pattern}")
    return match[1]


VERSION = found(r"^project\(phalanx VERSION ([0-9.]+)", "CMakeLists.txt")


class Version(unittest.TestCase):
    def test_the_page_has_it(self) -> None:
        self.assertEqual(json.loads(text("web/package.json"))["version"], VERSION)
        lock = json.loads(text("web/package-lock.json"))
        self.assertEqual(lock["version"], VERSION)
        self.assertEqual(lock["packages"][""]["version"], VERSION)

    def test_the_newest_entries_of_both_changelogs_have_it(self) -> None:
        self.assertEqual(found(r"^## \[([0-9][^\]]*)\]", "CHANGELOG.md"), VERSION)
        self.assertEqual(found(r"^phalanx \(([^-]+)-[^)]+\)", "debian/changelog"), VERSION)

    def test_the_citation_has_it_with_the_day_of_the_release(self) -> None:
        self.assertEqual(found(r"^version: (.*)$", "CITATION.cff"), VERSION)
        day = found(r"^## \[[0-9][^\]]*\] - (.*)$", "CHANGELOG.md")
        self.assertRegex(day, r"^20[0-9]{2}-[01][0-9]-[0-3][0-9]$")
        self.assertEqual(found(r"^date-released: (.*)$", "CITATION.cff"), day)

    def test_examples_ask_for_it(self) -> None:
        minor = ".".join(VERSION.split(".")[:2])
        asked = 0
        for file in [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("examples/**/CMakeLists.txt"), *ROOT.glob("debian/tests/*")]:
            for match in re.findall(r"find_package\(phalanx ([0-9.]+)", file.read_text()):
                self.assertEqual(match, minor, file)
                asked += 1
        self.assertGreater(asked, 0)

    def test_a_project_of_python_has_it(self) -> None:
        for file in ROOT.glob("python/**/pyproject.toml"):
            stated = re.search(r'^version = "(.*)"$', file.read_text(), re.MULTILINE)
            if stated:
                self.assertEqual(stated[1], VERSION, file)


def bill_of_materials() -> dict:
    environment = {**os.environ, "SOURCE_DATE_EPOCH": "1700000000"}
    done = subprocess.run([sys.executable, ROOT / "scripts" / "sbom"], capture_output=True, text=True, check=True, env=environment)
    return json.loads(done.stdout)


class BillOfMaterials(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.document = bill_of_materials()
        cls.packages = cls.document["packages"]

    def test_has_the_fields_that_spdx_2_3_requires(self) -> None:
        self.assertEqual(self.document["spdxVersion"], "SPDX-2.3")
        self.assertEqual(self.document["dataLicense"], "CC0-1.0")
        self.assertEqual(self.document["SPDXID"], "SPDXRef-DOCUMENT")
        self.assertEqual(self.document["name"], f"phalanx-{VERSION}")
        self.assertRegex(self.document["documentNamespace"], r"^https://[^#\s]+$")
        self.assertEqual(self.document["creationInfo"]["created"], "2023-11-14T22:13:20Z")
        for creator in self.document["creationInfo"]["creators"]:
            self.assertRegex(creator, r"^(Tool|Organization|Person): \S")
        for package in self.packages:
            for field in ("SPDXID", "name", "downloadLocation", "licenseConcluded", "licenseDeclared", "copyrightText"):
                self.assertTrue(package[field], f"{package['name']}: {field}")
            self.assertRegex(package["SPDXID"], r"^SPDXRef-[A-Za-z0-9.-]+$")
            self.assertRegex(package["licenseDeclared"], r"^[A-Za-z0-9.+-]+( (AND|OR|WITH) [A-Za-z0-9.+-]+)*$")
            self.assertIs(package["filesAnalyzed"], False)
            for checksum in package.get("checksums", []):
                self.assertRegex(checksum["checksumValue"], r"^[0-9a-f]{128}$", package["name"])
            for reference in package.get("externalRefs", []):
                self.assertRegex(reference["referenceLocator"], r"^pkg:(deb/debian|npm)/\S+$")

    def test_relates_each_package_to_phalanx_once(self) -> None:
        identifiers = [package["SPDXID"] for package in self.packages]
        self.assertEqual(len(identifiers), len(set(identifiers)))
        related = [relation["spdxElementId"] for relation in self.document["relationships"]]
        self.assertCountEqual(related, ["SPDXRef-DOCUMENT", *(name for name in identifiers if name != "SPDXRef-phalanx")])
        for relation in self.document["relationships"]:
            self.assertEqual(relation["relatedSpdxElement"], "SPDXRef-phalanx")

    def test_has_every_package_of_the_lists_and_of_the_lock_file(self) -> None:
        names = {package["name"] for package in self.packages if "-deb-" in package["SPDXID"]}
        for listing in ("run", "test", "packaging"):
            for line in text(f"packages/{listing}.txt").splitlines():
                words = line.split("#")[0].split()
                self.assertTrue(not words or words[0] in names, f"{listing}.txt: {line}")
        locked = [path for path in json.loads(text("web/package-lock.json"))["packages"] if path]
        npm = [package for package in self.packages if "-npm-" in package["SPDXID"]]
        self.assertEqual(len(npm), len(locked))
        for package in npm:
            self.assertIn("versionInfo", package)

    def test_has_the_versions_that_dpkg_knows(self) -> None:
        asked = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", "libeigen3-dev"], capture_output=True, text=True)
        if asked.returncode != 0:
            self.skipTest("libeigen3-dev is not a package of this machine")
        eigen = next(package for package in self.packages if package["name"] == "libeigen3-dev")
        self.assertEqual(eigen["versionInfo"], asked.stdout)
        self.assertEqual(eigen["licenseDeclared"], "MPL-2.0")

    def test_has_a_licence_of_each_package_that_the_program_is_built_with(self) -> None:
        built_with = {relation["spdxElementId"] for relation in self.document["relationships"] if relation["relationshipType"] == "BUILD_DEPENDENCY_OF"}
        texts = {info["licenseId"] for info in self.document["hasExtractedLicensingInfos"]}
        for package in self.packages:
            licence = package["licenseDeclared"]
            if package["SPDXID"] in built_with:
                self.assertNotEqual(licence, "NOASSERTION", package["name"])
            if licence.startswith("LicenseRef-"):
                self.assertIn(licence, texts)

    def test_names_what_the_hands_are_derived_from(self) -> None:
        hand = next(package for package in self.packages if package["name"] == "@webxr-input-profiles/assets")
        self.assertEqual((hand["versionInfo"], hand["licenseDeclared"]), ("1.0.20", "MIT"))

    def test_is_the_same_each_time(self) -> None:
        self.assertEqual(bill_of_materials(), self.document)


if __name__ == "__main__":
    unittest.main()
