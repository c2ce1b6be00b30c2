#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Draws maps side by side, in one frame and at one scale, with nothing on them.

usage: draw_maps.py OUTPUT.png MAP.yaml [MAP.yaml...] [--pixel METERS]
                    [--window X0 Y0 X1 Y1] [--bar METERS]

Each map is one of ROS, as `export --map_filestem` writes it. A pixel of the
picture is a wall if any cell below it is one. --window [m] is the part that is
shown, by default what the maps cover; --bar draws a scale bar in the lower left
corner of the first.
"""

import argparse
import pathlib
import struct
import zlib

import cast_scan

# Walls, free space, what is unknown, and the bar with the line between maps.
WALL, FREE, UNKNOWN, INK = range(4)
COLOURS = ((0x1b, 0x26, 0x3b), (0xbf, 0xd7, 0xed), (0xff, 0xff, 0xff), (0x9b, 0x22, 0x26))
KINDS = bytes(WALL if gray < 100 else FREE if gray > 240 else UNKNOWN for gray in range(256))
GAP = 12  # Pixels between maps.


def shrink(rows, left, top, size, factor):
    """`size` (width, height) pixels of the picture, each of factor x factor
    cells, from the cell (left, top) on, which may lie outside."""
    width, height = size
    for row in range(height):
        band = [rows[i].translate(KINDS) for i in range(top + row * factor, top + (row + 1) * factor)
                if 0 <= i < len(rows)]
        line = bytes(map(min, *band)) if len(band) > 1 else band[0] if band else b""
        padded = bytes([UNKNOWN]) * max(0, -left) + line[max(0, left):]
        padded = padded[:width * factor].ljust(width * factor, bytes([UNKNOWN]))
        yield bytes(map(min, *(padded[k::factor] for k in range(factor)))) if factor > 1 else padded


def png(rows):
    """An image of four colours, two bits a pixel."""
    width = len(rows[0])
    packed = bytearray()
    for row in rows:
        row = row.ljust(-(-width // 4) * 4, b"\0")
        packed.append(0)
        packed += bytes(a << 6 | b << 4 | c << 2 | d for a, b, c, d in zip(*(row[k::4] for k in range(4))))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, len(rows), 2, 3, 0, 0, 0)) + chunk(
        b"PLTE", bytes(value for colour in COLOURS for value in colour)) + chunk(
            b"IDAT", zlib.compress(bytes(packed), 9)) + chunk(b"IEND", b"")


def extent(world):
    rows, resolution, left, bottom = world
    return left, bottom, left + len(rows[0]) * resolution, bottom + len(rows) * resolution


def draw(paths, pixel, window=None, bar=None):
    """The picture of the maps as a PNG. `pixel` and `bar` in metres."""
    worlds = [cast_scan.read_map(path) for path in paths]
    if window is None:
        extents = list(zip(*map(extent, worlds)))
        window = (min(extents[0]), min(extents[1]), max(extents[2]), max(extents[3]))
    size = (round((window[2] - window[0]) / pixel), round((window[3] - window[1]) / pixel))
    parts = []
    for rows, resolution, left, bottom in worlds:
        factor = max(1, round(pixel / resolution))
        top = bottom + len(rows) * resolution
        parts.append(list(shrink(rows, round((window[0] - left) / resolution), round((top - window[3]) / resolution),
                                 size, factor)))
    gap = bytes([UNKNOWN]) * (GAP // 2) + bytes([INK]) + bytes([UNKNOWN]) * (GAP // 2)
    rows = [gap.join(lines) for lines in zip(*parts)]
    if bar:
        length = round(bar / pixel)
        for i in range(len(rows) - 16, len(rows) - 12):
            rows[i] = rows[i][:12] + bytes([INK]) * length + rows[i][12 + length:]
    return png(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("maps", type=pathlib.Path, nargs="+")
    parser.add_argument("--pixel", type=float, default=0.1)
    parser.add_argument("--window", type=float, nargs=4)
    parser.add_argument("--bar", type=float)
    arguments = parser.parse_args()
    arguments.output.write_bytes(draw(arguments.maps, arguments.pixel, arguments.window, arguments.bar))
    print(arguments.output)


if __name__ == "__main__":
    main()
