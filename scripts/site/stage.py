#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the pages that the site is built of.

usage: stage.py SOURCE PROGRAM OUTPUT [--doxygen-xml DIR]

OUTPUT gets the Markdown of docs/, the pages that are generated from the program
and the sources, and Sphinx's configuration. docs/ stays readable in a browser of
the repository: links to files outside of it become links to the page that shows
them, here. Fails at a link that leads nowhere.
"""

import argparse
import os
import pathlib
import re
import shutil

import cpp_reference
import doxygen_headers
import reference

# The order of the pages. What docs/ has besides is added to the group of its
# folder, or to the guides.
NAVIGATION = (
    ("Start", ("install",)),
    ("Tutorials", ("tutorials/folded_map", "tutorials/two_sessions", "tutorials/start_up", "tutorials/fleet")),
    ("How to", ("howto/read_a_report", "howto/symptoms", "howto/short_lidar", "howto/export", "howto/undo")),
    ("Guides", ("sessions", "scan_localization", "live", "ros", "run_log", "python", "packages", "building_the_site")),
    ("Reference", ("command_line", "reference/subcommands/index", "reference/options/index", "reference/verdicts",
                   "conventions", "reference/cpp/index", "reference/python", "reference/ros")),
    ("Explanation", ("how_it_works", "comparison", "design", "references")),
    ("Results", ("results/README",)),
    ("Project", ("project/CONTRIBUTING", "project/SECURITY", "project/CHANGELOG")),
)
PROJECT_PAGES = ("README.md", "CONTRIBUTING.md", "SECURITY.md", "CHANGELOG.md", "ros/README.md")
OPTION_FILES = ("sdf_global_constraints", "sdf_advanced_options", "sdf_live", "paper", "shape_context")
LANGUAGES = {".h": "cpp", ".cc": "cpp", ".py": "python", ".pyi": "python", ".lua": "lua", ".sh": "bash",
             ".json": "json", ".proto": "protobuf", ".srv": "text", ".rviz": "yaml", ".xml": "xml"}
LINK = re.compile(r"(!?\[(?:[^\]\[]|\[[^\]]*\])*\])\(([^()\s]+)\)")
FENCE = re.compile(r"^\s*(```|~~~)")


class Site:
    def __init__(self, source, output):
        self.source = source
        self.output = output
        self.linked_files = set()  # Of the sources, that get a page of their own.
        self.faults = []
        self.cpp_folders = sorted(
            folder.name for folder in (source / "cartographer_sdf").iterdir()
            if folder.is_dir() and folder.name != "tools" and any(folder.glob("*.h")))

    def headers(self, folder):
        return [header for header in sorted((self.source / "cartographer_sdf" / folder).glob("*.h"))
                if header.name != "json.h"]

    def page_of(self, path):
        """The page that shows a file or folder of the repository, an anchor with
        it where it is part of a page."""
        parts = path.split("/")
        if path.startswith("docs/"):
            inside = path[len("docs/"):]
            if inside.rstrip("/") == "results":
                return "results/README.md"
            if inside.endswith((".md", ".png", ".svg")):
                return inside
        if path in PROJECT_PAGES:
            return f"project/{path}"
        if path == "cartographer_sdf":
            return "reference/cpp/index.md"
        if parts[0] == "cartographer_sdf" and len(parts) > 1 and parts[1] in self.cpp_folders:
            if len(parts) == 2:
                return f"reference/cpp/{parts[1]}.md"
            if path.endswith(".h") and parts[-1] != "json.h":
                return f"reference/cpp/{parts[1]}.md#{parts[-1].replace('.', '')}"
        if parts[0] == "configuration_files" and parts[-1].removesuffix(".lua") in OPTION_FILES:
            return f"reference/options/{parts[-1].removesuffix('.lua')}.md"
        if path == "python/cartographer_sdf/__init__.pyi":
            return "reference/python.md"
        if path in ("ros", "ros/cartographer_sdf_ros", "ros/cartographer_sdf_msgs"):
            return "reference/ros.md"
        self.linked_files.add(path)
        return f"source/{path}.md"

    def rewrite(self, text, origin, page):
        """Turns the links of a Markdown file at `origin` in the repository into
        links of `page` in the site."""
        def replaced(match):
            label, target = match.groups()
            if re.match(r"[a-z]+:", target) or target.startswith("#"):
                return match.group(0)
            path, hash_mark, anchor = target.partition("#")
            where = os.path.normpath(os.path.join(os.path.dirname(origin), path))
            if where.startswith("..") or not (self.source / where).exists():
                self.faults.append(f"{origin}: {target} leads nowhere")
                return match.group(0)
            shown, _, own_anchor = self.page_of(where).partition("#")
            anchor = anchor or own_anchor
            relative = os.path.relpath(shown, os.path.dirname(page) or ".")
            return f"{label}({relative}{'#' + anchor if anchor else ''})"

        lines, fence = [], None
        for line in text.splitlines():
            mark = FENCE.match(line)
            if mark and fence in (None, mark.group(1)):
                fence = None if fence else mark.group(1)
            lines.append(line if fence or mark else LINK.sub(replaced, line))
        return "\n".join(lines) + "\n"

    def write(self, page, text):
        path = self.output / page
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def copy_markdown(self, origin, page):
        text = (self.source / origin).read_text(encoding="utf-8")
        self.write(page, self.rewrite(text, origin, page))


def stage_documents(site):
    docs = site.source / "docs"
    for path in sorted(docs.rglob("*")):
        inside = path.relative_to(docs)
        if inside.parts[:2] in (("results", "runs"),):
            continue
        if path.suffix == ".md":
            site.copy_markdown(f"docs/{inside}", str(inside))
        elif path.suffix in (".png", ".svg"):
            (site.output / inside).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, site.output / inside)
    for origin in PROJECT_PAGES:
        site.copy_markdown(origin, f"project/{origin}")


def stage_program(site, program):
    names = reference.subcommands(program)
    site.write("reference/subcommands/index.md", reference.subcommands_page(program, names) + toctree(
        [name for name, _ in names]))
    for name, _ in names:
        site.write(f"reference/subcommands/{name}.md", reference.program_page(program, name, "help", name))
    run_log = program.with_name("cartographer_sdf_run_log")
    if run_log.exists():
        site.write("reference/subcommands/cartographer_sdf_run_log.md",
                   reference.program_page(run_log, run_log.name, "--help"))


def stage_reference(site, program):
    stage_program(site, program)
    lines = ["# Options", "", "One page for each file of `configuration_files/`.", ""]
    for name in OPTION_FILES:
        site.write(f"reference/options/{name}.md",
                   reference.options_page(site.source / "configuration_files" / f"{name}.lua"))
        lines.append(f"- [{name}.lua]({name}.md)")
    site.write("reference/options/index.md", "\n".join([*lines, ""]) + toctree(OPTION_FILES))
    site.write("reference/verdicts.md", reference.verdicts_page(site.source))
    site.write("reference/python.md", reference.python_page(
        site.source / "python/cartographer_sdf/__init__.pyi", site.source / "python/cartographer_sdf/__init__.py"))
    site.write("reference/ros.md", reference.ros_page(site.source / "ros"))


def folder_summaries(overview):
    """What the table of folders in docs/design/overview.md says of each."""
    summaries = {}
    for names, text in re.findall(r"^\| ((?:`\w+/`(?:, )?)+) \| (.+) \|$", overview, re.MULTILINE):
        for name in re.findall(r"`(\w+)/`", names):
            summaries[name] = text[0].upper() + text[1:]
    return summaries


def stage_cpp(site, doxygen_xml):
    compounds = cpp_reference.Compounds(doxygen_xml)
    overview = "docs/design/overview.md"
    summaries = folder_summaries(site.rewrite((site.source / overview).read_text(encoding="utf-8"), overview,
                                              "reference/cpp/folder.md"))
    lines = ["# C++ API", "", "The headers, folder by folder; all names are in the namespace `cartographer_sdf`. "
             "How the folders depend on each other: [overview](../../design/overview.md#the-tree).", ""]
    for folder in site.cpp_folders:
        summary = summaries[folder] + "."
        site.write(f"reference/cpp/{folder}.md", cpp_reference.folder_page(
            folder, site.headers(folder), site.source, compounds, summary))
        names = ", ".join(f"`{header.name}`" for header in site.headers(folder))
        lines.append(f"- [{folder}/]({folder}.md): {names}")
    site.write("reference/cpp/index.md", "\n".join([*lines, "", reference.generated_from(
        "the headers, by Doxygen")]) + toctree(site.cpp_folders))


def stage_sources(site):
    for path in sorted(site.linked_files):
        file = site.source / path
        lines = ["---", "orphan: true", "---", "", f"# {path}", ""]
        if file.is_dir():
            lines += [f"- `{child.name}`" for child in sorted(file.iterdir())]
        else:
            language = LANGUAGES.get(file.suffix, "text")
            text = file.read_text(encoding="utf-8").rstrip()
            fence = "~~~" if "```" in text else "```"
            lines += [f"{fence}{language}", text, fence]
        site.write(f"source/{path}.md", "\n".join(lines) + "\n")


def toctree(pages, caption=None):
    options = [":hidden:"] + ([f":caption: {caption}"] if caption else [])
    return "\n".join(["", "```{toctree}", *options, "", *pages, "```", ""])


GROUPS = {"tutorials": "Tutorials", "howto": "How to", "": "Guides"}


def navigation(documents):
    """(caption, pages) with all of `documents`, paths in docs/ without suffix."""
    groups = {caption: list(pages) for caption, pages in NAVIGATION}
    listed = {page for pages in groups.values() for page in pages} | {"index"}
    for page in sorted(documents):
        folder = page.rpartition("/")[0]
        if page not in listed and folder in GROUPS:
            groups[GROUPS[folder]].append(page)
    return list(groups.items())


def stage_navigation(site):
    """The tree of pages, at the end of the first page of each group."""
    run_log = site.output / "reference/subcommands/cartographer_sdf_run_log.md"
    index = (site.output / "index.md").read_text(encoding="utf-8")
    docs = site.source / "docs"
    documents = [path.relative_to(docs).with_suffix("").as_posix() for path in docs.rglob("*.md")]
    for caption, pages in navigation(documents):
        index += toctree(pages, caption)
    site.write("index.md", index)
    for first, folder in (("design.md", "design"), ("results/README.md", "results")):
        pages = sorted(page.relative_to((site.output / first).parent).with_suffix("").as_posix()
                       for page in (site.output / folder).glob("*.md") if page.name != "README.md")
        site.write(first, (site.output / first).read_text(encoding="utf-8") + toctree(pages))
    if run_log.exists():
        subcommands = site.output / "reference/subcommands/index.md"
        site.write("reference/subcommands/index.md",
                   subcommands.read_text(encoding="utf-8") + toctree([run_log.stem]))
    for page in ("project/README.md", "project/ros/README.md"):
        site.write(page, "---\norphan: true\n---\n\n" + (site.output / page).read_text(encoding="utf-8"))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--doxygen-xml", type=pathlib.Path)
    parser.add_argument("--headers", type=pathlib.Path, help="only copies the headers, for Doxygen, to this folder")
    arguments = parser.parse_args()
    site = Site(arguments.source.resolve(), arguments.output)
    if arguments.headers:
        headers = [header for folder in site.cpp_folders for header in site.headers(folder)]
        doxygen_headers.copy_headers(headers, site.source, arguments.headers)
        return
    stage_documents(site)
    stage_reference(site, arguments.program.resolve())
    if arguments.doxygen_xml:
        stage_cpp(site, arguments.doxygen_xml)
    stage_sources(site)
    stage_navigation(site)
    if site.faults:
        raise SystemExit("\n".join(site.faults))


if __name__ == "__main__":
    main()
