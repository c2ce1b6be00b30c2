# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Pages of the C++ API, one for each folder, from Doxygen's XML.

They are plain Markdown. Breathe, or Sphinx's own domain for C++, would parse
each declaration once more, which takes minutes, for links between types.
"""

import collections
import re
import xml.etree.ElementTree as ElementTree

import doxygen_headers

NAMESPACE = "cartographer_sdf"


def escape(text):
    return re.sub(r"([*_`|<\[\\])", r"\\\1", text)


def inline(element):
    """The text of a paragraph as Markdown; lists are left out."""
    parts = [escape(element.text or "")]
    for child in element:
        if child.tag == "computeroutput":
            parts.append("`%s`" % "".join(child.itertext()))
        elif child.tag not in ("itemizedlist", "orderedlist", "parameterlist", "simplesect"):
            parts.append(inline(child))
        parts.append(escape(child.tail or ""))
    return "".join(parts)


def description(element):
    """The brief and the detailed description of a definition, a paragraph each."""
    paragraphs = []
    for tag in ("briefdescription", "detaileddescription"):
        for paragraph in element.findall(f"{tag}/para"):
            paragraphs.append(" ".join(inline(paragraph).split()))
            for item in paragraph.findall("*/listitem"):
                paragraphs.append("- " + " ".join(" ".join(map(inline, item.findall("para"))).split()))
    return list(filter(None, paragraphs))


def joined(element, tag):
    found = element.find(tag)
    return " ".join("".join(found.itertext()).split()) if found is not None else ""


def template_of(element):
    parameters = element.find("templateparamlist")
    if parameters is None:
        return ""
    names = [" ".join(filter(None, (joined(parameter, "type"), joined(parameter, "declname"))))
             for parameter in parameters]
    return "template<%s> " % ", ".join(names)


def declaration(member):
    """What the member's declaration says, or None where that is nothing."""
    kind, name = member.get("kind"), member.findtext("name")
    static = "static" if member.get("static") == "yes" else ""
    if name.startswith("@"):
        return None
    if kind == "function":
        arguments = re.sub(r"\s*=\s*(default|delete|0)$", r" = \1", joined(member, "argsstring"))
        words = [static, "virtual" if member.get("virt") in ("virtual", "pure-virtual") else "",
                 "explicit" if member.get("explicit") == "yes" else "",
                 joined(member, "type"), name + arguments]
        return template_of(member) + " ".join(filter(None, words))
    if kind == "variable":
        words = [static, joined(member, "type"), name + member.findtext("argsstring", ""),
                 joined(member, "initializer")]
        return " ".join(filter(None, words))
    if kind == "typedef":
        return f"{template_of(member)}using {name} = {joined(member, 'type')}"
    return None


def tidy(text):
    """A declaration as it is written in the headers."""
    text = re.sub(r"\s+>", ">", text.replace("< ", "<"))
    text = re.sub(r"\s+([&*]+)\s*(?=\w)", r"\1 ", text)
    return re.sub(r"\s+([&*]+)(?=[),]|$)", r"\1", text)


def item(text, paragraphs, depth=0):
    """An item of a list: code, and what is said of it."""
    lines = [f"- `{tidy(text)}`" + (f": {paragraphs[0]}" if paragraphs else "")]
    for paragraph in paragraphs[1:]:
        lines += ["", f"  {paragraph}"]
    return [("  " * depth + line).rstrip() for line in lines]


def enum_lines(enum):
    strong = "enum class" if enum.get("strong") == "yes" else "enum"
    lines = [f"### `{strong} {enum.findtext('name')}`", ""]
    for paragraph in description(enum):
        lines += [paragraph, ""]
    for value in enum.findall("enumvalue"):
        lines += item(value.findtext("name"), description(value))
    return lines + [""]


def line_of(element):
    return int(element.find("location").get("line", 0))


class Compounds:
    """What Doxygen found, by the header that declares it."""

    def __init__(self, folder):
        self.by_id = {}
        self.by_file = collections.defaultdict(list)
        for path in sorted(folder.glob("*.xml")):
            for compound in ElementTree.parse(path).getroot().findall("compounddef"):
                self.by_id[compound.get("id")] = compound
        inner = {child.get("refid") for compound in self.by_id.values()
                 if compound.get("kind") in ("class", "struct")
                 for child in compound.findall("innerclass")}
        for compound_id, compound in self.by_id.items():
            if compound.get("kind") in ("class", "struct") and compound_id not in inner:
                self.by_file[compound.find("location").get("file")].append(compound)
            elif compound.findtext("compoundname") == NAMESPACE:
                for member in compound.findall("sectiondef/memberdef"):
                    self.by_file[member.find("location").get("file")].append(member)

    def class_lines(self, compound):
        name = compound.findtext("compoundname").split(f"{NAMESPACE}::")[-1]
        if "<" in name:  # A specialisation has nothing of its own to say.
            return []
        bases = ["public " + "".join(base.itertext()).removeprefix(f"{NAMESPACE}::") for base in compound.findall("basecompoundref")
                 if base.get("prot") == "public"]
        text = f"{template_of(compound)}{compound.get('kind')} {name}"
        lines = [f"### `{tidy(text + (' : ' + ', '.join(bases) if bases else ''))}`", ""]
        for paragraph in description(compound):
            lines += [paragraph, ""]
        members = [member for section in compound.findall("sectiondef")
                   if section.get("kind").startswith("public") for member in section.findall("memberdef")]
        for member in sorted(members, key=line_of):
            if declaration(member):
                lines += item(declaration(member), description(member))
        lines.append("")
        for member in members:
            if member.get("kind") == "enum":
                lines += enum_lines(member)
        for inner in compound.findall("innerclass"):
            if inner.get("prot") == "public":
                lines += self.class_lines(self.by_id[inner.get("refid")])
        return lines

    def header_lines(self, path):
        types, others = [], []
        for element in sorted(self.by_file[path], key=line_of):
            if element.tag == "compounddef":
                types += self.class_lines(element)
            elif element.get("kind") == "enum":
                types += enum_lines(element)
            elif declaration(element):
                others += item(declaration(element), description(element))
        return types + (["### Functions and constants", "", *others, ""] if others else [])


def folder_page(folder, headers, source, compounds, summary):
    """The page of one folder: each header with its description and names."""
    lines = [f"# {folder}/", "", summary, ""]
    for header in headers:
        path = header.relative_to(source).as_posix()
        text = header.read_text(encoding="utf-8").splitlines()
        lines += [f"## {header.name}", "", f"```cpp\n#include \"{path}\"\n```", ""]
        _, comment = doxygen_headers.file_comment(text)
        lines += [escape(line) for line in comment] + [""]
        lines += compounds.header_lines(path)
    return "\n".join(lines)
