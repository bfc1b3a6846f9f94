# SPDX-License-Identifier: Apache-2.0
"""Pages of the public headers, from Doxygen's XML: one page a header, its types and functions in the order of the file."""
import html
import re
import subprocess
import xml.etree.ElementTree as XML
from pathlib import Path

KINDS = {"class": "class", "struct": "struct", "union": "union"}
PARTS = {"return": "Returns", "pre": "Precondition", "post": "Postcondition", "note": "Note", "see": "See", "since": "Since", "warning": "Warning"}
LISTS = {"param": "Parameters", "exception": "Throws", "retval": "Return values", "templateparam": "Template parameters"}
TAGS = {"para": "p", "bold": "strong", "emphasis": "em", "computeroutput": "code", "itemizedlist": "ul", "orderedlist": "ol", "listitem": "li",
        "preformatted": "pre", "subscript": "sub", "superscript": "sup"}
SIGNS = {"ndash": "–", "mdash": "—", "nonbreakablespace": " ", "lsquo": "‘", "rsquo": "’", "ldquo": "“", "rdquo": "”", "times": "×", "deg": "°",
         "linebreak": "<br>", "sp": " "}
SMALL = {"variable", "typedef", "define"}  # no heading of their own
INCOMPLETE = "A public header is described incompletely:"


def public_headers(root):
    """(library, headers below include/phalanx) as cmake/public_headers.cmake lists them, without those that do not exist."""
    text = re.sub(r"#.*", "", (root / "cmake/public_headers.cmake").read_text(encoding="utf-8"))
    for name, files in re.findall(r"set\(\s*PHALANX_(\w*?)_?PUBLIC_HEADERS\s([^)]*)\)", text):
        yield name.lower() or "phalanx", [file for file in files.split() if (root / "include/phalanx" / file).is_file()]


def run_doxygen(root, headers, folder):
    """XML of these headers in `folder`. @throws SystemExit with all warnings, if there is one."""
    settings = (root / "scripts/site/Doxyfile").read_text(encoding="utf-8")
    settings += f"INPUT = {' '.join(f'include/phalanx/{header}' for header in headers)}\nOUTPUT_DIRECTORY = {folder}\n"
    done = subprocess.run(["doxygen", "-"], input=settings, cwd=root, capture_output=True, text=True)
    if done.returncode != 0 or done.stderr.strip():
        raise SystemExit(f"{INCOMPLETE}\n{done.stderr}")


def head_comment(path):
    """What a file says of itself: the comment below its licence."""
    lines = []
    for line in path.read_text(encoding="utf-8").splitlines()[1:]:
        if not re.match(r"//|/?\*", line.strip()):
            break
        lines.append(line.strip().strip("/* "))
    return " ".join(lines).strip()


