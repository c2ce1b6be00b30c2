#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Measures the searcher beside a live Cartographer, side by side with stock.

usage: measure_live.py mapping RESULT.json [LOG ...]
       measure_live.py localization RESULT.json [--starts N] [--seconds S] [--factor F]
                                    [--drive NAME] [--map NAME] [--closed 1]
       measure_live.py report RESULT.json [RESULT.json ...]

mapping drives whole recordings (default: intel aces mit_killian) through
Cartographer alone, with the searcher in place of its loop search, and with
both. localization drives pieces of a recording (willow_2) through a frozen map
(willow_1), with the searcher, with scans compared with the map in addition, and
with Cartographer's own global search: N pieces (20) of S seconds (60) at F times
real time (1). Of another building than the map's, every answer is wrong. With
--closed 1, the loops of the map are closed first. Both append to RESULT.json what
they measured; report prints it as Markdown.

Environment: BUILD_DIR (default: build beside scripts/), DATA_DIR (default:
../shared/data), HOST_CONFIGURATION (a directory for Cartographer's own Lua files,
default: where it is installed), WORK_DIR (default: a temporary one), VARIANTS
(some of them only, separated by commas).
"""

import bisect
import csv
import json
import math
import os
import pathlib
import shutil
import statistics
import struct
import subprocess
import sys
import tempfile
import zlib

from measuring import compose, inverse

SOURCE = pathlib.Path(__file__).resolve().parent.parent
BUILD = pathlib.Path(os.environ.get("BUILD_DIR", SOURCE / "build"))
DATA = pathlib.Path(os.environ.get("DATA_DIR", SOURCE / ".." / "shared" / "data"))

# name: (Cartographer's file, the searcher's file)
MAPPING = {
    "open loop": ("cartographer_mapping_searcher_only.lua", ""),
    "stock": ("cartographer_mapping.lua", ""),
    "searcher": ("cartographer_mapping_searcher_only.lua", "sdf_live.lua"),
    "both": ("cartographer_mapping.lua", "sdf_live.lua"),
}
# Cartographer's own global search, and its own defaults around it; with the searcher it is off.
STOCK_LOCALIZATION = """include "cartographer_localization.lua"
local builder = POSE_GRAPH.constraint_builder
builder.max_constraint_distance = 15.
builder.sampling_ratio = 0.3
builder.fast_correlative_scan_matcher.linear_search_window = 7.
builder.fast_correlative_scan_matcher.angular_search_window = math.rad(30.)
builder.fast_correlative_scan_matcher.branch_and_bound_depth = 7
POSE_GRAPH.global_sampling_ratio = {ratio}
POSE_GRAPH.global_constraint_search_after_n_seconds = 10.
return options
"""
COMPARED_SCANS = """include "sdf_live.lua"
SDF_LIVE.localization.compare_scans = {value}
return SDF_LIVE
"""
LOCALIZATION = {"searcher": None, "searcher and scans": None, "stock 0.003": "0.003",
                "stock 1.0": "1."}
RIGHT_M, WRONG_M, RIGHT_DEGREES = 0.5, 1.0, 10.0
# From year 1 to 1970, in seconds: the host's time and ours.
EPOCH = 719162 * 24 * 3600


def run_log(work, **flags):
    """Runs the program; its run.json and nodes.csv."""
    report = work / "report"
    directories = [str(work)]
    if "HOST_CONFIGURATION" in os.environ:
        directories.append(os.environ["HOST_CONFIGURATION"])
    command = [str(BUILD / "cartographer_sdf_run_log"), f"--report={report}",
               f"--configuration_directories={','.join(directories)}"]
    command += [f"--{name}={value}" for name, value in flags.items()]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    with open(report / "nodes.csv", encoding="utf-8") as file:
        nodes = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(file)]
    return json.loads((report / "run.json").read_text()), nodes


def evaluate(work, name):
    """What evaluate says of the map, by the hand-verified relations and the truth.

    The truth knows nodes by their index in NAME_open_loop.pbstream; here they are found by
    their time, as another scan may be kept now and then.
    """
    _, known_times = read_pose_graph(DATA / f"{name}_open_loop.pbstream")
    known = {round(known_times[i], 3): pose
             for i, pose in read_truth(DATA / f"{name}.truth.csv", "node").items()
             if i in known_times}
    _, times = read_pose_graph(work / "map.pbstream")
    truth = work / "truth.csv"
    with open(truth, "w", encoding="utf-8") as file:
        file.write("kind,trajectory,index,x,y,yaw\n")
        for i, time in times.items():
            if round(time, 3) in known:
                file.write("node,0,%d,%.6f,%.6f,%.6f\n" % (i, *known[round(time, 3)]))
    command = [str(BUILD / "cartographer_sdf"), "evaluate", "--input", str(work / "map.pbstream"),
               "--truth", str(truth)]
    if (DATA / f"{name}.relations").exists():
        command += ["--relations", str(DATA / f"{name}.relations")]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def measure_mapping(results, names):
    """One row for each recording and variant."""
    for name in names:
        for variant, (host, searcher) in chosen(MAPPING).items():
            with tempfile.TemporaryDirectory(dir=os.environ.get("WORK_DIR")) as directory:
                work = pathlib.Path(directory)
                run, _ = run_log(work, log=DATA / f"{name}.log.gz", configuration_basename=host,
                                 sdf_configuration_basename=searcher,
                                 output=work / "map.pbstream")
                run["errors"] = evaluate(work, name)
            run.update(kind="mapping", name=name, variant=variant)
            del run["closures"]
            results.append(run)
            yield


# --- What a .pbstream says of poses, on the standard library alone. ----------
def varint(data, i):
    """(value, next index)"""
    value = shift = 0
    while True:
        value |= (data[i] & 127) << shift
        shift += 7
        i += 1
        if data[i - 1] < 128:
            return value, i


def message(data):
    """Field number -> values of an encoded protocol buffer."""
    fields, i = {}, 0
    while i < len(data):
        key, i = varint(data, i)
        if key & 7 == 0:
            value, i = varint(data, i)
        elif key & 7 == 1:
            value, i = struct.unpack_from("<d", data, i)[0], i + 8
        elif key & 7 == 5:
            value, i = struct.unpack_from("<f", data, i)[0], i + 4
        else:
            size, i = varint(data, i)
            value, i = data[i:i + size], i + size
        fields.setdefault(key >> 3, []).append(value)
    return fields


def planar_pose(data):
    """(x, y, yaw) of a Rigid3d."""
    pose = message(data)
    t, q = (message(pose.get(k, [b""])[0]) for k in (1, 2))
    x, y, z, w = (q.get(k, [0.0])[0] for k in (1, 2, 3, 4))
    return (t.get(1, [0.0])[0], t.get(2, [0.0])[0],
            math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))


def read_pose_graph(path):
    """Submap poses by index and times of nodes [s], of trajectory 0."""
    with open(path, "rb") as file:
        file.read(8)
        for _ in range(2):
            record = zlib.decompress(file.read(struct.unpack("<Q", file.read(8))[0]), 31)
    trajectory = message(message(message(record)[1][0])[4][0])
    submaps = [message(s) for s in trajectory[2]]
    nodes = [message(n) for n in trajectory[1]]
    return ({s.get(2, [0])[0]: planar_pose(s[1][0]) for s in submaps},
            {n.get(7, [0])[0]: n[1][0] * 1e-7 - EPOCH for n in nodes})


def read_truth(path, kind):
    """index -> (x, y, yaw) of trajectory 0."""
    with open(path, encoding="utf-8") as file:
        return {int(row["index"]): tuple(float(row[k]) for k in ("x", "y", "yaw"))
                for row in csv.DictReader(file)
                if row["kind"] == kind and row["trajectory"] == "0"}


class OtherBuilding:
    """The truth of a robot that is not in the map."""

    def __init__(self, drive):
        _, times = read_pose_graph(map_of(drive))
        self.times = sorted(times.values())

    def in_map(self, time):
        """Nowhere."""
        return (math.inf, math.inf, 0.0)

    def error(self, node):
        """As Truth.error."""
        return (math.inf, 0.0)


def map_of(name):
    """Its map by Cartographer, or, where there is none, that without loops."""
    path = DATA / f"{name}.pbstream"
    return path if path.exists() else DATA / f"{name}_open_loop.pbstream"


class Truth:
    """Where the robot of a drive really was in a map of the same building."""

    def __init__(self, drive, map_name, map_path):
        submaps, _ = read_pose_graph(map_path)
        world = read_truth(DATA / f"{map_name}.truth.csv", "submap")
        self.submaps = [(world[i], pose) for i, pose in submaps.items() if i in world]
        _, times = read_pose_graph(map_of(drive))
        nodes = read_truth(DATA / f"{drive}.truth.csv", "node")
        self.nodes = sorted((times[i], pose) for i, pose in nodes.items() if i in times)
        self.times = [time for time, _ in self.nodes]

    def in_map(self, time):
        """T_map_tracking, by the nearest submap of the map, which bends."""
        k = min(max(bisect.bisect_left(self.times, time), 1), len(self.nodes) - 1)
        (t0, a), (t1, b) = self.nodes[k - 1], self.nodes[k]
        f = min(max((time - t0) / (t1 - t0), 0.0), 1.0)
        turn = math.remainder(b[2] - a[2], 2 * math.pi)
        pose = (a[0] + f * (b[0] - a[0]), a[1] + f * (b[1] - a[1]), a[2] + f * turn)
        world, in_map = min(self.submaps,
                            key=lambda s: math.hypot(s[0][0] - pose[0], s[0][1] - pose[1]))
        return compose(in_map, compose(inverse(world), pose))

    def error(self, node):
        """(metres, degrees) of what was believed when a node was made."""
        truth = self.in_map(node["time"])
        return (math.hypot(node["x"] - truth[0], node["y"] - truth[1]),
                abs(math.degrees(math.remainder(node["yaw"] - truth[2], 2 * math.pi))))


def judge(truth, run, nodes):
    """What became of one drive. Its last pose counts, and what the searcher said."""
    errors = [truth.error(node) for node in nodes]
    is_right = [meters < RIGHT_M and degrees < RIGHT_DEGREES for meters, degrees in errors]
    said = [math.hypot(answer["T_map_tracking"]["x"] - truth.in_map(answer["time"])[0],
                       answer["T_map_tracking"]["y"] - truth.in_map(answer["time"])[1])
            for answer in run["localizations"] if answer["localized"]]
    first = next((i for i, node in enumerate(nodes) if node["connected"]), None)
    if first is None:
        return {"verdict": "not localised", "said_error_m": said}
    # From where on it stays right.
    settled = len(nodes)
    while settled > first and is_right[settled - 1]:
        settled -= 1
    is_wrong = (errors[-1][0] > WRONG_M or errors[-1][1] > RIGHT_DEGREES
                or any(meters > WRONG_M for meters in said))
    row = {
        "verdict": "wrong" if is_wrong else "right" if is_right[-1] else "near",
        "said_error_m": said,
        "last_error_m": errors[-1][0], "last_error_degrees": errors[-1][1],
    }
    for name, i in (("connected", first), ("settled", settled)):
        if i < len(nodes):
            row[name] = {"meters": nodes[i]["distance"],
                         "seconds": nodes[i]["time"] - nodes[0]["time"],
                         "cpu_seconds": nodes[i]["cpu_seconds"]}
    return row


def measure_localization(results, num_starts, seconds, factor, drive, map_name, is_closed):
    """One row for each start and variant."""
    # A copy, as the searcher leaves a file of places beside the map.
    copy = tempfile.TemporaryDirectory(dir=os.environ.get("WORK_DIR"))
    frozen_map = os.path.join(copy.name, "map.pbstream")
    if is_closed:
        subprocess.run([str(BUILD / "cartographer_sdf"), "close_loops", str(map_of(map_name)),
                        "-o", frozen_map], check=True, stdout=subprocess.DEVNULL)
    else:
        shutil.copy(map_of(map_name), frozen_map)
    is_same = drive.split("_")[0] == map_name.split("_")[0]
    truth = Truth(drive, map_name, frozen_map) if is_same else OtherBuilding(drive)
    length = truth.times[-1] - truth.times[0] - seconds
    for k in range(num_starts):
        start = round(length * k / max(1, num_starts - 1), 1)
        for variant, ratio in chosen(LOCALIZATION).items():
            with tempfile.TemporaryDirectory(dir=os.environ.get("WORK_DIR")) as directory:
                work = pathlib.Path(directory)
                host, searcher = "cartographer_localization.lua", ""
                if ratio is None:
                    searcher = "measured_live.lua"
                    (work / searcher).write_text(COMPARED_SCANS.format(
                        value=str(variant != "searcher").lower()))
                else:
                    host = "stock_localization.lua"
                    (work / host).write_text(STOCK_LOCALIZATION.format(ratio=ratio))
                run, nodes = run_log(
                    work, log=DATA / f"{drive}.log.gz", map=frozen_map,
                    configuration_basename=host, start=start, duration=seconds,
                    sdf_configuration_basename=searcher,
                    real_time_factor=factor)
            row = {"kind": "localization", "variant": variant, "start": start, "factor": factor,
                   "drive": drive, "map": map_name, "closed": is_closed,
                   "max_delay_seconds": run["max_delay_seconds"],
                   "localizations": run["localizations"], "all_cpu_seconds": run["cpu_seconds"]}
            row.update(judge(truth, run, nodes))
            results.append(row)
            yield
    copy.cleanup()


# --- Markdown. ---------------------------------------------------------------
def report_mapping(rows):
    """A table for each recording."""
    for name in dict.fromkeys(row["name"] for row in rows):
        print(f"\n### {name}\n\n| | wall [s] | CPU [s] | of it the searcher [s] | injected |"
              " AddSensorData, mean / p99 [ms] | added by the searcher, mean / p99 [ms] |"
              "\n| --- | --- | --- | --- | --- | --- | --- |")
        mine = [row for row in rows if row["name"] == name]
        for row in mine:
            searcher = row["searcher"]
            worker = injected = added = "-"
            if searcher:
                worker = f"{searcher['worker_cpu_seconds']:.1f}"
                injected = f"{searcher['injected']} of {searcher['closures']}"
                call = searcher["callback_milliseconds"]
                added = f"{call['mean']:.4f} / {call['p99']:.4f}"
            call_all = row["add_sensor_data_milliseconds"]
            print(f"| {row['variant']} | {row['wall_seconds'] + row['final_wall_seconds']:.0f} |"
                  f" {row['cpu_seconds'] + row['final_cpu_seconds']:.1f} | {worker} | {injected} |"
                  f" {call_all['mean']:.2f} / {call_all['p99']:.2f} | {added} |")
        for row in mine:
            print(f"\n{row['variant']}:\n\n```\n{row['errors'].rstrip()}\n```")


def quantiles(values, digits=1):
    """Median and worst, as text."""
    if not values:
        return "-"
    return f"{statistics.median(values):.{digits}f} / {max(values):.{digits}f}"


def report_localization(rows):
    """One row for each variant."""
    print("\n| | starts | right | near | wrong | not localised | until the first constraint:"
          " [m] | [s] | CPU [s] | until the pose is right: [m] | [s] | last error [m] |"
          "\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    def name_of(row):
        drive, map_name = row.get("drive", "willow_2"), row.get("map", "willow_1")
        closed = "closed " if row.get("closed") else ""
        return f"{drive} in {closed}{map_name}, {row['variant']}"

    for variant in dict.fromkeys(map(name_of, rows)):
        mine = [row for row in rows if name_of(row) == variant]
        cells = [len(mine)] + [sum(row["verdict"] == verdict for row in mine)
                               for verdict in ("right", "near", "wrong", "not localised")]
        for moment, keys in (("connected", ("meters", "seconds", "cpu_seconds")),
                             ("settled", ("meters", "seconds"))):
            cells += [quantiles([row[moment][key] for row in mine if moment in row])
                      for key in keys]
        cells.append(quantiles([row["last_error_m"] for row in mine if "last_error_m" in row], 2))
        print(f"| {variant} | {' | '.join(map(str, cells))} |")


def chosen(variants):
    """Those that the environment asks for."""
    names = os.environ.get("VARIANTS", ",".join(variants)).split(",")
    return {name: value for name, value in variants.items() if name in names}


def option(arguments, name, default):
    """Takes `name VALUE` from the arguments."""
    if name not in arguments:
        return default
    i = arguments.index(name)
    value = type(default)(arguments[i + 1])
    del arguments[i:i + 2]
    return value


def main():
    """See the top."""
    arguments = sys.argv[1:]
    if len(arguments) < 2 or arguments[0] not in ("mapping", "localization", "report"):
        print(__doc__, file=sys.stderr)
        return 2
    if arguments[0] == "report":
        rows = [row for path in arguments[1:]
                for row in json.loads(pathlib.Path(path).read_text())]
        for kind, function in (("mapping", report_mapping), ("localization", report_localization)):
            mine = [row for row in rows if row["kind"] == kind]
            if mine:
                function(mine)
        return 0
    num_starts = option(arguments, "--starts", 20)
    drive = option(arguments, "--drive", "willow_2")
    map_name = option(arguments, "--map", "willow_1")
    is_closed = option(arguments, "--closed", 0) > 0
    seconds = option(arguments, "--seconds", 60.0)
    factor = option(arguments, "--factor", 1.0)
    path = pathlib.Path(arguments[1])
    results = json.loads(path.read_text()) if path.exists() else []
    steps = (measure_mapping(results, arguments[2:] or ["intel", "aces", "mit_killian"])
             if arguments[0] == "mapping"
             else measure_localization(results, num_starts, seconds, factor, drive, map_name,
                                       is_closed))
    for _ in steps:
        # After each, as they take long.
        path.write_text(json.dumps(results, indent=1))
        row = results[-1]
        print({k: row[k] for k in ("name", "variant", "start", "verdict", "connected",
                                   "settled", "last_error_m", "said_error_m", "errors")
               if k in row}, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
