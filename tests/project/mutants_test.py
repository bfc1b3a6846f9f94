#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""mutants_test.py ROOT : scripts/mutants on a source file made here. Nothing is compiled."""

import importlib.machinery
import importlib.util
import sys
import tempfile
import unittest
import unittest.mock
from pathlib import Path

sys.dont_write_bytecode = True
SCRIPTS = Path(sys.argv.pop(1)) / "scripts"
sys.path.insert(0, str(SCRIPTS))
import mutant_draw

loader = importlib.machinery.SourceFileLoader("mutants", str(SCRIPTS / "mutants"))
spec = importlib.util.spec_from_loader("mutants", loader)
mutants = importlib.util.module_from_spec(spec)
sys.modules["mutants"] = mutants
loader.exec_module(mutants)

# Nothing here may be changed; the lines of CODE follow after an empty one.
NOTHING = r"""// a < b && c == 1
/* return 1 + 2;
   x = -3; */
#include <cmath>
#define TWICE(x) \
  ((x) + 2)
const char* text = "a == b && 1 + 2 // no comment";
const char* raw = R"x(a < 1 + "2" )x";
char letter = '"'; char other = '+';
static_assert(sizeof(int) >= 4 && true);
template <int N = 3, bool B = true>
std::vector<int>* made(std::vector<int>&& from, Type const* at);
assert(a < 3
       && b == 4);
[[gnu::aligned(8)]] extern int aligned;
std::array<double, 3> three;
"""
CODE = {
    "if (a < b && c) return;": {"comparison": ["if (a <= b && c) return;", "if (a > b && c) return;"],
                                "logic": ["if (a < b || c) return;"],
                                "statement": ["if (a < b && c) ;"]},
    "x += -y * *p->z;  // adds 1": {"arithmetic": ["x -= -y * *p->z;  // adds 1", "x += -y / *p->z;  // adds 1"],
                                    "sign": ["x += y * *p->z;  // adds 1"],
                                    "statement": [";  // adds 1"]},
    "double limit = 1.5;": {"constant": ["double limit = 3.0;", "double limit = 2.5;", "double limit = 0.0;"]},
    "const bool off = !on;": {"not": ["const bool off = on;"]},
    'say("a == 2", std::min(a, b));': {"swap": ['say("a == 2", std::max(a, b));'], "statement": [";"]},
    "done = true;": {"boolean": ["done = false;"], "statement": [";"]},
    "return a == b;": {"comparison": ["return a != b;"], "return": ["return {};", "return !(a == b);"]},
    'return "";': {"return": ['return "?";']},
    "return std::nullopt;": {},
    'return "text";': {"return": ["return {};"]},
    "int count = 1'000;": {"constant": ["int count = 2000;", "int count = 1001;", "int count = 0;"]},
    "double hex = 0x1p-10;": {},
    "Type object(argument);": {},
    "Type(const Type&) = delete;": {},
}
SOURCE = NOTHING + "\n" + "\n".join(CODE) + "\n"


class Operators(unittest.TestCase):
    def test_comments_strings_assertions_and_types_are_left_alone(self) -> None:
        self.assertEqual({line: found for line, found in mutant_draw.mutants_of("made.cpp", SOURCE).items() if line <= 17}, {})

    def test_each_line_has_the_mutants_of_its_operators(self) -> None:
        found = mutant_draw.mutants_of("made.cpp", SOURCE)
        for line, (text, expected) in enumerate(CODE.items(), start=18):
            by_operator: dict[str, list[str]] = {}
            for mutant in found.get(line, []):
                self.assertEqual(mutant.before, text)
                by_operator.setdefault(mutant.operator, []).append(mutant.after)
            self.assertEqual(by_operator, expected, text)

    def test_blanked_text_keeps_its_length_and_lines(self) -> None:
        blanked = mutant_draw.blank(SOURCE)
        self.assertEqual([len(line) for line in blanked.split("\n")], [len(line) for line in SOURCE.split("\n")])


