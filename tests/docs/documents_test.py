# SPDX-License-Identifier: Apache-2.0
"""The documents: links and anchors, in Markdown and in the built site; abbreviations; pictures; the index.

documents_test.py ROOT [PROGRAM]
"""
import html
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(sys.argv[1]).resolve()
PROGRAM = sys.argv[2] if len(sys.argv) > 2 else ""
sys.path.insert(0, str(ROOT / "scripts/site"))
sys.dont_write_bytecode = True
import markdown  # noqa: E402

ABBREVIATION = re.compile(r"\b[A-Z][A-Z0-9]*[A-Z0-9](?:[-/_][A-Z0-9]+)*\b|\b[A-Z]-[A-Z]\b")
GRASP = re.compile(r"T?I?M?R?L?")  # letters of the digits, in this order (docs/grasps.md)
DOCUMENTS = {path: markdown.Document(ROOT, path) for path in markdown.documents(ROOT)}


def prose(document):
    """Text without code."""
    body = re.sub(r"<pre>.*?</pre>|<code>.*?</code>", " ", document.body, flags=re.S)
    return markdown.plain(re.sub(r"<(td|th|li|p|br|h\d)\b", r" <\1", body))


def parts(abbreviation):
    """HKDF-SHA256 is explained by its parts."""
    return {abbreviation, *re.split(r"[-/_]", abbreviation)}


def unexplained(text, explained):
    return sorted({found for found in ABBREVIATION.findall(text)
                   if found not in explained and not GRASP.fullmatch(found) and not all(part in explained or part.isdigit() for part in re.split(r"[-/_]", found))})


def explained_words():
    words = set()
    for line in (ROOT / "tests/docs/not_abbreviations.txt").read_text(encoding="utf-8").splitlines():
        words |= set(line.split("#")[0].split())
    for term in re.findall(r"<tr>\s*<td>(.*?)</td>", DOCUMENTS[Path("docs/glossary.md")].body, re.S):
        for found in ABBREVIATION.findall(markdown.plain(term)):
            words |= parts(found)
    return words


class Markdown(unittest.TestCase):
    def test_every_link_and_anchor_leads_somewhere(self):
        self.assertGreater(len(DOCUMENTS), 40)
        dead, links = [], 0
        for path, document in DOCUMENTS.items():
            for target, anchor in document.links():
                links += 1
                if not (ROOT / target).exists():
                    dead.append(f"{path}: {target}")
                elif anchor and (target not in DOCUMENTS or anchor not in DOCUMENTS[target].anchors):
                    dead.append(f"{path}: {target}#{anchor}")
        self.assertEqual(dead, [])
        self.assertGreater(links, 500)

    def test_a_link_to_nowhere_would_be_found(self):
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "a.md").write_text("# One word\n\n[a](b.md) [b](#one-word) [c](#two)\n", encoding="utf-8")
            document = markdown.Document(Path(folder), Path("a.md"))
            self.assertEqual(list(document.links())[-3:], [(Path("b.md"), ""), (Path("a.md"), "one-word"), (Path("a.md"), "two")])
            self.assertEqual(document.anchors, {"one-word"})

    def test_every_page_of_docs_is_in_the_index(self):
        listed = {target for target, _ in DOCUMENTS[Path("docs/README.md")].links()}
        missing = [str(path) for path in DOCUMENTS if path.parts[0] == "docs" and path != Path("docs/README.md") and path not in listed]
        self.assertEqual(missing, [])


