#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Measures the node for ROS 1 beside stock cartographer_node.

usage: measure_ros.py mapping RESULT.json LOG...
       measure_ros.py localization RESULT.json [STARTS]

mapping drives the bags of whole logs (e.g. aces) through cartographer_node and
through cartographer_sdf_node without Cartographer's own loop search.
localization drives 40 s of willow_2 from evenly spaced starts (20) in the frozen
map of willow_1. Both append a row for each run to RESULT.json and print it.

Times of mapping are seconds since the bag begins to play. The node runs on after
the last scan until it is idle: last_match is when it logged the last match that
holds (stock: of a node with a submap; the searcher: of two submaps), last_growth
when the inter-submap constraints on /constraint_list, running_constraints in the
end, were last seen to be more than at the end of the bag; null if they were not.

Needs what scripts/test_ros.sh needs, in an environment of a workspace with
cartographer_sdf_ros and with a network of its own (unshare -n, ip link set lo
up); BUILD_DIR, DATA_DIR and WORK_DIR as of measure_live.py, and RATE, in seconds of the
recording per second (10 for mapping, 4 for localization).
"""

import json
import os
import pathlib
import re
import signal
import struct
import subprocess
import sys
import tempfile
import time

import make_bag
import measure_live as live
import rosgraph
import rospy
from cartographer_ros_msgs.srv import FinishTrajectory
from cartographer_sdf_msgs.srv import Locate, LocateRequest
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from ros_drive_test import call, is_saved, num_inter_constraints, play, run, wait_until, yaw_of

HERE = pathlib.Path(__file__).resolve().parent
ROS_PREFIX = os.environ["CARTOGRAPHER_ROS_PREFIX"] + "/lib/"
SECONDS = 40.
# A node is idle if it takes less than this share of a core for so many looks of a second.
IDLE_SHARE, IDLE_LOOKS, LONGEST_WORK = 0.1, 4, 600.
# A line of the log of a node with its time [s since 1970].
MATCH = re.compile(r"\[(\d+\.\d+)[^]]*\]: .*\] "
                   r"(?:Node \(.* differs by |closure of submap .*: ready)")
MAPPING = {
    "stock": ("cartographer_ros", "cartographer_node", "robot_mapping.lua"),
    "searcher": ("cartographer_sdf_ros", "cartographer_sdf_node",
                 "robot_mapping_searcher_only.lua"),
}


class Node:
    """A node with its own CPU time."""

    def __init__(self, package, program, basename, work, *flags):
        prefixes = os.environ["CMAKE_PREFIX_PATH"].split(":")
        paths = [pathlib.Path(prefix) / "lib" / package / program for prefix in prefixes]
        share = next(pathlib.Path(prefix) / "share/cartographer_sdf_ros/configuration_files"
                     for prefix in prefixes
                     if (pathlib.Path(prefix) / "share/cartographer_sdf_ros").exists())
        environment = {**os.environ, "MALLOC_TRIM_THRESHOLD_": "536870912",
                       "MALLOC_MMAP_THRESHOLD_": "33554432"}
        with open(work / "node.log", "w", encoding="utf-8") as log:
            self.process = subprocess.Popen(
                [next(path for path in paths if path.exists()), "-configuration_directory", share,
                 "-configuration_basename", basename, *flags], env=environment,
                stdout=log, stderr=subprocess.STDOUT)

    def cpu_seconds(self):
        status = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text()
        ticks = status.rsplit(")", 1)[1].split()[11:13]
        return sum(map(int, ticks)) / os.sysconf("SC_CLK_TCK")

    def end(self):
        """Ends it as rosnode does; returns its CPU time [s]."""
        subprocess.run(["rosnode", "kill", "/cartographer_node"], check=False,
                       stdout=subprocess.DEVNULL)
        _, _, usage = os.wait4(self.process.pid, 0)
        self.process.returncode = 0
        return usage.ru_utime + usage.ru_stime


def count_inter_constraints(data):
    """Of an encoded visualization_msgs/MarkerArray of /constraint_list: decoding all of its
    points would keep a core busy."""
    def skip(position, *sizes):
        """Past lists and texts with entries of these sizes."""
        for size in sizes:
            position += 4 + size * struct.unpack_from("<I", data, position)[0]
        return position

    count, position = 0, 4
    for _ in range(struct.unpack_from("<I", data)[0]):
        begin = skip(position + 12, 1)  # a sequence number, a stamp and the frame
        position = skip(begin, 1)
        name = data[begin + 4:position]
        position += 12 + 56 + 24 + 16 + 8 + 1  # from id to frame_locked
        if name.startswith(b"Inter constraints"):
            count += struct.unpack_from("<I", data, position)[0] // 2
        position = skip(position, 24, 16, 1, 1) + 1  # points, colors, text, mesh
    return count


def watch_until_idle(node, begin):
    """Of a node whose bag has ended; see above."""
    def count():
        return count_inter_constraints(
            rospy.wait_for_message("/constraint_list", rospy.AnyMsg, 60)._buff)

    seen, last_growth, looks, idle_from = count(), None, 0, None
    end = time.time() + LONGEST_WORK
    while looks < IDLE_LOOKS and time.time() < end:
        look_from, before = time.time() - begin, node.cpu_seconds()
        time.sleep(1.)
        is_busy = node.cpu_seconds() - before > IDLE_SHARE
        now = count()
        if now > seen:
            seen, last_growth, is_busy = now, time.time() - begin, True
        if looks == 0:
            idle_from = look_from
        looks = 0 if is_busy else looks + 1
    return {"last_growth": last_growth, "running_constraints": seen,
            "idle_from": idle_from if looks == IDLE_LOOKS else None}


def last_match(log, begin):
    """None if nothing was matched."""
    found = [float(match[1]) for match in MATCH.finditer(log.read_text(errors="replace"))]
    return max(found) - begin if found else None


def measure_mapping(name, variant):
    with tempfile.TemporaryDirectory(dir=os.environ.get("WORK_DIR")) as directory:
        work = pathlib.Path(directory)
        run("/usr/bin/python3", HERE / "make_bag.py", live.DATA / f"{name}.log.gz",
            work / "drive.bag")
        path = work / "map.pbstream"
        node = Node(*MAPPING[variant], work, f"-save_state_filename={path}")
        begin = time.time()
        play(work / "drive.bag", os.environ.get("RATE", "10"))
        row = {"kind": "mapping", "name": name, "variant": variant,
               "played": time.time() - begin}
        call("/finish_trajectory", FinishTrajectory, 0)
        row.update(watch_until_idle(node, begin))
        end = time.time()
        row["cpu_seconds"] = node.end()
        row["seconds_to_end"] = time.time() - end
        wait_until(lambda: is_saved(path), 10)
        row.update(
            last_match=last_match(work / "node.log", begin),
            inter_constraints=num_inter_constraints(live.BUILD / "cartographer_sdf", path),
            errors=live.evaluate(work, name))
        return row


class Poses:
    """What is published while a bag plays."""

    def __init__(self, truth):
        self.truth, self.found, self.tracked = truth, [], []
        self.subscribers = [
            rospy.Subscriber("/sdf_pose", PoseWithCovarianceStamped,
                             lambda m: self.found.append(self.of(m.header, m.pose.pose))),
            rospy.Subscriber("/tracked_pose", PoseStamped,
                             lambda m: self.tracked.append((m.header, m.pose)))]

    def of(self, header, pose):
        """(time, metres off, degrees off)"""
        stamp = header.stamp.to_sec()
        return (stamp, *self.truth.error({"time": stamp, "x": pose.position.x,
                                          "y": pose.position.y, "yaw": yaw_of(pose.orientation)}))

    def right_from(self):
        """When the published pose begins to stay right; none if it does not end right."""
        since = None
        for stamp, meters, degrees in reversed([self.of(*entry) for entry in self.tracked[::10]]):
            if meters > live.RIGHT_M or degrees > live.RIGHT_DEGREES:
                break
            since = stamp
        return since

    def close(self):
        for subscriber in self.subscribers:
            subscriber.unregister()


def measure_start(truth, map_path, first_stamp, start):
    with tempfile.TemporaryDirectory(dir=os.environ.get("WORK_DIR")) as directory:
        work = pathlib.Path(directory)
        run("/usr/bin/python3", HERE / "make_bag.py", live.DATA / "willow_2.log.gz",
            work / "drive.bag", "--piece", f"{start}:{SECONDS}")
        node = Node("cartographer_sdf_ros", "cartographer_sdf_node", "robot_localization.lua", work,
                    "-load_state_filename", map_path)
        call("/sdf_locate", Locate, LocateRequest(trajectory_id=-1))
        poses = Poses(truth)
        play(work / "drive.bag", os.environ.get("RATE", "4"))
        time.sleep(2.)
        answer = call("/sdf_locate", Locate, LocateRequest(trajectory_id=-1))
        poses.close()
        cpu = node.end()
        begin = first_stamp + start
        since = poses.right_from()
        return {"kind": "localization", "start": start, "located": answer.located,
                "meters": answer.distance_driven, "cpu_seconds": cpu,
                "found": [(stamp - begin, meters, degrees)
                          for stamp, meters, degrees in poses.found],
                "right_after_seconds": since and since - begin}


def main():
    kind, result = sys.argv[1], pathlib.Path(sys.argv[2])
    rows = json.loads(result.read_text()) if result.exists() else []
    with subprocess.Popen(["roscore"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL) as master:
        try:
            wait_until(rosgraph.is_master_online, 30)
            rospy.set_param("/use_sim_time", True)
            rospy.init_node("measure_ros", disable_signals=True)
            if kind == "mapping":
                tasks = [lambda n=name, v=variant: measure_mapping(n, v)
                         for name in sys.argv[3:] for variant in MAPPING]
            else:
                count = int(sys.argv[3]) if len(sys.argv) > 3 else 20
                truth = live.WillowTruth()
                first = make_bag.read_log(str(live.DATA / "willow_2.log.gz"))[0][0]
                length = truth.times[-1] - first - SECONDS
                path = live.DATA / "willow_1.pbstream"
                tasks = [lambda start=round(k * length / (count - 1), 1): measure_start(
                    truth, path, first, start) for k in range(count)]
            for task in tasks:
                rows.append(task())
                print(json.dumps(rows[-1]), flush=True)
                result.write_text(json.dumps(rows, indent=1))
        finally:
            master.send_signal(signal.SIGINT)


if __name__ == "__main__":
    main()