class Watched(unittest.TestCase):
    def watch(self, script: str) -> tuple[str, set[str]]:
        """@returns the verdict and the tests that passed"""
        verdict, seconds = self.watch_seconds(script)
        return verdict, set(seconds)

    def watch_seconds(self, script: str) -> tuple[str, dict[str, float]]:
        with tempfile.TemporaryDirectory() as place:
            run = mutants.Run(["bash", "-c", script], place, {}, {"A.one": 0.01, "A.two": 0.01, "A.three": 0.01})
            return mutants.watch(run, Path(place), True)

    def test_the_test_that_failed_is_named_and_not_one_that_was_skipped_after_it(self) -> None:
        script = r"""printf '[ RUN      ] A.one\n[       OK ] A.one (30 ms)\n[ RUN      ] A.two\n[  FAILED  ] A.two (1 ms)\n'
                     printf '[ RUN      ] A.three\n[  SKIPPED ] A.three (0 ms)\n[  FAILED  ] 1 test, listed below:\n'; exit 1"""
        self.assertEqual(self.watch(script), ("A.two", {"A.one"}))

    def test_a_crash_is_laid_to_the_test_that_ran(self) -> None:
        script = r"""printf '[ RUN      ] A.one\n[       OK ] A.one (0 ms)\n[ RUN      ] A.two\n'; kill -SEGV $$"""
        self.assertEqual(self.watch(script), ("A.two (crashes)", {"A.one"}))

    def test_a_test_that_waits_and_one_that_computes_without_end_hang(self) -> None:
        for least, script in (("LEAST_SECONDS", "exec sleep 600"), ("LEAST_PROCESSOR_SECONDS", "while :; do :; done")):
            with unittest.mock.patch.object(mutants, least, 0.1):
                self.assertEqual(self.watch(r"printf '[ RUN      ] A.one\n'; " + script), ("A.one (hangs)", set()), least)

    def test_what_passes_kills_nothing(self) -> None:
        script = r"""for test in one two three; do printf '[ RUN      ] A.%s\n[       OK ] A.%s (0 ms)\n' $test $test; done"""
        self.assertEqual(self.watch(script), ("", {"A.one", "A.two", "A.three"}))

    def test_a_program_that_ends_before_its_last_test_does_not_pass(self) -> None:
        script = r"""printf '[ RUN      ] A.one\n[       OK ] A.one (0 ms)\n[ RUN      ] A.two\n'; exit 0"""
        self.assertEqual(self.watch(script), ("A.two (does not pass)", {"A.one"}))

    def test_a_test_that_is_skipped_neither_passes_nor_kills(self) -> None:
        script = r"""printf '[ RUN      ] A.one\n[       OK ] A.one (0 ms)\n[ RUN      ] A.two\n[  SKIPPED ] A.two (0 ms)\n'
                     printf '[ RUN      ] A.three\n[       OK ] A.three (0 ms)\n'"""
        self.assertEqual(self.watch(script), ("", {"A.one", "A.three"}))

    def test_seconds_are_measured_here_and_not_by_a_program_whose_clock_is_held(self) -> None:
        script = r"""printf '[ RUN      ] A.one\n[       OK ] A.one (3600000 ms)\n'; exit 1"""
        self.assertLess(self.watch_seconds(script)[1]["A.one"], 3600.0)


class Listed(unittest.TestCase):
    def test_a_listing_names_the_cases_of_plain_and_parameterised_suites(self) -> None:
        listing = ("Running main() from gtest_main.cc\nGdp.\n  Stops\n  DISABLED_Later\nFiles/Sweep.\n  Over/0  # GetParam() = a. b\n"
                   "Typed/0.  # TypeParam = double\n  Holds\n")
        self.assertEqual(mutants.cases_of(listing), ["Gdp.Stops", "Files/Sweep.Over/0", "Typed/0.Holds"])

    def test_a_build_tree_without_tests_is_an_error_and_no_survivor(self) -> None:
        with tempfile.TemporaryDirectory() as place:
            copy = mutants.Copy(Path(place), Path(place))
            copy.build.mkdir(parents=True)
            (copy.build / "test_programs.txt").write_text("")
            with self.assertRaises(SystemExit):
                mutants.Tests(copy, 1).listed("force")


