#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Cuts maps to inputs of map_fuzzer and container_fuzzer.

usage: cut_corpus.py DIRECTORY MAP.pbstream...

Of each map, its pose graph, and the first records of each other kind: what the
pose graph names and the file lacks is dropped or refused by the reader. Makes
DIRECTORY/map and DIRECTORY/container.
"""

import gzip
import pathlib
import struct
import sys

# Of each kind, by the field of SerializedData that a record has.
RECORDS_OF_A_KIND = 2
MAX_RECORD_BYTES = 200000


def members_of(path):
    """The magic number, and the compressed records."""
    content = path.read_bytes()
    members, position = [], 8
    while position < len(content):
        size, = struct.unpack_from("<Q", content, position)
        members.append(content[position + 8:position + 8 + size])
        position += 8 + size
    return content[:8], members


def cut(members):
    """The header and the pose graph, and of the others the first few."""
    kept, counts = members[:2], {}
    for member in members[2:]:
        record = gzip.decompress(member)
        kind = record[0] >> 3 if record else 0
        if counts.get(kind, 0) < RECORDS_OF_A_KIND and len(record) <= MAX_RECORD_BYTES:
            counts[kind] = counts.get(kind, 0) + 1
            kept.append(member)
    return kept


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    for name in ("map", "container"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    for path in map(pathlib.Path, sys.argv[2:]):
        magic, members = members_of(path)
        members = cut(members)
        records = [gzip.decompress(member) for member in members]
        (folder / "map" / path.stem).write_bytes(
            b"".join(struct.pack("<I", len(record)) + record for record in records))
        (folder / "container" / path.stem).write_bytes(
            magic + b"".join(struct.pack("<Q", len(member)) + member for member in members))


if __name__ == "__main__":
    main()
