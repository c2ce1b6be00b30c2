# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Reference pages from what the programs say of themselves, and from the
sources: subcommands, options, verdicts, the Python module, ROS.

Each function returns a page as Markdown and fails where a source does not look
as expected, so that no page goes out of date unnoticed.
"""

import ast
import re
import subprocess
import textwrap
import xml.etree.ElementTree as ElementTree


def escape(text):
    return re.sub(r"([<*_\[\\])", r"\\\1", text)


def generated_from(what):
    return f"*Generated from {what}.*\n"


# --- Subcommands. ---

def help_text(program, *words):
    return subprocess.run([str(program), *words], check=True, capture_output=True, text=True).stdout


def subcommands(program):
    """(name, summary) of those that the help lists, in its order."""
    listed = help_text(program, "help").split("\nSubcommands:\n")[1].split("\n\n")[0]
    found = re.findall(r"^  ([a-z_]+) +(\S.*)$", listed, re.MULTILINE)
    if not found:
        raise ValueError("the help lists no subcommand")
    return found


def flag_lines(flags):
    """A list of definitions of the flags of a help text."""
    lines = []
    for flag in re.split(r"\n(?=  --)", flags.rstrip()):
        head, *body = flag.strip("\n").splitlines()
        match = re.fullmatch(r"  (--\w+) <(\w+)>(?: \((.+)\))?", head)
        if not match:
            raise ValueError(f"not a flag as the help writes them: {head}")
        name, kind, note = match.groups()
        description = " ".join(line.strip() for line in body)
        lines += [f"`{name}` {kind}" + (f", {note}" if note else ""), f": {escape(description)}", ""]
    return lines


def program_page(program, name, *words):
    """The page of a subcommand, or of a program of its own."""
    text = help_text(program, *words)
    title, rest = text.split("\n\n", 1)
    about, flags = rest.split("\nFlags:\n")
    usage, _, description = about.partition("\n\n")
    usage = textwrap.dedent(usage.split("Usage:\n", 1)[1])
    # What follows the flags, if anything, is prose again.
    flags, _, more = re.sub(r"\n\n(?=\S)", "\n\f", flags).partition("\f")
    lines = [f"# {name}", "", escape(title.split(": ", 1)[1].capitalize()), "", "```text", usage.strip(), "```", ""]
    for paragraph in description.strip().split("\n\n"):
        lines += [escape(paragraph), ""]
    lines += ["## Flags", "", *flag_lines(flags)]
    if more:
        lines += ["```text", more.strip(), "```", ""]
    return "\n".join(lines) + "\n" + generated_from("what the program says with `--help`")


def subcommands_page(program, names):
    text = help_text(program, "help")
    exit_codes = text.split("\nExit codes:\n")[1]
    lines = ["# Subcommands", "", "| subcommand | |", "| --- | --- |"]
    lines += [f"| [{name}]({name}.md) | {escape(summary)} |" for name, summary in names]
    lines += ["", "## Exit codes", "", "```text", textwrap.dedent(exit_codes).rstrip(), "```", "",
              "What scripts can rely on: [the command line](../../command_line.md).", ""]
    return "\n".join(lines) + "\n" + generated_from("`cartographer_sdf help`")


# --- Options. ---

class LuaOptions:
    """Reads the configuration files of the project: tables, assignments and the
    comments above them. Not any Lua: what it does not know is an error."""

    def __init__(self, text):
        self.introduction = []  # The comments above everything.
        self.options = []       # (table, key, value, comment)
        self.tables = {}        # Comment of each table.
        self.stack = []
        self.aliases = {}
        self.comment = []
        self.seen_code = False
        for line in text.splitlines():
            self.read(line.strip())

    def take_comment(self):
        comment, self.comment = " ".join(self.comment), []
        return comment

    def expand(self, name):
        head, dot, tail = name.partition(".")
        return self.aliases.get(head, head) + dot + tail

    def read(self, line):
        if line.startswith("--"):
            if "SPDX" not in line:
                self.comment.append(line[2:].strip())
            return
        if not line:
            if not self.seen_code and self.comment:
                self.introduction.append("\n".join(self.comment))
                self.comment = []
            return
        self.seen_code = True
        if line.startswith(("include ", "return ")):
            self.comment = []
        elif line in ("}", "},"):
            self.stack.pop()
        else:
            self.read_assignment(line)

    def read_assignment(self, line):
        match = re.fullmatch(r"(local )?([\w.]+) = (.*?),?", line)
        if not match:
            raise ValueError(f"not understood: {line}")
        is_local, name, value = match.groups()
        if is_local:
            self.aliases[name] = self.expand(value)
            self.tables.setdefault(self.aliases[name], self.take_comment())
        elif value == "{":
            self.stack.append(name if self.stack else self.expand(name))
            self.tables[".".join(self.stack)] = self.take_comment()
        else:
            path = ".".join([*self.stack, name]) if self.stack else self.expand(name)
            table, _, key = path.rpartition(".")
            # One comment may speak of two options in a row.
            self.options.append((table, key, value, self.take_comment()))


def options_page(path):
    """All options of one Lua file, with their defaults."""
    options = LuaOptions(path.read_text(encoding="utf-8"))
    lines = [f"# {path.name}", ""]
    for paragraph in options.introduction:
        if "\n  " in paragraph or re.search(r"^(include|local|return) ", paragraph, re.MULTILINE):
            prose = [line for line in paragraph.splitlines()]
            lines += lua_example(prose)
        else:
            lines += [escape(paragraph), ""]
    root, table = options.options[0][0].partition(".")[0], None
    lines += [f"All names are below `{root}`.", ""]
    for name, key, value, comment in options.options:
        if name != table:
            table = name
            lines += [f"## {table.removeprefix(root + '.')}", ""]
            if options.tables.get(table):
                lines += [escape(options.tables[table]), ""]
        lines += [f"`{key}` = `{value}`", f": {escape(comment) or 'See above.'}", ""]
    return "\n".join(lines) + "\n" + generated_from(f"configuration_files/{path.name}")


def lua_example(lines):
    """Prose with lines of code in it, which begin as Lua does."""
    is_code = [bool(re.match(r"(include|local|return|recognition\.)", line)) for line in lines]
    first, last = is_code.index(True), len(is_code) - is_code[::-1].index(True)
    return [escape("\n".join(lines[:first])), "", "```lua", *lines[first:last], "```", "",
            escape("\n".join(lines[last:])), ""]


# --- Verdicts and statuses. ---

# Header, enumeration, source that has the names, title, and what it is of.
ENUMERATIONS = (
    ("verification/judgement", "Verdict", "Verdicts of a pair",
     "In tables of `match` and `close_loops`, and in reports: why a pair of submaps is or is not accepted."),
    ("closing/closure", "ClosureStatus", "Statuses of a closure",
     "What became of an accepted match on its way into the pose graph."),
    ("apps/audit", "AuditVerdict", "Verdicts of audit", "Of a constraint that the map has already."),
    ("localization/localizer", "LocalizationVerdict", "Verdicts of a localisation",
     "Of a drive, a map or a scan in a map: `relocalize`, `merge`, live."),
    ("live/operator_view", "SearchState", "States of the search", "Of the newest trajectory, beside a live Cartographer."),
)


def enumerators(header, name):
    """(printed name, comment) of each; a comment on a line of its own begins a
    group and has no name."""
    match = re.search(r"enum class %s \{(.*?)\n\};" % name, header, re.DOTALL)
    if not match:
        return []
    found = []
    for line in match.group(1).splitlines():
        own = re.fullmatch(r"\s*// (.*)", line)
        value = re.fullmatch(r"\s*k(\w+),(?:\s*// (.*))?", line)
        if value:
            snake = re.sub(r"(?<!^)(?=[A-Z])", "_", value.group(1)).lower()
            found.append([snake, value.group(2) or ""])
        elif own and line.index("//") > 2:
            found[-1][1] += " " + own.group(1)
        elif own:
            found.append(["", own.group(1)])
    return found


def verdicts_page(source):
    lines = ["# Verdicts and statuses", "",
             "As they are printed, and as they stand in tables, JSON and reports.", ""]
    for stem, name, title, about in ENUMERATIONS:
        path = source / "cartographer_sdf" / f"{stem}.h"
        values = enumerators(path.read_text(encoding="utf-8"), name) if path.exists() else []
        if not values:
            continue
        printed = "".join(file.read_text(encoding="utf-8") for file in path.parent.glob("*.cc"))
        lines += [f"## {title}", "", about, ""]
        for value, comment in values:
            if value and f'"{value}"' not in printed:
                raise ValueError(f"{path}: nothing prints {value}")
            lines += [f"`{value}`", f": {escape(comment) or 'As the name says.'}", ""] if value else [escape(comment), ""]
    lines += ["What the words mean: [conventions](../conventions.md#terms).", ""]
    return "\n".join(lines) + "\n" + generated_from("the enumerations in the headers")


# --- Python. ---

def signature(node):
    return f"def {node.name}({ast.unparse(node.args)})" + (f" -> {ast.unparse(node.returns)}" if node.returns else "")


def is_property(node):
    return any(isinstance(decorator, ast.Name) and decorator.id == "property" for decorator in node.decorator_list)


def python_members(node):
    lines = []
    for member in node.body:
        text = None
        if isinstance(member, ast.FunctionDef):
            text = f"{member.name}: {ast.unparse(member.returns)}" if is_property(member) else signature(member)
            documentation = ast.get_docstring(member)
        elif isinstance(member, ast.AnnAssign):
            text, documentation = ast.unparse(member), None
        if text:
            lines.append(f"- `{text}`" + (f": {escape(' '.join(documentation.split()))}" if documentation else ""))
    return lines + [""]


def python_page(stub, module):
    """The names of the type stubs, with their docstrings."""
    introduction = ast.get_docstring(ast.parse(module.read_text(encoding="utf-8"))).rsplit(" What each function", 1)[0]
    lines = ["# Python API", "", escape(introduction), "", "How to build it, and examples: [Python](../python.md).", ""]
    for node in ast.parse(stub.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ClassDef):
            lines += [f"## `class {node.name}`", "", escape(ast.get_docstring(node) or ""), "", *python_members(node)]
        elif isinstance(node, ast.FunctionDef):
            lines += [f"## `{node.name}`", "", "```python", signature(node), "```", "",
                      escape(ast.get_docstring(node) or ""), ""]
    return "\n".join(lines) + "\n" + generated_from("python/cartographer_sdf/\\_\\_init\\_\\_.pyi")


# --- ROS. ---

def launch_arguments(path):
    """A table of the arguments of a launch file of ROS 1."""
    parser = ElementTree.XMLParser(target=ElementTree.TreeBuilder(insert_comments=True))
    root, comment = ElementTree.parse(path, parser).getroot(), ""
    lines = ["| argument | default | |", "| --- | --- | --- |"]
    for child in root:
        if child.tag is ElementTree.Comment:
            comment = "" if "SPDX" in child.text else " ".join(child.text.split())
        elif child.tag == "arg":
            default = child.get("default")
            default = "(required)" if default is None else f"`{default}`" if default else "(empty)"
            lines.append(f"| `{child.get('name')}` | {default} | {escape(comment)} |")
            comment = ""
    return lines + [""]


def ros_page(folder):
    lines = ["# ROS: launch files, flags, services", "",
             "Topics, parameters and how to use them: [with ROS](../ros.md#topics-services-parameters).", ""]
    for path in sorted((folder / "cartographer_sdf_ros/ros1/launch").glob("*.launch")):
        lines += [f"## {path.name}", "", *launch_arguments(path)]
    flags = (folder / "cartographer_sdf_ros/node_flags.cc").read_text(encoding="utf-8")
    lines += ["## Flags of cartographer_sdf_node", ""]
    for kind, name, default, text in re.findall(
            r'DEFINE_(\w+)\((\w+), ([^,]+),\s*((?:"[^"]*"\s*)+)\)', flags):
        words = "".join(re.findall(r'"([^"]*)"', text))
        lines += [f"`-{name}` {kind}, default `{default}`", f": {escape(words)}", ""]
    for path in sorted((folder / "cartographer_sdf_msgs/srv").glob("*.srv")):
        text = path.read_text(encoding="utf-8").split("\n\n", 1)[1]
        lines += [f"## cartographer_sdf_msgs/{path.stem}", "", "```text", text.rstrip(), "```", ""]
    return "\n".join(lines) + "\n" + generated_from("the files in ros/")