class Demo(unittest.TestCase):
    def test_it_names_the_command_that_made_its_recording(self):
        facts = json.loads((ROOT / "web/demo/recording.json").read_text(encoding="utf-8"))
        options = re.search(r"^recorded=\((.*)\)$", (ROOT / "scripts/demo").read_text(encoding="utf-8"), re.M).group(1)
        self.assertIn(f"./run run {options} --record DIR", facts["commands"])

    def test_readme_begins_with_it_and_says_what_is_simulated(self):
        begin = "\n".join((ROOT / "README.md").read_text(encoding="utf-8").splitlines()[:15])
        self.assertIn("(docs/pictures/demo.webp)", begin)
        self.assertIn("the exoskeleton, the patient's hand and the teapot are simulated", begin)
        self.assertLessEqual((ROOT / "docs/pictures/demo.webp").stat().st_size, 1_500_000)


class Glossary(unittest.TestCase):
    def test_every_abbreviation_is_explained(self):
        explained = explained_words()
        missing = {}
        for path, document in DOCUMENTS.items():
            if path in (Path("README.md"), Path("SECURITY.md"), Path("CONTRIBUTING.md")) or path.parts[0] == "docs" and path.name != "glossary.md":
                for word in unexplained(prose(document), explained):
                    missing.setdefault(word, []).append(str(path))
        self.assertEqual(missing, {}, "give each a line in docs/glossary.md, or list it in tests/docs/not_abbreviations.txt")

    def test_an_abbreviation_without_a_line_would_be_found(self):
        self.assertEqual(unexplained("The HCP, the XYZ and a D-H table of TIM; HKDF-QQQ", {"HCP", "HKDF"}), ["D-H", "HKDF-QQQ", "XYZ"])

    def test_every_exception_occurs(self):
        everything = " ".join(prose(document) for document in DOCUMENTS.values())
        used = set()
        for found in ABBREVIATION.findall(everything):
            used |= parts(found)
        text = re.sub(r"#.*", "", (ROOT / "tests/docs/not_abbreviations.txt").read_text(encoding="utf-8"))
        self.assertEqual([word for word in text.split() if word not in used], [])


    def test_each_term_is_defined_once_in_a_table(self):
        twice = []
        for table in re.findall(r"<table>(.*?)</table>", DOCUMENTS[Path("docs/glossary.md")].body, re.S):
            terms = [markdown.plain(term).strip() for term in re.findall(r"<tr>\s*<td>(.*?)</td>", table, re.S)]
            twice += sorted({term for term in terms if terms.count(term) > 1})
        self.assertEqual(twice, [])


def manual(text):
    """Command -> its options, from the manual page: {"session prune": {"--yes", ...}}."""
    commands, options = {}, set()
    for line in text.replace("\\-", "-").splitlines():
        if found := re.match(r'\.SS "?phalanx ([^"]*)"?', line):
            options = commands.setdefault(found.group(1).strip(), {"--help", "-h"})
        elif line.startswith("\\fB"):
            options |= set(re.findall(r"(?<![\w-])--?[a-z][\w-]*", line[3:].partition("\\fR")[0]))
    return commands


def wrong_commands(text, commands):
    """Lines of fenced code that name a command or an option that the program does not have."""
    wrong = []
    for block in re.findall(r"^```[^\n]*\n(.*?)^```", text, re.M | re.S):
        for line in block.replace("\\\n", " ").splitlines():
            for call in re.split(r"\s[&|]+\s|;\s", re.sub(r"(^|\s)#.*", "", line)):
                found = re.match(r"\s*(?:sudo (?:-u \w+ )?)?(?:\./run|phalanx)(?:\s+(.*))?$", call)
                words = (found.group(1) or "").split() if found else []
                if not words or words[0] in ("--help", "-h", "--version", "=", "->"):
                    continue
                if words[0].startswith("-"):
                    words.insert(0, "run")
                command = next((name for name in (" ".join(words[:2]), words[0]) if name in commands), None)
                groups = {name.split()[0] for name in commands if " " in name}
                if command is None or command in groups and len(words) > 1 and re.fullmatch(r"[a-z-]*[a-z]", words[1]) and f"{command} {words[1]}" not in commands:
                    wrong.append(f"{call.strip()}: no such command")
                    continue
                if command in groups:
                    continue  # the manual page lists the commands below it, and not its own options
                wrong += [f"{call.strip()}: no option {word}" for word in words if re.match(r"--[a-z]", word) and word.partition("=")[0] not in commands[command]]
    return wrong


