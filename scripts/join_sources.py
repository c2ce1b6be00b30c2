#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Joins the sources that CMake compiles together into one file each.

usage: join_sources.py BUILD_DIR JOINED_DIR
       join_sources.py --name JOINED_DIR < findings

CMake's unity files include their sources. Clang's static analyser follows paths
only through what the main file itself holds, so that it is blind to them; a few
checks of clang-tidy, too, leave included files alone. The first form writes
JOINED_DIR with files that hold their sources, and compile_commands.json; the
second replaces places in the joined files by those in the sources.
"""

import bisect
import json
import pathlib
import re
import sys

# The line of each joined file where each source begins.
TABLE = "sources.json"
INCLUDE = re.compile(r'#include ("[^"]+"|<[^>]+>)')
CONDITION = re.compile(r"#\s*(if|endif)")


def without_repeated_includes(text, included):
    """Blanks what an earlier source has included, as its own repetition is a finding."""
    lines, depth, own = [], 0, set()
    for line in text.splitlines():
        condition, include = CONDITION.match(line), INCLUDE.match(line)
        if condition:
            depth += 1 if condition[1] == "if" else -1
        if include and depth == 0:
            if include[1] in included and include[1] not in own:
                line = ""
            own.add(include[1])
        lines.append(line)
    included |= own
    return lines


def join(unity):
    """The lines of a unity file's sources, and [first line, source] of each."""
    lines, beginnings, included = [], [], set()
    for source in INCLUDE.findall(unity.read_text()):
        source = source.strip('"')
        beginnings.append([len(lines) + 1, source])
        lines += without_repeated_includes(pathlib.Path(source).read_text(), included)
    return lines, beginnings


def write_joined(build_dir, joined_dir):
    joined_dir.mkdir(parents=True, exist_ok=True)
    entries, table = [], {}
    for entry in json.loads((build_dir / "compile_commands.json").read_text()):
        path = pathlib.Path(entry["file"])
        if "Unity" not in path.parts:
            entries.append(entry)
            continue
        target = path.parts[path.parts.index("Unity") - 1].replace(".dir", "")
        joined = joined_dir / f"{target}_{path.stem}.cc"
        lines, table[str(joined)] = join(path)
        joined.write_text("\n".join(lines) + "\n")
        entries.append(dict(entry, file=str(joined), command=entry["command"].replace(str(path), str(joined))))
    (joined_dir / "compile_commands.json").write_text(json.dumps(entries, indent=1))
    (joined_dir / TABLE).write_text(json.dumps(table))


def name_sources(joined_dir):
    table = json.loads((joined_dir / TABLE).read_text())
    place = re.compile("(" + ("|".join(map(re.escape, table)) or "(?!)") + r"):(\d+)")  # (?!): nothing was joined

    def source_of(match):
        beginnings, line = table[match[1]], int(match[2])
        first, source = beginnings[bisect.bisect([first for first, _ in beginnings], line) - 1]
        return f"{source}:{line - first + 1}"

    for text in sys.stdin:
        sys.stdout.write(place.sub(source_of, text))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    if sys.argv[1] == "--name":
        name_sources(pathlib.Path(sys.argv[2]).resolve())
    else:
        write_joined(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve())


if __name__ == "__main__":
    main()
