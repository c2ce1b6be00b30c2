#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Splits a map (.pbstream, 2D) in two, for measuring how well they are merged.

usage: split_map.py MAP FIRST SECOND --at SUBMAP [--turn DEGREES] [--shift X Y]
       split_map.py MAP FIRST SECOND --trajectories A B [...]

By time: FIRST gets the submaps before SUBMAP and their nodes, SECOND those
after it (SUBMAP itself, whose scans are in both, is dropped) and the other
nodes; of each trajectory. By trajectory: FIRST gets A, SECOND gets B. Sensor
data goes along by trajectory, in both by time. Poses of SECOND in the map frame
are turned about the origin and shifted. Ids stay as they are. Landmarks go
along with both.
"""

import argparse
import gzip
import math
import struct
import sys

MAGIC = 0x7B1D1F7B5BF501DB

# Fields of the messages, by number.
POSE_GRAPH, OPTIONS, SUBMAP, NODE = 1, 2, 3, 4
CONSTRAINT, TRAJECTORY, LANDMARK = 2, 4, 5


def read_varint(data, at):
    value = shift = 0
    while True:
        byte = data[at]
        at += 1
        value |= (byte & 0x7F) << shift
        if byte < 0x80:
            return value, at
        shift += 7


def varint(value):
    value &= (1 << 64) - 1
    encoded = bytearray()
    while value >= 0x80:
        encoded.append(value & 0x7F | 0x80)
        value >>= 7
    encoded.append(value)
    return bytes(encoded)


def fields(data):
    """[(number, type, value)], in order; a value is an int or bytes."""
    result, at = [], 0
    while at < len(data):
        tag, at = read_varint(data, at)
        number, kind = tag >> 3, tag & 7
        if kind == 0:
            value, at = read_varint(data, at)
        elif kind == 1:
            value, at = data[at:at + 8], at + 8
        elif kind == 2:
            size, at = read_varint(data, at)
            value, at = data[at:at + size], at + size
        elif kind == 5:
            value, at = data[at:at + 4], at + 4
        else:
            raise ValueError("a field of type %d" % kind)
        result.append((number, kind, value))
    return result


def message(contents):
    encoded = bytearray()
    for number, kind, value in contents:
        encoded += varint(number << 3 | kind)
        if kind == 0:
            encoded += varint(value)
        else:
            if kind == 2:
                encoded += varint(len(value))
            encoded += value
    return bytes(encoded)


def get(contents, number, default):
    """The last field of that number, as protocol buffers have it."""
    return next((value for n, _, value in reversed(contents) if n == number), default)


def put(contents, number, kind, value):
    kept = [field for field in contents if field[0] != number]
    return kept + [(number, kind, value)]


def read_id(data):
    contents = fields(data)
    return get(contents, 1, 0), get(contents, 2, 0)


def read_records(path):
    with open(path, "rb") as stream:
        if stream.read(8) != struct.pack("<Q", MAGIC):
            raise ValueError("%s is no .pbstream" % path)
        while True:
            size = stream.read(8)
            if not size:
                return
            yield gzip.decompress(stream.read(struct.unpack("<Q", size)[0]))


class Writer:
    def __init__(self, path):
        self.stream = open(path, "wb")
        self.stream.write(struct.pack("<Q", MAGIC))

    def write(self, record):
        compressed = gzip.compress(record, 1, mtime=0)
        self.stream.write(struct.pack("<Q", len(compressed)) + compressed)


def read_doubles(data, count):
    contents = fields(data)
    zero = struct.pack("<d", 0.)
    return [struct.unpack("<d", get(contents, k + 1, zero))[0] for k in range(count)]


def doubles(values):
    return message([(k + 1, 1, struct.pack("<d", value)) for k, value in enumerate(values)])


def moved(pose, yaw, x, y):
    """A Rigid3d of the map frame, turned about its origin and then shifted."""
    contents = fields(pose)
    p = read_doubles(get(contents, 1, b""), 3)
    qx, qy, qz, qw = read_doubles(get(contents, 2, b""), 4)
    c, s = math.cos(yaw), math.sin(yaw)
    a, b = math.cos(yaw / 2), math.sin(yaw / 2)
    return message([
        (1, 2, doubles([c * p[0] - s * p[1] + x, s * p[0] + c * p[1] + y, p[2]])),
        (2, 2, doubles([a * qx - b * qy, a * qy + b * qx, a * qz + b * qw, a * qw - b * qz]))])


class Half:
    """Which submaps and nodes belong to it, and where its map frame is."""

    def __init__(self, has_submap, has_node, has_trajectory, yaw, x, y):
        self.has_submap, self.has_node = has_submap, has_node
        self.has_trajectory = has_trajectory
        self.move = lambda pose: moved(pose, yaw, x, y) if (yaw, x, y) != (0, 0, 0) else pose

    def pose_graph(self, graph):
        result = []
        for number, kind, value in fields(graph):
            if number == CONSTRAINT:
                contents = fields(value)
                if not (self.has_submap(*read_id(get(contents, 1, b"")))
                        and self.has_node(*read_id(get(contents, 2, b"")))):
                    continue
            elif number == TRAJECTORY:
                value = self.trajectory(fields(value))
                if value is None:
                    continue
            elif number == LANDMARK:
                contents = fields(value)
                value = message(put(contents, 2, 2, self.move(get(contents, 2, b""))))
            result.append((number, kind, value))
        return message(result)

    def trajectory(self, contents):
        trajectory = get(contents, 3, 0)
        if not self.has_trajectory(trajectory):
            return None
        result = []
        for number, kind, value in contents:
            if number in (1, 2):
                element = fields(value)
                index = get(element, 7 if number == 1 else 2, 0)
                has = self.has_node if number == 1 else self.has_submap
                if not has(trajectory, index):
                    continue
                pose = 5 if number == 1 else 1
                value = message(put(element, pose, 2, self.move(get(element, pose, b""))))
            result.append((number, kind, value))
        return message(result)

    def options(self, options, trajectories):
        entries = fields(options)
        return message([entry for entry, trajectory in zip(entries, trajectories)
                        if self.has_trajectory(trajectory)])

    def has_record(self, number, value):
        contents = fields(value)
        if number == SUBMAP:
            return self.has_submap(*read_id(get(contents, 1, b"")))
        if number == NODE:
            return self.has_node(*read_id(get(contents, 1, b"")))
        return self.has_trajectory(get(contents, 1, 0))


def first_nodes(graph, submap):
    """Of each trajectory, the first node that only submaps after `submap` hold."""
    first = {}
    for number, _, value in fields(graph):
        if number != CONSTRAINT:
            continue
        contents = fields(value)
        if get(contents, 5, 0) != 0:
            continue
        trajectory, index = read_id(get(contents, 1, b""))
        _, node = read_id(get(contents, 2, b""))
        if index > submap:
            first[trajectory] = min(first.get(trajectory, node), node)
    return first


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("map")
    parser.add_argument("outputs", nargs=2)
    parser.add_argument("--at", type=int)
    parser.add_argument("--trajectories", type=int, nargs=2)
    parser.add_argument("--turn", type=float, default=0.)
    parser.add_argument("--shift", type=float, nargs=2, default=(0., 0.))
    arguments = parser.parse_args()
    if (arguments.at is None) == (arguments.trajectories is None):
        parser.error("either --at or --trajectories")
    records = read_records(arguments.map)
    header = next(records)
    graph = get(fields(next(records)), POSE_GRAPH, b"")
    options = get(fields(next(records)), OPTIONS, b"")
    trajectories = [get(fields(value), 3, 0) for number, _, value in fields(graph)
                    if number == TRAJECTORY]
    pose = (math.radians(arguments.turn), *arguments.shift)
    if arguments.at is not None:
        at, first = arguments.at, first_nodes(graph, arguments.at)
        everywhere = lambda trajectory: True
        halves = [
            Half(lambda t, i: i < at, lambda t, i: i < first.get(t, 1 << 31), everywhere, 0, 0, 0),
            Half(lambda t, i: i > at, lambda t, i: i >= first.get(t, 1 << 31), everywhere, *pose)]
    else:
        halves = [Half(lambda t, i, own=own: t == own, lambda t, i, own=own: t == own,
                       lambda t, own=own: t == own, *at)
                  for own, at in zip(arguments.trajectories, ((0, 0, 0), pose))]
    writers = [Writer(path) for path in arguments.outputs]
    for half, writer in zip(halves, writers):
        writer.write(header)
        writer.write(message([(POSE_GRAPH, 2, half.pose_graph(graph))]))
        writer.write(message([(OPTIONS, 2, half.options(options, trajectories))]))
    for record in records:
        (number, _, value), = fields(record)
        for half, writer in zip(halves, writers):
            if half.has_record(number, value):
                writer.write(record)
    if arguments.at is not None:
        print(" ".join("%d:%d" % entry for entry in sorted(first.items())))
    return 0


if __name__ == "__main__":
    sys.exit(main())
