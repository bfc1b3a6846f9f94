# SPDX-License-Identifier: Apache-2.0
"""Which one-line faults the sources allow, and the order in which a seed draws them. Nothing is built or run here; see scripts/mutants."""

from __future__ import annotations

import random
import re
import sys
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path

# Name: (target in percent, folders of tests in the order in which they are run, sources). What no draw asks for is for --folder alone.
IMPORT = "import weld repair assimp_reader obj_reduce isolated isolation_helper index_check shells pipe_io t_junctions open_edges edge_table"
FOLDERS: dict[str, tuple[int, str, list[str]]] = {
    "contact": (95, "contact step scene device simulation study papers figures station", ["*/contact/*"]),
    "force": (95, "force step device simulation scene study papers figures station", ["*/force/*"]),
    "hand": (90, "hand contact step scene device simulation study papers figures apps", ["*/hand/*"]),
    "step": (95, "step device simulation scene station study papers figures", ["*/step/*"]),
    "safety": (95, "station faults serve", ["*/station/safety*", "*/station/sensor_watch*"]),
    "link": (95, "device/link device simulation station faults", ["*/device/link/*"]),
    "import": (90, "mesh scene step serve study papers figures apps", ["*/mesh/import.h"] + [f"*/mesh/*/{name}.*" for name in IMPORT.split()]),
    "scene": (90, "scene study papers figures device simulation station serve apps", ["*/scene/*"]),
    "serve": (90, "serve faults apps", ["*/serve/*"]),
    "study": (90, "study papers figures simulation apps",
              ["*/study/*", "*/papers/*", "*/figures/*", "*/simulation/closed_loop/*"]),
    "record": (90, "record study papers figures station apps", ["*/record/*"]),
}
FURTHER: dict[str, tuple[int, str, list[str]]] = {
    "core": (90, "core hand contact force step scene", ["*/core/*"]),
    "device": (90, "device simulation scene study papers figures station faults apps", ["src/device/*.*", "include/phalanx/device/*.h"]),
    "grasp": (90, "grasp apps", ["*/grasp/*"]),
    "gloves": (90, "device/opengloves device simulation faults apps", ["*/device/opengloves/*"]),
    "simulation": (90, "simulation device scene study papers figures station faults apps", ["*/simulation/*"]),
    "mesh": (90, "mesh scene step study papers figures", ["*/mesh/*"]),
    "station": (90, "station serve faults", ["*/station/*"]),
}
ALL_FOLDERS = FOLDERS | FURTHER
OVERALL_TARGET = 90

SWAPS = [("std::min", "std::max"), ("std::sin", "std::cos"), ("cwiseMin", "cwiseMax"), ("minCoeff", "maxCoeff"), ("std::floor", "std::ceil"),
         ("std::any_of", "std::all_of"), ("std::lower_bound", "std::upper_bound")]
COMPARISONS = {"<": ["<=", ">"], "<=": ["<", ">"], ">": [">=", "<"], ">=": [">", "<"], "==": ["!="], "!=": ["=="]}
ARITHMETIC = {"+": "-", "-": "+", "*": "/", "/": "*", "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*="}
PATH = r"\*?[A-Za-z_][\w:]*(?:(?:\.|->)\w+|\[[^\]]*\]|\([^()]*\))*"  # a variable, member or element, without a type before it
STATEMENT = re.compile(rf"(?:{PATH} (?:[-+*/|&^]|<<|>>)?= .*|(?:\+\+|--){PATH}|{PATH}(?:\+\+|--)|{PATH}\(.*\)|{PATH}\.\w+\(.*\))")
GUARDED = re.compile(r"(?:return\b.*|continue|break)")
NUMBER = re.compile(r"(?<![\w.'])(?<![pP][-+])(?P<digits>\d[\d']*(?P<fraction>\.[\d']*)?(?:[eE][+-]?\d+)?)(?P<suffix>[A-Za-z]*)(?![\w.'])")


@dataclass(frozen=True)
class Mutant:
    file: str
    line: int  # from 1
    operator: str
    number: int  # which of this operator's changes of the line
    before: str
    after: str

    @property
    def name(self) -> str:
        return f"{self.file}:{self.line}:{self.operator}.{self.number}"

    @property
    def shown(self) -> str:
        return f"{self.name}: `{self.before.strip()}` -> `{self.after.strip()}`"

    @property
    def diff(self) -> str:
        return f"{self.file} {self.operator}\n- {code_of(self.before)}\n+ {code_of(self.after)}".rstrip()


