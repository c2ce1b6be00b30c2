#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Makes a ROS 1 bag of a CARMEN log, as a robot with one laser would record it.

usage: make_bag.py LOG BAG [--piece START:DURATION[:OFFSET]]... [options]

Topics: /scan (sensor_msgs/LaserScan, frame laser), /odom (nav_msgs/Odometry,
base_link in odom, 40 Hz, interpolated), the same on /tf, and /tf_static
(base_link <- laser, the identity). A piece is given in seconds since the log's
first scan; OFFSET [s] is added to its stamps. From one piece to the next the
robot is carried away: odometry goes on where it was. All of the log is one piece
by default.

Formats and angles of logs are those of docs/run_log.md. Needs Debian's
python3-rosbag, python3-sensor-msgs, python3-nav-msgs and python3-tf2-msgs.
"""

import argparse
import gzip
import math

import genpy
import rosbag
from geometry_msgs.msg import Quaternion, TransformStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage

ODOMETRY_RATE = 40.  # [1/s]
# Times that merely count the scans become this long each [s]; larger whole
# numbers are dates.
LARGEST_SCAN_NUMBER = 1e8
SECONDS_PER_SCAN = 0.1
FIRST_STAMP = 1e9


def read_log(path):
    """Returns (time, ranges, (x, y, yaw) of odometry) of each scan."""
    scans = []
    opened = gzip.open(path, "rt") if path.endswith(".gz") else open(path, encoding="ascii")
    with opened as log:
        for line in log:
            words = line.split()
            if not words or words[0] != "FLASER":
                continue
            count = int(words[1])
            ranges = [float(word) for word in words[2:2 + count]]
            rest = words[2 + count:]
            pose = tuple(float(word) for word in rest[3:6])
            scans.append((float(rest[6]), ranges, pose))
    times = [scan[0] for scan in scans]
    are_numbers = (all(time == int(time) <= LARGEST_SCAN_NUMBER for time in times)
                   and all(a < b for a, b in zip(times, times[1:])))
    if not are_numbers and len(set(times)) > 1:
        return scans
    numbers = times if are_numbers else range(len(scans))
    return [(FIRST_STAMP + SECONDS_PER_SCAN * number, *scan[1:])
            for number, scan in zip(numbers, scans)]


def angles(count, field_of_view):
    """Returns the direction of the first beam and the angle between two."""
    if field_of_view is None:
        field_of_view = 180. if count in (180, 181, 360) else 270.
    field_of_view = math.radians(field_of_view)
    return -field_of_view / 2., field_of_view / (count if count % 2 == 0 else count - 1)


def relative(origin, pose):
    """The pose seen from the origin."""
    dx, dy = pose[0] - origin[0], pose[1] - origin[1]
    cosine, sine = math.cos(origin[2]), math.sin(origin[2])
    return (cosine * dx + sine * dy, cosine * dy - sine * dx, pose[2] - origin[2])


def compose(a, b):
    """The pose b, seen from a, in the frame of a."""
    cosine, sine = math.cos(a[2]), math.sin(a[2])
    return (a[0] + cosine * b[0] - sine * b[1], a[1] + sine * b[0] + cosine * b[1],
            a[2] + b[2])


def interpolate(a, b, fraction):
    """Between two poses; the yaw goes the short way."""
    turn = (b[2] - a[2] + math.pi) % (2. * math.pi) - math.pi
    return (a[0] + fraction * (b[0] - a[0]), a[1] + fraction * (b[1] - a[1]),
            a[2] + fraction * turn)


def quaternion(yaw):
    return Quaternion(0., 0., math.sin(yaw / 2.), math.cos(yaw / 2.))


def transform(stamp, parent, child, pose):
    message = TransformStamped()
    message.header.stamp = stamp
    message.header.frame_id = parent
    message.child_frame_id = child
    message.transform.translation.x, message.transform.translation.y = pose[:2]
    message.transform.rotation = quaternion(pose[2])
    return message


def write_odometry(bag, time, pose):
    stamp = genpy.Time.from_sec(time)
    message = Odometry()
    message.header.stamp = stamp
    message.header.frame_id = "odom"
    message.child_frame_id = "base_link"
    message.pose.pose.position.x, message.pose.pose.position.y = pose[:2]
    message.pose.pose.orientation = quaternion(pose[2])
    bag.write("/odom", message, stamp)
    bag.write("/tf", TFMessage([transform(stamp, "odom", "base_link", pose)]), stamp)


def write_scan(bag, time, ranges, max_range, field_of_view):
    message = LaserScan()
    message.header.stamp = genpy.Time.from_sec(time)
    message.header.frame_id = "laser"
    message.angle_min, message.angle_increment = angles(len(ranges), field_of_view)
    message.angle_max = message.angle_min + (len(ranges) - 1) * message.angle_increment
    message.range_max = max_range
    message.ranges = ranges
    bag.write("/scan", message, message.header.stamp)


def write_piece(bag, scans, offset, begin, arguments):
    """Writes consecutive scans and the odometry between them.

    Odometry goes from `begin` on; returns where it ends.
    """
    def odometry(pose):
        return compose(begin, relative(scans[0][2], pose))

    stamp = genpy.Time.from_sec(scans[0][0] + offset)
    bag.write("/tf_static",
              TFMessage([transform(stamp, "base_link", "laser", (0., 0., 0.))]), stamp)
    for k, (time, ranges, pose) in enumerate(scans):
        if k == 0:
            write_odometry(bag, time + offset, odometry(pose))
        else:
            last_time, _, last_pose = scans[k - 1]
            count = max(1, math.ceil((time - last_time) * ODOMETRY_RATE))
            for i in range(1, count + 1):
                fraction = i / count
                write_odometry(
                    bag, last_time + fraction * (time - last_time) + offset,
                    odometry(interpolate(last_pose, pose, fraction)))
        write_scan(bag, time + offset, ranges, arguments.max_range,
                   arguments.field_of_view)
    return odometry(scans[-1][2])


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log")
    parser.add_argument("bag")
    parser.add_argument("--piece", action="append", default=[])
    parser.add_argument("--field_of_view", type=float, help="[degrees]")
    parser.add_argument("--max_range", type=float, default=30.,
                        help="[m] of the laser; cartographer_ros drops longer beams, as it does "
                        "what real lasers report where nothing returns (30)")
    arguments = parser.parse_args()
    scans = read_log(arguments.log)
    first = scans[0][0]
    begin = (0., 0., 0.)
    with rosbag.Bag(arguments.bag, "w", compression="lz4") as bag:
        for piece in arguments.piece or ["0:1e12"]:
            start, duration, offset = ([float(v) for v in piece.split(":")] + [0.])[:3]
            part = [scan for scan in scans
                    if start <= scan[0] - first <= start + duration]
            if not part:
                parser.error(f"no scan in the piece {piece}")
            begin = write_piece(bag, part, offset, begin, arguments)


if __name__ == "__main__":
    main()