class MadeTree(unittest.TestCase):
    def setUp(self) -> None:
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.root = Path(kept.name) / "checkout"
        for name in ("src/force/one.cpp", "src/force/two.cpp", "include/phalanx/force/three.h", "src/hand/other.cpp"):
            path = self.root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(SOURCE)

    def drawn(self, seed: int) -> list[str]:
        return [mutant.name for mutant in mutant_draw.draws("force", seed, self.root)]

    def test_a_seed_draws_the_same_mutants_and_each_once(self) -> None:
        first = self.drawn(7)
        self.assertEqual(first, self.drawn(7))
        self.assertNotEqual(first, self.drawn(8))
        self.assertEqual(sorted(first), sorted(set(first)))
        per_file = sum(len(after) for operators in CODE.values() for after in operators.values())
        self.assertEqual(len(first), 3 * per_file)
        self.assertFalse([name for name in first if "other" in name])

    def test_a_pattern_without_a_file_is_an_error(self) -> None:
        self.assertEqual(len(mutant_draw.sources_of("force", self.root)), 3)
        with self.assertRaises(SystemExit):
            mutant_draw.sources_of("import", self.root)

    def test_a_mutant_is_in_the_copy_alone_and_is_put_back_with_its_time(self) -> None:
        copy = mutants.Copy(self.root, Path(self.root.parent) / "place")
        source, program = copy.tree / "src/force/one.cpp", copy.build / "bin/program"
        for path, text in ((source, SOURCE), (program, "as linked"), (copy.build / "one.o", "as compiled")):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        before = {path: path.stat().st_mtime_ns for path in copy.tree.rglob("*") if path.is_file()}
        mutant = next(each for each in mutant_draw.draws("force", 1, self.root) if each.file == "src/force/one.cpp")
        copy.put(mutant, ["one.o"])
        self.assertEqual(source.read_text(), SOURCE.replace(mutant.before, mutant.after, 1))
        self.assertEqual((self.root / mutant.file).read_text(), SOURCE)
        self.assertFalse((copy.build / "one.o").exists())
        (copy.build / "one.o").write_text("as compiled with the mutant")
        program.unlink()
        program.write_text("as linked with the mutant")
        copy.restore()
        self.assertEqual(source.read_text(), SOURCE)
        self.assertEqual(program.read_text(), "as linked")
        self.assertEqual((copy.build / "one.o").read_text(), "as compiled")
        self.assertEqual({path: path.stat().st_mtime_ns for path in copy.tree.rglob("*") if path.is_file()}, before)

    def test_an_equivalent_mutant_is_known_by_its_text_and_needs_an_argument(self) -> None:
        mutant = next(mutant_draw.draws("force", 1, self.root))
        listed = Path(self.root) / "equivalent"
        listed.write_text(f"# why\n\n# line 3\n{mutant.diff}\nBoth give the same.\n")
        self.assertEqual(mutant_draw.argued(listed), {mutant.diff: "Both give the same."})
        listed.write_text(mutant.diff + "\n")
        with self.assertRaises(SystemExit):
            mutant_draw.argued(listed)

    def test_an_equivalent_mutant_is_known_whatever_the_comment_of_its_line(self) -> None:
        one, other = (mutant_draw.mutants_of("made.cpp", f'  say("// no", 1\'000);{comment}')[1][0] for comment in ("  // \"why\"", ""))
        self.assertEqual(one.diff, other.diff)
        self.assertIn('- say("// no", 1\'000);\n', one.diff)


class Sources(unittest.TestCase):
    def test_each_pattern_names_files_of_this_tree(self) -> None:
        for folder in mutant_draw.ALL_FOLDERS:
            self.assertTrue(mutant_draw.sources_of(folder, SCRIPTS.parent), folder)

    def test_the_import_has_the_repair_of_meshes(self) -> None:
        self.assertIn("src/mesh/repair/weld.cpp", mutant_draw.sources_of("import", SCRIPTS.parent))


def stale(entry: str, root: Path) -> bool:
    """@returns true if no mutant of the file has the entry's operator and its lines before and after"""
    file = entry.split()[0]
    path = root / file
    return not path.exists() or all(entry != mutant.diff for found in mutant_draw.mutants_of(file, path.read_text()).values() for mutant in found)


class Equivalent(unittest.TestCase):
    def test_each_listed_mutant_occurs_in_its_file(self) -> None:
        listed = mutant_draw.argued(SCRIPTS / "mutants.equivalent")
        self.assertTrue(listed)
        self.assertEqual([entry for entry in listed if stale(entry, SCRIPTS.parent)], [])

    def test_a_mutant_of_a_line_that_has_changed_is_stale(self) -> None:
        with tempfile.TemporaryDirectory() as place:
            (Path(place) / "made.cpp").write_text("done = true;  // now\n")
            self.assertFalse(stale("made.cpp boolean\n- done = true;\n+ done = false;", Path(place)))
            self.assertTrue(stale("made.cpp boolean\n- ended = true;\n+ ended = false;", Path(place)))
            self.assertTrue(stale("gone.cpp boolean\n- done = true;\n+ done = false;", Path(place)))


if __name__ == "__main__":
    unittest.main()