def code_of(line: str) -> str:
    """The line without its indentation and without a comment that ends it."""
    token = r'"(?:\\.|[^"\\])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\])+\'|//.*'
    return re.sub(token, lambda match: "" if match[0].startswith("//") else match[0], line).strip()


def blank(text: str) -> str:
    """As many characters in as many lines, with spaces for comments, literals of text, preprocessor lines, assertions and template heads."""
    token = re.compile(
        r'//(?:\\\n|[^\n])*|/\*.*?\*/|R"(?P<raw>[^(\s]*)\(.*?\)(?P=raw)"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\''
        r"|^[ \t]*#(?:\\\n|[^\n])*", re.DOTALL | re.MULTILINE)

    def spaces(found: str) -> str:
        return re.sub(r"[^\n]", " ", found)

    text = token.sub(lambda match: spaces(match[0]), text)
    for head in re.finditer(r"\b(?:static_assert|assert|decltype|noexcept|requires|alignas)\s*(?=\()|\btemplate\s*(?=<)|\[(?=\[)", text):
        end = closing(text, head.end())
        text = text[: head.start()] + spaces(text[head.start() : end]) + text[end:]
    return text


def closing(text: str, start: int) -> int:
    """Where the bracket that opens at `start` is closed, one past it."""
    opening = text[start]
    closed = {"(": ")", "<": ">", "[": "]", "{": "}"}[opening]
    depth = 0
    for at in range(start, len(text)):
        depth += (text[at] == opening) - (text[at] == closed)
        if depth == 0:
            return at + 1
    return len(text)


def other_numbers(match: re.Match[str]) -> list[str]:
    digits, suffix = match["digits"].replace("'", ""), match["suffix"]
    if digits == "0" and suffix[:1] in ("x", "X", "b"):
        return []
    if match["fraction"] is None and "e" not in digits.lower():
        value = int(digits)
        return [f"{other}{suffix}" for other in dict.fromkeys([2 * value, value + 1, 0]) if other != value]
    number = float(digits)
    return [f"{other!r}{suffix}" for other in dict.fromkeys([2.0 * number, number + 1.0, 0.0]) if other != number]


def inner_statement(code: str) -> tuple[int, bool]:
    """Where the statement of a line begins behind `if (...)`, `for (...)` or `else`, and whether there is such a condition."""
    at, guarded = len(code) - len(code.lstrip()), False
    while match := re.compile(r"(?:\}?\s*else\b(?! *\{)|(?:if(?: constexpr)?|for|while) (?=\())\s*").match(code, at):
        at = match.end()
        if code[at : at + 1] == "(":
            at = closing(code, at)
        at += len(code[at:]) - len(code[at:].lstrip())
        guarded = True
    return at, guarded


def changes_of_line(code: str, previous: str, is_c: bool) -> Iterator[tuple[str, int, int, str]]:
    """(operator, first column, end column, new text) of each change that a line allows. `code` is blanked, `previous` the code before it."""
    for match in re.finditer(r"(?<= )(<=?|>=?|==|!=)(?= |$)", code):
        for other in COMPARISONS[match[0]]:
            yield "comparison", *match.span(), other
    for match in re.finditer(r"(?<=[\w)\]\"'}] )([-+*/]=?)(?= |$)", code):
        yield "arithmetic", *match.span(), ARITHMETIC[match[0]]
    for match in re.finditer(r"(?<![\w)\]\-])-(?=[A-Za-z0-9_(.])", code):
        yield "sign", *match.span(), ""
    for match in re.finditer(r"(?<= )(&&|\|\|)(?= |$)", code):
        yield "logic", *match.span(), "||" if match[0] == "&&" else "&&"
    for match in re.finditer(r"!(?=[\w(:])", code):
        yield "not", *match.span(), ""
    for match in NUMBER.finditer(code):
        if code[match.end() : match.end() + 1] != ">" and code[: match.start()][-1:] != "<":
            for other in other_numbers(match):
                yield "constant", *match.span(), other
    for match in re.finditer(r"\b(true|false)\b", code):
        yield "boolean", *match.span(), "false" if match[0] == "true" else "true"
    for one, two in SWAPS:
        for match in re.finditer(rf"\b({one}|{two})\b", code):
            yield "swap", *match.span(), two if match[0] == one else one
    if match := re.search(r"\breturn ([^;{}]+);", code):
        value = match[1]
        if value not in ("0", "0.0", "false", "nullptr", "std::nullopt"):
            yield "return", *match.span(1), "0" if is_c else "{}"
        if re.search(r" (&&|\|\||==|!=|<=?|>=?) |^!", value):
            yield "return", *match.span(1), f"!({value})"
    at, guarded = inner_statement(code)
    statement = code[at:].rstrip()
    if statement.endswith(";") and statement.count(";") == 1 and statement.count("(") == statement.count(")"):
        starts = guarded or previous[-1:] in ("", ";", "{", "}") or re.search(r"\b(else|public|private|case [^?]*|default):?$", previous)
        controlled = previous.endswith(")") and re.match(r"\s*\}?\s*(else )?(if|for|while)\b", previous.splitlines()[-1])
        removable = STATEMENT.fullmatch(statement[:-1]) and not re.search(r"^(static_cast|return|throw|delete|using)\b|= (delete|default);$", statement)
        if (starts or controlled) and (removable or (guarded and GUARDED.fullmatch(statement[:-1]))):
            yield "statement", at, at + len(statement), ";"