class Commands(unittest.TestCase):
    def test_the_program_has_every_command_and_option_of_the_documents(self):
        if not PROGRAM:
            self.skipTest("no program was named")
        commands = manual(subprocess.run([PROGRAM, "man"], capture_output=True, text=True, check=True).stdout)
        self.assertIn("--yes", commands["session prune"])
        wrong = {}
        for path in DOCUMENTS:
            if path == Path("README.md") or path.parts[0] == "docs":
                if found := wrong_commands((ROOT / path).read_text(encoding="utf-8"), commands):
                    wrong[str(path)] = found
        self.assertEqual(wrong, {})

    def test_a_wrong_one_would_be_found(self):
        commands = manual('.SS "phalanx run"\n\\fBscene\\fR TEXT\n\\fB\\-\\-data\\fR DIR\n.SS "phalanx session prune"\n\\fB\\-\\-yes\\fR\n')
        self.assertEqual(commands, {"run": {"-h", "--help", "--data"}, "session prune": {"-h", "--help", "--yes"}})
        text = "```\n./run --data a  # --not\n./run first_touch --data a\nphalanx session prune --no & phalanx session prune --yes\n```\n"
        self.assertEqual(wrong_commands(text, commands), ["./run first_touch --data a: no such command", "phalanx session prune --no: no option --no"])


