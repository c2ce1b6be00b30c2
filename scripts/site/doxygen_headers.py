#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Copies headers for Doxygen, with comments in the form that it reads.

The headers are commented in Google style: a comment above a declaration, or
behind it. Doxygen wants to see "///" and "///<". As a filter that Doxygen calls
for each file this would take minutes.
"""

import re

COMMENT = re.compile(r"^(\s*)// ?(.*)$")
TRAILING = re.compile(r"^(.*\S)\s+// ?(.*)$")
NOT_FOR_READERS = re.compile(r"^(Long: |NOLINT|SPDX-|---)")


def escape(text):
    """Takes the meaning from characters that are Doxygen's, outside of code."""
    parts = text.split("`")
    parts[::2] = [re.sub(r"([\\@<>#%&])", r"\\\1", part) for part in parts[::2]]
    return "`".join(parts)


def file_comment(lines):
    """Returns the number of lines above the code, and what they say of the file."""
    description = []
    for number, line in enumerate(lines):
        match = COMMENT.match(line)
        if line.strip() and not match:
            return number, description
        if match and not NOT_FOR_READERS.match(match.group(2)):
            description.append(match.group(2))
    return len(lines), description


def blocks(lines):
    """Yields (is comment, lines): comments that stand alone, and the rest."""
    block = []
    for line in lines:
        if bool(COMMENT.match(line)) != bool(block and COMMENT.match(block[-1])) and block:
            yield bool(COMMENT.match(block[-1])), block
            block = []
        block.append(line)
    if block:
        yield bool(COMMENT.match(block[-1])), block


def convert_code(line):
    match = TRAILING.match(line)
    if not match or '"' in match.group(2) and match.group(1).count('"') % 2:
        return line, None
    code, text = match.groups()
    if NOT_FOR_READERS.match(text) or code.lstrip().startswith("}"):
        return code, None
    return f"{code}  ///< {escape(text)}", line.rindex("//")


def convert(lines):
    begin, _ = file_comment(lines)
    lines = lines[begin:]
    parts = list(blocks(lines))
    column = None  # Of the comment behind the last line of code.
    for number, (is_comment, block) in enumerate(parts):
        if not is_comment:
            for line in block:
                code, column = convert_code(line)
                yield code.replace("[[nodiscard]] ", "")
            continue
        # One that is followed by an empty line is about no declaration.
        next_line = parts[number + 1][1][0] if number + 1 < len(parts) else ""
        for line in block:
            indentation, text = COMMENT.match(line).groups()
            if NOT_FOR_READERS.match(text):
                continue
            if column is not None and len(indentation) == column:
                yield f"{indentation}///< {escape(text)}"
            else:
                column = None
                yield f"{indentation}{'///' if next_line.strip() else '//'} {escape(text)}"


def copy_headers(headers, source, target):
    """Copies `headers` from below `source` to the same paths below `target`."""
    for header in headers:
        copy = target / header.relative_to(source)
        copy.parent.mkdir(parents=True, exist_ok=True)
        lines = header.read_text(encoding="utf-8").splitlines()
        copy.write_text("\n".join(convert(lines)) + "\n", encoding="utf-8")
