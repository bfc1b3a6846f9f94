# SPDX-License-Identifier: Apache-2.0
"""Markdown as GitHub renders it: headings, their anchors, links. Used by scripts/docs_site and by the tests of the documents."""
import html
import re
import subprocess
from pathlib import Path

EXTENSIONS = ["table", "strikethrough", "autolink", "tasklist"]
HEADING = re.compile(r"<h([1-6])>(.*?)</h\1>", re.S)
LINK = re.compile(r'(<(?:a|img)\s[^>]*?(?:href|src)=")([^"]*)(")')
ELSEWHERE = re.compile(r"^(https?|mailto|data|javascript):")
SKIPPED = {"build", "debian", "node_modules", ".git", "out", ".cache", "obj-x86_64-linux-gnu"}


def documents(root):
    """All Markdown files of the checkout, as paths relative to it, in alphabetical order."""
    found = []
    pending = [root]
    while pending:
        for entry in pending.pop().iterdir():
            if entry.is_dir():
                if entry.name not in SKIPPED and not entry.is_symlink():
                    pending.append(entry)
            elif entry.suffix == ".md":
                found.append(entry.relative_to(root))
    return sorted(found)


def to_html(text):
    """HTML of a Markdown text."""
    command = ["cmark-gfm", "--unsafe"]
    for name in EXTENSIONS:
        command += ["-e", name]
    return subprocess.run(command, input=text, capture_output=True, text=True, check=True).stdout


def plain(fragment):
    """Text of an HTML fragment."""
    return html.unescape(re.sub(r"<[^>]*>", "", fragment))


def slug(heading):
    """Anchor of a heading's text, by GitHub's rule: lower case, no punctuation but - and _, hyphens for spaces."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


class Document:
    """One Markdown file, rendered; its links are still those of the Markdown."""

    def __init__(self, root, path):
        self.path = path  # relative to the checkout
        self.headings = []  # (level, anchor, HTML of the text)
        self.body = HEADING.sub(self._heading, to_html((root / path).read_text(encoding="utf-8")))
        self.title = next((plain(text) for level, _, text in self.headings if level == 1), path.name)
        self.anchors = {anchor for _, anchor, _ in self.headings} | set(re.findall(r'\s(?:id|name)="([^"]+)"', self.body))

    def _heading(self, match):
        level, text = int(match.group(1)), match.group(2)
        base = anchor = slug(plain(text))
        used = {known for _, known, _ in self.headings}
        number = 0
        while anchor in used:
            number += 1
            anchor = f"{base}-{number}"
        self.headings.append((level, anchor, text))
        return f'<h{level} id="{anchor}">{text}<a class="anchor" href="#{anchor}" aria-label="Link to this section">#</a></h{level}>'

    def links(self):
        """(path relative to the checkout, anchor) of each link and picture that stays in the checkout."""
        for target in (html.unescape(found.group(2)) for found in LINK.finditer(self.body)):
            if not ELSEWHERE.match(target):
                yield self.resolve(target)

    def resolve(self, target):
        """A link's path relative to the checkout, and its anchor."""
        name, _, anchor = target.partition("#")
        if not name:
            return self.path, anchor
        parts = []
        for part in (self.path.parent / name).parts:
            if part == ".." and parts and parts[-1] != "..":
                parts.pop()
            else:
                parts.append(part)
        return Path(*parts) if parts else Path("."), anchor

    def sections(self):
        """(anchor, heading, text) of each part below a heading, for the search."""
        pieces = re.split(r'<h[1-6] id="([^"]+)">(.*?)<a class="anchor".*?</h[1-6]>', self.body, flags=re.S)
        for anchor, heading, content in zip(pieces[1::3], pieces[2::3], pieces[3::3]):
            yield anchor, plain(heading), " ".join(plain(re.sub(r"<(td|th|li|p|br)\b", r" <\1", content)).split())