class Api:
    """All headers. `pages` has (header, title, HTML, entries of the search) after construction."""

    def __init__(self, root, libraries, folder):
        self.root = root
        self.places = {}  # Doxygen's id -> (header, anchor)
        self.contents = {}  # header -> [(line, XML element)]
        self.compounds = {}
        headers = {header for _, names in libraries for header in names}
        for file in sorted(Path(folder, "xml").glob("*.xml")):
            for compound in XML.parse(file).getroot().iter("compounddef"):
                self.compounds[compound.get("id")] = compound
                if compound.get("kind") in KINDS:
                    self._place(compound, headers, compound.findtext("compoundname"))
                elif compound.get("kind") in ("namespace", "file"):
                    for member in compound.iter("memberdef"):
                        self._place(member, headers, member.findtext("qualifiedname") or member.findtext("name"))
        nested = {inner.get("refid") for compound in self.compounds.values() if compound.get("kind") in KINDS for inner in compound.findall("innerclass")}
        for header in self.contents:
            self.contents[header] = sorted((one for one in self.contents[header] if one[1].get("id") not in nested), key=lambda one: one[0])

    def _place(self, element, headers, name):
        location = element.find("location")
        header = location.get("file", "").removeprefix("phalanx/") if location is not None else ""
        if header not in headers or element.get("prot") == "private" or element.get("id") in self.places:
            return
        anchor = re.sub(r"\W+", "-", name.removeprefix("phalanx::"))
        taken = {place for place in self.places.values()}
        number, base = 1, anchor
        while (header, anchor) in taken:
            number += 1
            anchor = f"{base}-{number}"
        self.places[element.get("id")] = (header, anchor)
        if element.get("kind") in KINDS:
            for member in element.iter("memberdef"):
                self.places.setdefault(member.get("id"), (header, anchor))
        self.contents.setdefault(header, []).append((int(location.get("line", "0")), element))

    # ---- text

    def _reference(self, refid, text, here):
        place = self.places.get(refid)
        if not place:
            return text
        depth = "../" * here.count("/")
        page = "" if place[0] == here else f"{depth}{place[0]}.html"
        return f'<a href="{page}#{place[1]}">{text}</a>'

    def _inline(self, element, here):
        text = html.escape(element.text or "", quote=False)
        for child in element:
            text += self._element(child, here) + html.escape(child.tail or "", quote=False)
        return text

    def _element(self, element, here):
        tag = element.tag
        if tag == "ref":
            return self._reference(element.get("refid"), self._inline(element, here), here)
        if tag in SIGNS:
            return SIGNS[tag]
        if tag == "simplesect" and element.get("kind") in PARTS:
            return f'<div class="part"><b>{PARTS[element.get("kind")]}</b> {self._inline(element, here)}</div>'
        if tag == "parameterlist":
            rows = "".join(self._parameter(item, here) for item in element.findall("parameteritem"))
            return f'<div class="part"><b>{LISTS.get(element.get("kind"), "")}</b><dl>{rows}</dl></div>'
        if tag == "ulink":
            return f'<a href="{html.escape(element.get("url", ""))}">{self._inline(element, here)}</a>'
        if tag in ("verbatim", "programlisting"):
            return f"<pre>{html.escape(''.join(element.itertext()), quote=False)}</pre>"
        inner = self._inline(element, here)
        return f"<{TAGS[tag]}>{inner}</{TAGS[tag]}>" if tag in TAGS else inner

    def _parameter(self, item, here):
        names = ", ".join(f"<code>{self._inline(name, here)}</code>" for name in item.iter("parametername"))
        return f"<dt>{names}</dt><dd>{self._inline(item.find('parameterdescription'), here)}</dd>"

    def _described(self, element, here):
        parts = [self._inline(element.find(tag), here) for tag in ("briefdescription", "detaileddescription") if element.find(tag) is not None]
        # A block within a paragraph ends it.
        text = re.sub(r"<p>((?:(?!</p>).)*?)(<div class=\"part\">)", r"<p>\1</p>\2", "".join(parts), flags=re.S)
        return re.sub(r"<p>\s*</p>", "", re.sub(r"</div>\s*</p>", "</div>", text))

    # ---- declarations

    def _declaration(self, member, here):
        kind, name = member.get("kind"), html.escape(member.findtext("name", ""))
        type_of = self._inline(member.find("type"), here) if member.find("type") is not None else ""
        if kind == "define":
            return f"#define {name}"
        if kind == "typedef":
            return html.escape(member.findtext("definition", "").replace("phalanx::", "").replace("= typedef ", "= "))
        if kind == "enum":
            return f"enum class {name}" if member.get("strong") == "yes" else f"enum {name}"
        template = member.find("templateparamlist")
        before = ""
        if template is not None:
            before = f"template &lt;{', '.join(html.escape(''.join((one.find('type')).itertext())) + ' ' + html.escape(one.findtext('declname', '')) for one in template)}&gt; "
        text = f"{before}{type_of} {name}{html.escape(member.findtext('argsstring', ''))}".strip()
        text = text.replace(" &amp; ", "&amp; ").replace(" * ", "* ")
        start = member.find("initializer")
        return text + (" " + html.escape("".join(start.itertext()).strip()) if start is not None and kind == "variable" else "")

    @staticmethod
    def _usual(member):
        """Copies, moves and destructors, of which there is nothing to say."""
        name, arguments = member.findtext("name", ""), member.findtext("argsstring", "")
        return name.startswith("~") or name == "operator=" or bool(re.match(r"\((const )?\w+ &&?\w*\)", arguments)) and not member.findtext("type")

    def _member(self, member, here):
        values = "".join(
            f"<dt><code>{html.escape(value.findtext('name', ''))}</code></dt><dd>{self._described(value, here)}</dd>" for value in member.findall("enumvalue"))
        return (f'<div class="member"><code class="declaration">{self._declaration(member, here)}</code>{self._described(member, here)}'
                f"{f'<dl>{values}</dl>' if values else ''}</div>")

    def _compound(self, compound, here, level=2):
        name = compound.findtext("compoundname", "").removeprefix("phalanx::")
        _, anchor = self.places[compound.get("id")]
        bases = ", ".join(self._reference(base.get("refid"), html.escape(base.text or ""), here) for base in compound.findall("basecompoundref"))
        text = f'<h{level} id="{anchor}">{KINDS[compound.get("kind")]} {html.escape(name)}</h{level}>'
        text += (f"<p>Derived from {bases}.</p>" if bases else "") + self._described(compound, here)
        members = [member for part in compound.findall("sectiondef") for member in part.findall("memberdef")
                   if member.get("prot") != "private" and member.get("kind") != "friend"]
        members.sort(key=lambda member: int(member.find("location").get("line", "0")))
        bare = []  # declarations of members that say nothing of themselves: one box for all that follow each other
        for member in members + [None]:
            if member is not None and not self._described(member, here) and member.find("enumvalue") is None:
                if not self._usual(member):
                    bare.append(f'<code class="declaration">{self._declaration(member, here)}</code>')
                continue
            text += f'<div class="member">{"".join(bare)}</div>' if bare else ""
            bare = []
            text += self._member(member, here) if member is not None else ""
        for inner in compound.findall("innerclass"):
            if inner.get("prot") != "private" and inner.get("refid") in self.places:
                text += self._compound(self.compounds[inner.get("refid")], here, 3)
        return text

    def page(self, header):
        """(title, HTML, [(anchor, heading, text)]) of one header."""
        about = head_comment(self.root / "include/phalanx" / header)
        text = f'<h1>phalanx/{html.escape(header)}</h1><p>{html.escape(about)}</p><pre><code>#include "phalanx/{html.escape(header)}"</code></pre>'
        entries = [("", f"phalanx/{header}", about)]
        for _, element in self.contents.get(header, []):
            anchor = self.places[element.get("id")][1]
            name = (element.findtext("compoundname") or element.findtext("name", "")).removeprefix("phalanx::")
            if element.get("kind") in KINDS:
                part = self._compound(element, header)
            elif element.get("kind") in SMALL:
                part = self._member(element, header).replace('<div class="member"', f'<div class="member" id="{anchor}"', 1)
            else:
                part = f'<h2 id="{anchor}">{html.escape(name)}</h2>{self._member(element, header)}'
            text += part
            entries.append((anchor, name, " ".join(html.unescape(re.sub(r"<[^>]*>", " ", part)).split())))
        return f"phalanx/{header}", text, entries