class Pictures(unittest.TestCase):
    def test_each_is_listed_with_what_makes_it(self):
        rows = re.findall(r"<tr>\s*<td>(.*?)</td>\s*<td>(.*?)</td>", DOCUMENTS[Path("docs/pictures/README.md")].body, re.S)
        listed = {markdown.plain(name): markdown.plain(how) for name, how in rows}
        there = {file.name for file in (ROOT / "docs/pictures").iterdir() if file.suffix != ".md"}
        self.assertEqual(set(listed), there)
        unmade = [name for name, how in listed.items() if not re.search(r"\./run |\./test |scripts/demo|vite-node", how)]
        self.assertEqual(unmade, ["contact_search.svg"], "the one drawing that shows no data")

    def test_the_script_reads_the_same_table(self):
        said = subprocess.run([ROOT / "scripts/pictures"], capture_output=True, text=True, check=True).stdout.splitlines()
        self.assertEqual({line.split()[0] for line in said}, {file.name for file in (ROOT / "docs/pictures").iterdir() if file.suffix != ".md"})
        self.assertTrue(any(line.endswith("./run simulate grasp_teapot --out OUT/run --plot") for line in said))

    def test_a_picture_of_the_program_has_the_same_bytes_when_it_is_made_again(self):
        if not PROGRAM:
            self.skipTest("no program was named")
        done = subprocess.run([ROOT / "scripts/pictures", "--check", "felt_stiffness.svg"],
                              capture_output=True, text=True, env={**os.environ, "PHALANX_PROGRAM": PROGRAM})
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_each_is_shown_somewhere(self):
        shown = {target.name for document in DOCUMENTS.values() for target, _ in document.links()}
        self.assertEqual([file.name for file in (ROOT / "docs/pictures").iterdir() if file.name not in shown and file.suffix != ".md"], [])


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = Path(cls.folder.name, "site")
        subprocess.run([ROOT / "scripts/docs_site", cls.out, "--no-demo"], check=True, capture_output=True, text=True)
        cls.pages = {page.relative_to(cls.out): page.read_text(encoding="utf-8") for page in cls.out.rglob("*.html")}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_every_link_and_anchor_leads_somewhere(self):
        anchors = {page: set(re.findall(r'\sid="([^"]+)"', text)) for page, text in self.pages.items()}
        dead = []
        for page, text in self.pages.items():
            for target in (html.unescape(one) for one in re.findall(r'\s(?:href|src)="([^"]*)"', text)):
                if markdown.ELSEWHERE.match(target):
                    continue
                name, _, anchor = target.partition("#")
                file = (self.out / page.parent / name).resolve() if name else self.out / page
                if not file.is_file():
                    dead.append(f"{page}: {target}")
                elif anchor and anchor not in anchors[file.relative_to(self.out.resolve()) if name else page]:
                    dead.append(f"{page}: {target}")
        self.assertEqual(dead, [])
        self.assertGreater(len(self.pages), 60)

    def test_nothing_is_loaded_from_a_network(self):
        for page, text in self.pages.items():
            self.assertEqual(re.findall(r'<(?:script|link|img|iframe)[^>]*(?:src|href)="(?:https?:)?//[^"]*"', text), [], page)
            self.assertIn("default-src 'none'", text)
        self.assertNotRegex((self.out / "site.css").read_text(encoding="utf-8"), r"url\(|@import")
        self.assertNotRegex((self.out / "site.js").read_text(encoding="utf-8"), r"fetch\(|XMLHttpRequest|WebSocket|https?:")

    def test_the_search_knows_every_document_and_header(self):
        index = (self.out / "search_index.js").read_text(encoding="utf-8")
        for page in self.pages:
            if page.parts[0] != "source" and page != Path("api/index.html"):
                self.assertIn(f'["{page}",', index)
        self.assertIn('"step"', index)

    def test_a_build_that_failed_does_not_stop_the_next_one(self):
        out = Path(self.folder.name, "failed")
        failed = subprocess.run([ROOT / "scripts/docs_site", out, "--no-demo"], capture_output=True, text=True,
                                env={**os.environ, "PATH": f"{self.broken_doxygen()}:{os.environ['PATH']}"})
        self.assertNotEqual(failed.returncode, 0)
        self.assertFalse(out.exists())
        self.assertEqual([one.name for one in out.parent.iterdir() if one.name.startswith(".")], [])

    def broken_doxygen(self):
        folder = Path(self.folder.name, "broken")
        folder.mkdir(exist_ok=True)
        (folder / "doxygen").write_text("#!/bin/sh\nexit 1\n", encoding="utf-8")
        (folder / "doxygen").chmod(0o755)
        return folder

    def test_public_headers_are_described(self):
        step = self.pages[Path("api/step/haptic_step.h.html")]
        self.assertIn("one tick of the whole", step)
        self.assertIn('href="../hand/hand_model.h.html#HandModel"', step)

    @unittest.skipUnless(os.environ.get("PHALANX_FULL"), "a second build belongs to ./test --full")
    def test_two_builds_have_the_same_bytes(self):
        again = Path(self.folder.name, "again")
        subprocess.run([ROOT / "scripts/docs_site", again, "--no-demo"], check=True, capture_output=True, text=True)
        files = {file.relative_to(self.out) for file in self.out.rglob("*") if file.is_file()}
        self.assertEqual(files, {file.relative_to(again) for file in again.rglob("*") if file.is_file()})
        self.assertEqual([str(file) for file in sorted(files) if (self.out / file).read_bytes() != (again / file).read_bytes()], [])


class Headers(unittest.TestCase):
    def test_a_warning_of_doxygen_is_an_error(self):
        import api
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            (root / "include/phalanx").mkdir(parents=True)
            (root / "scripts/site").mkdir(parents=True)
            (root / "scripts/site/Doxyfile").write_bytes((ROOT / "scripts/site/Doxyfile").read_bytes())
            (root / "include/phalanx/a.h").write_text("/// Adds.\n/// @param c  is not there\nint add(int a, int b);\n", encoding="utf-8")
            with self.assertRaises(SystemExit) as refused:
                api.run_doxygen(root, ["a.h"], root)
            self.assertIn("a.h:1", str(refused.exception))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]], verbosity=1)