def mutants_of(file: str, text: str) -> dict[int, list[Mutant]]:
    """All one-line mutants of a source file, by line."""
    found: dict[int, list[Mutant]] = {}
    previous = ""
    for line, (code, source) in enumerate(zip(blank(text).split("\n"), text.split("\n")), start=1):
        count: dict[str, int] = defaultdict(int)
        for operator, start, end, new in changes_of_line(code, previous, file.endswith(".c")):
            if operator == "return" and source[start:end] == '""':
                new = '"?"'  # {} is the same text
            new = source[start:end].join(new.split(code[start:end])) if operator == "return" and new[0] == "!" else new
            count[operator] += 1
            after = source[:start] + new + source[end:]
            found.setdefault(line, []).append(Mutant(file, line, operator, count[operator], source, after))
        previous = code.rstrip() or previous
    return found


def sources_of(folder: str, root: Path) -> list[str]:
    """The source files of a folder of mutants. A pattern that no file matches is an error: its files were renamed or moved."""
    files = [path for top in ("src", "include") for path in (root / top).rglob("*") if path.suffix in (".cpp", ".c", ".h")]
    names = sorted(path.relative_to(root).as_posix() for path in files)
    patterns = ALL_FOLDERS[folder][2]
    for pattern in patterns:
        if not any(fnmatch(name, pattern) for name in names):
            sys.exit(f"{folder}: no source file matches {pattern}; correct it in scripts/mutant_draw.py")
    return [name for name in names if any(fnmatch(name, pattern) for pattern in patterns)
            and not (folder == "device" and name.count("/device/") and "/" in name.split("/device/")[1])]


def draws(folder: str, seed: int, root: Path) -> Iterator[Mutant]:
    """The folder's mutants in the order of the seed: a line, then an operator among those that it allows, then one change of it."""
    generator = random.Random(f"{seed}/{folder}")
    lines = [found for file in sources_of(folder, root) for found in mutants_of(file, (root / file).read_text()).values()]
    left = [(index, mutant) for index, found in enumerate(lines) for mutant in found]
    while left:
        index = generator.choice(sorted({index for index, _ in left}))
        here = [mutant for other, mutant in left if other == index]
        operator = generator.choice(sorted({mutant.operator for mutant in here}))
        drawn = generator.choice([mutant for mutant in here if mutant.operator == operator])
        left = [(other, mutant) for other, mutant in left if mutant is not drawn]
        yield drawn


def argued(path: Path) -> dict[str, str]:
    """Mutants that change nothing that can be observed: the diff as the report writes it, and the sentence that argues it."""
    known = {}
    for block in re.split(r"\n\s*\n", path.read_text() if path.exists() else ""):
        lines = [line for line in block.strip().splitlines() if not line.startswith("#")]
        diff = [line.rstrip() for line in lines[:1]] + [f"{line[0]} {code_of(line[1:])}".rstrip() for line in lines[1:] if line[:1] in "-+"]
        argument = " ".join(line.strip() for line in lines[1:] if line[:1] not in "-+")
        if len(diff) == 3 and argument:
            known["\n".join(diff)] = argument
        elif lines:
            sys.exit(f"{path}: each block is FILE OPERATOR, - BEFORE, + AFTER and a sentence, this one is not:\n{block}")
    return known
