#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Maps and localises through ROS, as a user does, and checks what comes out.

usage: ros_drive_test.py LOG PROGRAM DIRECTORY

Run by scripts/test_ros.sh, which sets up the environment. LOG is a CARMEN log of
at least 400 s, PROGRAM the built cartographer_sdf; bags, maps and logs of the
nodes go to DIRECTORY. With ROS_TEST_RECORD, what the layouts show while the robot
is localised goes to a bag of that name, for scripts/draw_foxglove_layout.py.
"""

import contextlib
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import time

import draw_foxglove_layout
import rosgraph
import rospy
from cartographer_ros_msgs.srv import (FinishTrajectory, GetTrajectoryStates, ReadMetrics,
                                       TrajectoryQuery, WriteState)
from cartographer_sdf_msgs.srv import Locate, LocateRequest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Trigger
from visualization_msgs.msg import MarkerArray

HERE = pathlib.Path(__file__).resolve().parent
# [s] of the recording per second.
RATE = 20
LOCALIZATION_RATE = 10
# Of messages that a node has not taken yet. rosbag drops more than 100 of a topic, which is
# an eighth of a second of odometry, and a loaded computer then maps something else.
QUEUE_SIZE = 100000
# Pieces of the log, from one of which the robot is carried to the other [s]. Not
# around 119 s, where local SLAM slips by 0.8 m if it begins at 60 s.
FIRST_BEGIN, SECOND_BEGIN, LENGTH, PAUSE = 200., 420., 60., 1.
MIN_INTER_CONSTRAINTS = 50
MAX_ERROR = 0.5  # [m]
MAX_ROTATION = 0.1  # [rad]
NODE = "/cartographer_node"
FOXGLOVE_LAYOUT = HERE.parent / "ros/cartographer_sdf_ros/foxglove/searcher.json"
ACTIVE, FROZEN, DELETED = 0, 2, 3


def check(condition, what):
    print(("ok   " if condition else "FAIL ") + what, flush=True)
    if not condition:
        sys.exit(1)


def wait_until(condition, seconds):
    """Returns what the condition returned last."""
    end = time.monotonic() + seconds
    while not (found := condition()) and time.monotonic() < end:
        time.sleep(0.1)
    return found


def run(*command, log=None):
    with open(log, "w") if log else contextlib.nullcontext() as output:
        result = subprocess.run([str(word) for word in command], check=False, text=True,
                                stdin=subprocess.DEVNULL, stderr=subprocess.STDOUT,
                                stdout=output or subprocess.PIPE)
    if result.returncode != 0:
        check(False, f"{command[0]} ends with {result.returncode}: {result.stdout or log}")
    return result.stdout


@contextlib.contextmanager
def launched(directory, name, **arguments):
    """A launch file of ours; ends what it started."""
    words = [f"{key}:={value}" for key, value in arguments.items()]
    with open(directory / f"{name}.log", "w") as log:
        process = subprocess.Popen(["roslaunch", "cartographer_sdf_ros", f"{name}.launch",
                                    "use_sim_time:=true", *words],
                                   stdin=subprocess.DEVNULL, stdout=log,
                                   stderr=subprocess.STDOUT)
        try:
            yield
        finally:
            process.send_signal(signal.SIGINT)
            process.wait()


@contextlib.contextmanager
def recorded(bag, topics):
    """Records topics into a bag, or nothing without a bag."""
    if not bag:
        yield
        return
    with subprocess.Popen(["rosbag", "record", "--quiet", "--lz4", "-O", bag, *topics],
                          stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL) as process:
        try:
            yield
        finally:
            process.send_signal(signal.SIGINT)


def play(bag, rate, *options):
    """Plays a bag for those that listen to all of its topics."""
    run("rosbag", "play", "--clock", "--quiet", "--wait-for-subscribers",
        f"--queue={QUEUE_SIZE}", "-r", rate, *options, bag)


def call(name, kind, *arguments):
    rospy.wait_for_service(name, timeout=120)
    return rospy.ServiceProxy(name, kind)(*arguments)


def map_building(directory, bag):
    """Returns the map that is left when the node ends."""
    path = directory / "map.pbstream"
    with launched(directory, "mapping", save_map=path, collect_metrics="true",
                  configuration_basename="robot_mapping_searcher_only.lua"):
        play(bag, RATE)
        check(call("/finish_trajectory", FinishTrajectory, 0).status.code == 0,
              "the trajectory is finished")
        written = directory / "written.pbstream"
        check(call("/write_state", WriteState, str(written), True).status.code == 0
              and written.exists(), "the state is written while the node runs")
        families = call("/sdf_read_metrics", ReadMetrics).metric_families
        described = [family.metrics[0].value for family in families
                     if family.name == "cartographer_sdf_submaps"]
        check(described and described[0] >= 30, f"metrics: {described} submaps described")
        # The node optimises and saves as it ends, for longer than roslaunch waits.
        run("rosnode", "kill", NODE)
        check(wait_until(lambda: is_saved(path), 600), "the map is saved as the node ends")
    return path


def is_saved(path):
    """Whether it exists and does not grow any more."""
    if not path.exists():
        return False
    size = path.stat().st_size
    time.sleep(1.)
    return size > 0 and path.stat().st_size == size


def num_inter_constraints(program, path):
    words = run(program, "info", "--input", path).split()
    return int(words[words.index("inter-submap") - 1])


class Listener:
    """What an operator's screen has received."""

    def __init__(self):
        self.poses, self.states, self.tracked = [], [], None
        self.segments = {}
        rospy.Subscriber("/sdf_pose", PoseWithCovarianceStamped, self.poses.append)
        rospy.Subscriber("/diagnostics", DiagnosticArray, self.on_status)
        rospy.Subscriber("/sdf_matches", MarkerArray, self.on_markers)
        rospy.Subscriber("/tracked_pose", PoseStamped, self.on_tracked)

    def on_status(self, message):
        for status in message.status:
            if status.name == f"{NODE}: searcher":
                self.states.append({pair.key: pair.value for pair in status.values}["state"])

    def on_markers(self, message):
        self.segments = {marker.ns: len(marker.points) // 2 for marker in message.markers}

    def on_tracked(self, message):
        self.tracked = message


def yaw_of(rotation):
    return 2. * math.atan2(rotation.z, rotation.w)


class Truth:
    """Poses of the robot that mapped, by seconds since its begin."""

    def __init__(self, poses):
        self.times = [pose.header.stamp.to_sec() for pose in poses]
        self.poses = [pose.pose for pose in poses]

    def error(self, stamp, offset, pose):
        """Returns metres and radians off the pose at that time."""
        now = stamp.to_sec() - offset
        after = next(k for k, at in enumerate(self.times) if at >= now)
        begin, end = self.poses[max(after - 1, 0)], self.poses[after]
        span = self.times[after] - self.times[max(after - 1, 0)]
        part = (now - self.times[after] + span) / span if span > 0. else 0.
        turned = (yaw_of(end.orientation) - yaw_of(begin.orientation)
                  + math.pi) % (2. * math.pi) - math.pi
        yaw = yaw_of(begin.orientation) + part * turned
        position = [getattr(begin.position, axis)
                    + part * (getattr(end.position, axis) - getattr(begin.position, axis))
                    for axis in "xy"]
        meters = math.hypot(pose.position.x - position[0], pose.position.y - position[1])
        radians = (yaw_of(pose.orientation) - yaw + math.pi) % (2. * math.pi) - math.pi
        return meters, abs(radians)


def settle(trajectory_id, clock):
    """Lets the node catch up with a bag that has ended, and publish where it is."""
    end = rospy.Time.now().to_sec()

    def is_behind():
        poses = call("/trajectory_query", TrajectoryQuery, trajectory_id).trajectory
        return not poses or poses[-1].header.stamp.to_sec() < end - 0.5

    check(wait_until(lambda: not is_behind(), 120), "the node keeps up")
    # Timers follow the clock, which stands still when a bag has ended.
    for k in range(1, 11):
        clock.publish(Clock(rospy.Time.from_sec(end + 0.02 * k)))
        time.sleep(0.05)
    time.sleep(0.5)


def check_error(truth, message, pose, offset, what):
    meters, radians = truth.error(message.header.stamp, offset, pose)
    check(meters < MAX_ERROR and radians < MAX_ROTATION,
          f"{what}: {meters:.2f} m and {radians:.3f} rad off")


def check_covariance(pose, error):
    """Of x, y and yaw alone, symmetric, and no smaller than what the pose is off by."""
    rows = [list(pose.covariance[6 * k:6 * k + 6]) for k in range(6)]
    axes = (0, 1, 5)
    deviations = [math.sqrt(rows[k][k]) for k in axes]
    others = [rows[j][k] for j in range(6) for k in range(6) if j not in axes or k not in axes]
    check(all(abs(rows[j][k] - rows[k][j]) < 1e-12 for j in axes for k in axes)
          and not any(others) and 0. < deviations[2] < 0.2
          and 0.03 <= min(deviations[:2]) and max(deviations[:2]) < MAX_ERROR
          and error < 4. * max(deviations[:2]),
          "its deviations are {:.3f} m, {:.3f} m and {:.4f} rad".format(*deviations))


def localize(directory, path, bag):
    second_offset = FIRST_BEGIN + LENGTH + PAUSE - SECOND_BEGIN
    clock = rospy.Publisher("/clock", Clock, queue_size=10)
    shown = draw_foxglove_layout.topics_of(json.loads(FOXGLOVE_LAYOUT.read_text()))
    with launched(directory, "localization", map=path), recorded(
            os.environ.get("ROS_TEST_RECORD"), [*shown, "/tf", "/tf_static"]):
        call("/sdf_locate", Locate, LocateRequest(trajectory_id=-1))
        check(wait_until(lambda: shown <= {name for name, _ in rospy.get_published_topics()}, 30),
              f"all that the layout for Foxglove shows is published: {sorted(shown)}")
        listener = Listener()
        truth = Truth(call("/trajectory_query", TrajectoryQuery, 0).trajectory)
        play(bag, LOCALIZATION_RATE, "-u", LENGTH)
        check(wait_until(lambda: listener.poses, 60), "a pose is published")
        found = listener.poses[0]
        check_error(truth, found, found.pose.pose, 0., "located")
        check_covariance(found.pose, truth.error(found.header.stamp, 0., found.pose.pose)[0])
        answer = call("/sdf_locate", Locate, LocateRequest(trajectory_id=-1))
        check(answer.located and answer.probability > 0.99 and answer.has_start_pose,
              f"the service says the same: after {answer.distance_driven:.1f} m, probability "
              f"{answer.probability:.4f}, runner-up {answer.runner_up_probability:.4f}")
        check(answer.pose.pose.covariance == found.pose.covariance,
              "with the same covariance")
        wait_until(lambda: listener.segments.get("in_graph"), 20)
        check(listener.segments.get("in_graph", 0) > 0, f"matches are shown: {listener.segments}")
        settle(answer.trajectory_id, clock)
        check_error(truth, listener.tracked, listener.tracked.pose, 0., "tracked until then")

        # Carried away.
        lost = call("/sdf_locate", Locate, LocateRequest(
            trajectory_id=answer.trajectory_id, search=True, restart=True))
        check(lost.success and not lost.located
              and lost.trajectory_id == answer.trajectory_id + 1, "a new trajectory is searched for")
        wait_until(lambda: listener.states and listener.states[-1] == "lost", 20)
        num_poses = len(listener.poses)
        play(bag, LOCALIZATION_RATE, "-s", LENGTH + PAUSE / 2.)
        check(wait_until(lambda: len(listener.poses) > num_poses, 60), "it is found again")
        check_error(truth, listener.poses[num_poses], listener.poses[num_poses].pose.pose,
                    second_offset, "found again")
        states = call("/get_trajectory_states", GetTrajectoryStates).trajectory_states
        state = dict(zip(states.trajectory_id, states.trajectory_state))
        # With a trimmer of pure localisation, nothing is left of what ended.
        check(state == {0: FROZEN, answer.trajectory_id: DELETED,
                        answer.trajectory_id + 1: ACTIVE},
              f"the next trajectory goes on: {state}")
        settle(answer.trajectory_id + 1, clock)
        check_error(truth, listener.tracked, listener.tracked.pose, second_offset,
                    "tracked from then")
        wait_until(lambda: listener.states[-1] == "located", 20)
        check(set(listener.states) == {"searching", "located", "lost"}
              and listener.states[-1] == "located",
              f"states shown: {sorted(set(listener.states))}, the last {listener.states[-1]}")
        check(call("/sdf_localize", Trigger).success, "the trigger searches again")


def write_assets(directory, program, path, bag):
    """The pictures by Cartographer's own tools of a map that was corrected."""
    closed = directory / "closed.pbstream"
    run(program, "close_loops", "--input", path, "--output", closed)
    tools = os.environ["CARTOGRAPHER_ROS_PREFIX"] + "/lib/cartographer_ros/"
    run(tools + "cartographer_pbstream_to_ros_map", "-pbstream_filename", closed,
        "-map_filestem", directory / "grids", "-resolution", "0.05",
        log=directory / "grids.log")
    run(tools + "cartographer_assets_writer", "-configuration_directory",
        HERE.parent / "ros/cartographer_sdf_ros/configuration_files",
        "-configuration_basename", "robot_assets_writer.lua", "-bag_filenames", bag,
        "-pose_graph_filename", closed, "-output_file_prefix", directory / "assets_",
        log=directory / "assets.log")
    walls = read_walls(directory / "grids")
    written = read_walls(directory / "assets_map")
    near = {(x + dx, y + dy) for x, y in walls for dx in range(-2, 3) for dy in range(-2, 3)}
    fraction = len(written & near) / max(len(written), 1)
    covered = {(x + dx, y + dy) for x, y in written for dx in range(-2, 3)
               for dy in range(-2, 3)}
    recall = len(walls & covered) / max(len(walls), 1)
    check(fraction > 0.9 and recall > 0.8,
          f"{fraction:.3f} of the walls of cartographer_assets_writer are the corrected map's, "
          f"{recall:.3f} of those are there")


def read_walls(stem):
    """Cells of 0.1 m that are dark in a map of ROS: STEM.pgm and STEM.yaml."""
    lines = (stem.parent / (stem.name + ".yaml")).read_text().splitlines()
    values = dict(line.split(": ", 1) for line in lines if ": " in line)
    resolution = float(values["resolution"])
    origin = [float(word) for word in values["origin"].strip("[]").split(",")]
    data = (stem.parent / (stem.name + ".pgm")).read_bytes()
    header, position = [], 0
    while len(header) < 4:
        end = data.index(b"\n", position)
        line = data[position:end]
        header += [] if line.startswith(b"#") else line.split()
        position = end + 1
    width, height = int(header[1]), int(header[2])
    pixels = data[position:position + width * height]
    cells = set()
    for k, value in enumerate(pixels):
        if value < 100:
            x = origin[0] + resolution * (k % width + 0.5)
            y = origin[1] + resolution * (height - k // width - 0.5)
            cells.add((math.floor(x / 0.1), math.floor(y / 0.1)))
    return cells


def main():
    log, program, directory = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    mapping_bag, localization_bag = directory / "mapping.bag", directory / "localization.bag"
    run("/usr/bin/python3", HERE / "make_bag.py", log, mapping_bag)
    second_offset = FIRST_BEGIN + LENGTH + PAUSE - SECOND_BEGIN
    run("/usr/bin/python3", HERE / "make_bag.py", log, localization_bag,
        "--piece", f"{FIRST_BEGIN}:{LENGTH}", "--piece",
        f"{SECOND_BEGIN}:{LENGTH}:{second_offset}")
    with subprocess.Popen(["roscore"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL) as master:
        try:
            check(wait_until(rosgraph.is_master_online, 30), "a master runs")
            rospy.set_param("/use_sim_time", True)
            rospy.init_node("ros_drive_test", disable_signals=True)
            path = map_building(directory, mapping_bag)
            count = num_inter_constraints(program, path)
            check(count >= MIN_INTER_CONSTRAINTS, f"{count} inter-submap constraints in the map")
            localize(directory, path, localization_bag)
        finally:
            master.send_signal(signal.SIGINT)
    write_assets(directory, program, path, mapping_bag)


if __name__ == "__main__":
    main()
