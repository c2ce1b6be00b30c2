#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the experiments of the paper (Millane et al. 2019) on maps with truth.

Maps are NAME=MAP.pbstream,TRUTH.csv[,RELATIONS], or, without any, all of --data:
NAME.truth.csv beside NAME_open_loop.pbstream or NAME.pbstream, and
NAME.relations where there are some. Writes evaluation.md and, in a directory of
that name, all tables and curves (CSV), plots (SVG), pictures (PNG), options in
force (Lua) and the commands. The page shows the pictures of SHOWN, which the
repository keeps; git ignores the rest.
"""

import argparse
import contextlib
import csv
import datetime
import hashlib
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile
import typing

import make_figures
from measuring import (DATA_DIR, PROGRAM, SOURCE_DIR, Failure, check_program,
                       commit_name, processor, read_csv)

METHODS = ("sdf", "paper", "shape_context")
CLEARANCES = (2., 1.5, 1., 0.5)
OVERLAPS = (0.5, 0.1, 0.2, 0.3, 0.4, 0.6, 0.7)
# Pictures on the page; .gitignore lists them, too.
SHOWN = ("intel.random_pairs.svg", "mit_killian.random_pairs.svg",
         "intel.free_space.svg", "mit_killian.free_space.svg",
         "willow_1.keypoints.png", "willow_1.feature_window.png",
         "willow_1.feature_histogram.svg")
# Table I of the paper, and what it leaves open: names in the options.
PARAMETERS = {
    "paper": [
        ("radius [m]", "loop_closing.place.descriptor.radius_meters"),
        ("number of bins", "loop_closing.place.descriptor.num_bins"),
        ("distance weight", "loop_closing.place.descriptor.distance_weight"),
        ("detection threshold",
         "loop_closing.place.keypoint.detection_threshold"),
        ("matching max ratio", "loop_closing.recognition.match.correspondence.max_ratio"),
        ("smoothing [cells] (open in the paper)",
         "loop_closing.place.keypoint.smoothing_sigma_cells"),
        ("RANSAC inlier distance [m] (open)",
         "loop_closing.recognition.match.ransac.inlier_distance_meters"),
        ("inliers of an accepted match (open)",
         "loop_closing.recognition.match.min_num_inliers"),
    ],
    "shape_context": [
        ("radius [m]", "shape_context.descriptor.radius_meters"),
        ("number of radial bins", "shape_context.descriptor.num_radial_bins"),
        ("number of angular bins", "shape_context.descriptor.num_angular_bins"),
        ("detection threshold", "shape_context.keypoint.detection_threshold"),
        ("matching max ratio", "loop_closing.recognition.match.correspondence.max_ratio"),
        ("scans of a submap", "shape_context.cloud.max_num_scans"),
        ("points in one square [m] (open)",
         "shape_context.cloud.voxel_size_meters"),
        ("scatter radius [m] (open)",
         "shape_context.keypoint.scatter_radius_meters"),
        ("cluster radius [m] (open)",
         "shape_context.keypoint.cluster_radius_meters"),
        ("orientation radius [m] (open)",
         "shape_context.descriptor.orientation_radius_meters"),
    ],
}


class Map(typing.NamedTuple):
    name: str
    path: pathlib.Path
    truth: pathlib.Path
    relations: typing.Optional[pathlib.Path]
    # The same drive with the host's own loop closing, to compare with.
    stock: typing.Optional[pathlib.Path] = None


def discover(data):
    maps = []
    for truth in sorted(data.glob("*.truth.csv")):
        name = truth.name.removesuffix(".truth.csv")
        candidates = [data / f"{name}_open_loop.pbstream",
                      data / f"{name}.pbstream"]
        path = next((c for c in candidates if c.exists()), None)
        if path is None:
            continue
        relations = data / f"{name}.relations"
        stock = data / f"{name}_stock.pbstream"
        maps.append(Map(name, path, truth,
                        relations if relations.exists() else None,
                        stock if stock.exists() else None))
    return maps


def parse_map(text):
    name, equals, files = text.partition("=")
    paths = [pathlib.Path(p) for p in files.split(",")]
    if not equals or not name or len(paths) not in (2, 3):
        raise Failure(f"a map is NAME=MAP.pbstream,TRUTH.csv[,RELATIONS], not {text}")
    for path in paths:
        if not path.exists():
            raise Failure(f"there is no {path}")
    return Map(name, paths[0], paths[1], paths[2] if len(paths) == 3 else None)


class Runner:
    """Runs the program, and remembers how, for the report."""

    def __init__(self, program, work, directory, threads):
        self.program = work / "program"
        shutil.copy2(program, self.program)
        self.work = work
        self.directory = directory
        self.threads = threads
        self.commands = []
        self.written = set()
        # A long run does not mind that options are worked on.
        self.configuration = work / "configuration"
        shutil.copytree(SOURCE_DIR / "configuration_files", self.configuration,
                        dirs_exist_ok=True)

    def run(self, *arguments):
        words = [os.path.abspath(a) if isinstance(a, pathlib.Path) else str(a)
                 for a in arguments]
        subcommand = words[0]
        shown = [self.short(w) for w in words]
        self.commands.append(shlex.join(["cartographer_sdf", *shown]))
        print(self.commands[-1], file=sys.stderr, flush=True)
        if subcommand in ("match", "figures", "close_loops") or (
                "--random_pairs" in words):
            words += ["--configuration_directory", str(self.configuration)]
            if subcommand != "figures":
                words += ["--threads", str(self.threads)]
        # What was done before with the same program, files and options, and
        # kept by --work, is not done again.
        mark = self.work / f"{self.key(words)}.done"
        if mark.exists():
            return
        result = subprocess.run([self.program, *words], capture_output=True,
                                text=True, check=False)
        if result.returncode != 0:
            raise Failure(result.stderr.strip() or f"{subcommand} failed")
        mark.touch()

    def key(self, words):
        digest = hashlib.sha256(self.program.read_bytes())
        for path in sorted(self.configuration.glob("*.lua")):
            digest.update(path.read_bytes())
        for word in words:
            digest.update(b"\0" + word.encode())
            path = pathlib.Path(word)
            # Maps and tables change with their size or time.
            if path.suffix in (".pbstream", ".csv") and path.is_file() and (
                    self.directory not in path.parents
                    and self.work not in path.parents):
                status = path.stat()
                digest.update(f"{status.st_size} {status.st_mtime_ns}".encode())
        return digest.hexdigest()[:24]

    def short(self, word):
        """Paths are nobody's business but their names."""
        if "," in word and "/" in word:
            return ",".join(map(self.short, word.split(",")))
        path = pathlib.Path(word)
        return path.name if path.is_absolute() or word.startswith("..") else word

    def numbers(self, path):
        """{subject: {quantity: value}} of an evaluate --csv."""
        subjects = {}
        for row in read_csv(path):
            subjects.setdefault(row["subject"], {})[row["quantity"]] = float(
                row["value"])
        return subjects


def show(number, digits=2):
    if number is None:
        return "-"
    return f"{number:.0f}" if digits == 0 else f"{number:.{digits}f}"


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "| --- " * len(header) + "|"]
    lines += ["| " + " | ".join(map(str, row)) + " |" for row in rows]
    return lines + [""]


def write_table(path, header, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)


# --- The experiments. ---------------------------------------------------------

def random_pairs(runner, evaluated, arguments):
    """Sec. V-A and V-B on one map."""
    results = {}
    pairs = arguments.pairs_by_map.get(evaluated.name, arguments.pairs)
    experiments = [("random_pairs", pairs, ["--methods",
                                                      ",".join(METHODS),
                    "--max_clearances", ",".join(f"{c:g}" for c in CLEARANCES)])]
    if arguments.neighbours:
        experiments.append(("neighbours", pairs, [
            "--methods", "paper,shape_context", "--min_index_gap", 1]))
    for experiment, num_pairs, flags in experiments:
        base = runner.directory / f"{evaluated.name}.{experiment}"
        flags += ["--min_overlaps", ",".join(f"{o:g}" for o in OVERLAPS)]
        if experiment != "neighbours":
            flags += ["--plot", f"{base}.svg", "--free_space_plot",
                      runner.directory / f"{evaluated.name}.free_space.svg",
                      "--curves", f"{base}.curves.csv"]
        runner.run("evaluate", "--input", evaluated.path, "--truth",
                   evaluated.truth, "--random_pairs", num_pairs, "--pair_seed",
                   arguments.seed, *flags, "--csv", f"{base}.csv")
        results[experiment] = runner.numbers(f"{base}.csv")
    return results


def all_pairs(runner, name, reference, query=None):
    """The strict protocol, and what was recognised: of one map, or of one
    session in the map of another."""
    base = runner.directory / name
    files, labels = [], {}
    inputs = ["--input", reference.path]
    truths = ["--truth", reference.truth]
    if query:
        inputs += ["--query", query.path]
        truths += ["--query_truth", query.truth]
    for method in METHODS:
        file = runner.work / name / f"{method}.csv"
        file.parent.mkdir(exist_ok=True)
        options = runner.directory / f"{method}.options.lua"
        runner.run("match", *inputs, "--method", method, "--all_pairs",
                   "--output", file,
                   *([] if options in runner.written else
                     ["--options_in_force", options]))
        runner.written.add(options)
        labels[method] = runner.work / f"{name}.{method}.labels.csv"
        files.append(file)
    runner.run("evaluate", *inputs, *truths, "--matches",
               ",".join(map(str, files)), "--labels",
               ",".join(map(str, labels.values())), "--csv",
               f"{base}.all_pairs.csv",
               "--curves", f"{base}.all_pairs.curves.csv", "--plot",
               f"{base}.all_pairs.svg")
    return {"numbers": runner.numbers(f"{base}.all_pairs.csv"),
            "labels": labels, "matches": dict(zip(METHODS, files))}


def relations(runner, evaluated):
    """Sec. of the issue: before and after close_loops."""
    closed = runner.work / f"{evaluated.name}.closed.pbstream"
    runner.run("close_loops", "--input", evaluated.path, "--output", closed)
    flags = ["--truth", evaluated.truth]
    if evaluated.relations:
        flags += ["--relations", evaluated.relations]
    results = {}
    stages = [("before", evaluated.path), ("after close_loops", closed)]
    if evaluated.stock:
        stages.append(("stock loop closing", evaluated.stock))
    for stage, path in stages:
        file = runner.work / f"{evaluated.name}.{path.stem}.relations.csv"
        runner.run("evaluate", "--input", path, *flags, "--csv", file)
        results[stage] = runner.numbers(file)
    return results


# --- The report. --------------------------------------------------------------

def pictures(directory, names_and_captions):
    """Lines of Markdown for those that the page shows."""
    lines = []
    for name, caption in names_and_captions:
        if name in SHOWN:
            lines += [f"![{caption}]({directory.name}/{name})", ""]
    return lines


def option_values(options):
    """{dotted name: text} of the Lua that FormatOptions writes."""
    values, path = {}, []
    for line in options.splitlines():
        key, equals, value = (part.strip() for part in line.partition("="))
        if line.strip().startswith("}"):
            if path:
                path.pop()
        elif equals and value.startswith("{"):
            path.append(key)
            if value.rstrip(",").endswith("}"):
                path.pop()
        elif equals:
            values[".".join([*path[1:], key])] = value.rstrip(",")
    return values


def parameter_table(runner):
    columns = {}
    for method in PARAMETERS:
        values = option_values((runner.directory / f"{method}.options.lua")
                               .read_text(encoding="utf-8"))
        columns[method] = [(name, values.get(key, "?"))
                           for name, key in PARAMETERS[method]]
    height = max(map(len, columns.values()))
    rows = []
    for k in range(height):
        row = []
        for method in PARAMETERS:
            row += columns[method][k] if k < len(columns[method]) else ("", "")
        rows.append(row)
    return table(["paper", "value", "shape_context", "value"], rows)


def section_random_pairs(runner, maps, results, arguments):
    lines = [
        "## Descriptor performance: random pairs", "",
        "Protocol of Sec. V-A of the paper: as many random pairs as the table says "
        f"(the paper has 1000), seed {arguments.seed}, the query turned by a "
        "random angle before its features are extracted (grids by nearest "
        "sampling, point clouds exactly). *Recall* is at precision 1 over the "
        f"threshold of the score; a pair is a match from an overlap of "
        f"{OVERLAPS[0]:g} on, whatever the pose of the answer. *With pose*: the "
        "answer must also be within 0.5 m and 10 degrees. Submaps of one "
        "trajectory are at least 3 apart.", ""]
    header = ["map", "pairs", "matches"]
    for method in METHODS:
        header += [method, f"{method}, with pose"]
    rows, csv_rows = [], []
    for evaluated in maps:
        numbers = results[evaluated.name]["random_pairs"]
        first = numbers[f"{METHODS[0]} overlap>={OVERLAPS[0]:g}"]
        row = [evaluated.name, show(first["pairs"], 0),
               show(first["positives"], 0)]
        for method in METHODS:
            values = numbers[f"{method} overlap>={OVERLAPS[0]:g}"]
            row += [show(values.get("recall_p1")),
                    show(values.get("recall_p1_pose"))]
        rows.append(row)
    lines += table(header, rows)
    write_table(runner.directory / "random_pairs.csv", header, rows)
    lines += pictures(runner.directory, [
        (f"{m.name}.random_pairs.svg", f"Precision and recall on {m.name}")
        for m in maps])
    lines += [
        "### How this depends on the overlap that makes a match", "",
        "The paper calls pairs \"with a sufficient proportion of overlapping "
        "observed voxels\" matches and does not say how much is sufficient. "
        "Recall at precision 1 (matches in parentheses); overlap is the common "
        "area as a fraction of the smaller submap's.", ""]
    header = ["map", "method", *(f"{o:g}" for o in sorted(OVERLAPS))]
    rows = []
    for evaluated in maps:
        numbers = results[evaluated.name]["random_pairs"]
        for method in METHODS:
            row = [evaluated.name, method]
            for overlap in sorted(OVERLAPS):
                values = numbers[f"{method} overlap>={overlap:g}"]
                row.append(f"{show(values.get('recall_p1'))} "
                           f"({values['positives']:.0f})")
            rows.append(row)
    lines += table(header, rows)
    write_table(runner.directory / "overlap_dependence.csv", header, rows)
    if not all("neighbours" in results[m.name] for m in maps):
        return lines
    lines += [
        "It does not say either whether submaps that share scans are among the "
        "pairs. With them, that is, with all pairs of a map:", ""]
    header = ["map", "matches", "paper", "shape_context"]
    rows = []
    for evaluated in maps:
        numbers = results[evaluated.name]["neighbours"]
        values = [numbers[f"{m} overlap>={OVERLAPS[0]:g}"]
                  for m in ("paper", "shape_context")]
        rows.append([evaluated.name, show(values[0]["positives"], 0),
                     *(show(v.get("recall_p1")) for v in values)])
    return lines + table(header, rows)


def section_free_space(runner, maps, results):
    names = ["paper", *(f"paper {c:g} m" for c in CLEARANCES), "shape_context"]
    lines = [
        "## Importance of free space", "",
        "The same pairs and judgement; the paper's features farther from a wall "
        "than a distance are taken out (Sec. V-B).", ""]
    rows = []
    for evaluated in maps:
        numbers = results[evaluated.name]["random_pairs"]
        rows.append([evaluated.name, *(
            show(numbers[f"{n} overlap>={OVERLAPS[0]:g}"].get("recall_p1"))
            for n in names)])
    lines += table(["recall at precision 1", *names], rows)
    write_table(runner.directory / "free_space.csv", ["map", *names], rows)
    rows = []
    for evaluated in maps:
        numbers = results[evaluated.name]["random_pairs"]
        rows.append([evaluated.name, *(
            show(numbers[f"{n} overlap>={OVERLAPS[0]:g}"].get("ap"))
            for n in names)])
    lines += table(["average precision", *names], rows)
    return lines + pictures(runner.directory, [
        (f"{m.name}.free_space.svg", f"Free space on {m.name}") for m in maps])


def match_rows(name, numbers):
    rows = []
    for method in METHODS:
        values = numbers[f"matches {method}"]
        rows.append([name, method, show(values["pairs"], 0),
                     show(values["positives"], 0), show(values["recall_p1"], 3),
                     show(values.get("recall_p1_ties"), 3),
                     show(values["recall_p99"], 3), show(values["ap"], 3),
                     show(values.get("threshold"), 2),
                     show(values.get("median_m"), 2),
                     show(values.get("median_deg"), 2)])
    return rows


def section_all_pairs(runner, strict):
    lines = [
        "## All pairs, strict", "",
        "Every pair of submaps that are at least 3 apart, not turned; an answer "
        "is right within 0.5 m and 10 degrees, to a pair with an overlap of at "
        "least 0.5, and wrong beyond 1 m or 10 degrees whatever the pair. "
        "Answers of one score count in the order of the table, or (*ties*) all "
        "at once.", ""]
    header = ["map", "method", "pairs", "positives", "recall at precision 1",
              "ties", "at .99", "average precision", "threshold",
              "median error [m]", "[deg]"]
    rows = [row for name, result in strict.items()
            for row in match_rows(name, result["numbers"])]
    lines += table(header, rows)
    write_table(runner.directory / "all_pairs.csv", header, rows)
    return lines + pictures(runner.directory, [
        (f"{name}.all_pairs.svg", f"Precision and recall over all pairs, {name}")
        for name in strict])


def accepted_rows(name, numbers):
    rows = []
    for method in METHODS:
        values = numbers[f"accepted {method}"]
        rows.append([name, method, *(show(values[q], 0) for q in (
            "right", "near", "wrong", "unknown", "queries", "queries_positive",
            "queries_matched", "queries_right"))])
    return rows


def section_place_recognition(runner, strict, sessions, figures):
    header = ["map", "method", "right matches", "near", "false", "not judged",
              "query submaps", "with a place to recognise", "with a match",
              "with a right one"]
    lines = [
        "## Place recognition", "",
        "What each method accepts as shipped: sdf by log-odds and verdict, the "
        "others by the number of inliers (see the options). *Not judged*: one of the two "
        "submaps has no true pose.", "",
        "### Loop closure within one trajectory", "",
        "Each submap against all before it, pairwise: `close_loops` and "
        "`match --agree` also check whether matches are mutually consistent.", ""]
    rows = [row for name, result in strict.items() if name not in sessions
            for row in accepted_rows(name, result["numbers"])]
    lines += table(header, rows)
    if sessions:
        lines += ["### Localisation of one session in the map of another", ""]
        session_rows = [row for name in sessions
                        for row in accepted_rows(name, strict[name]["numbers"])]
        lines += table(header, session_rows)
        rows += session_rows
    write_table(runner.directory / "place_recognition.csv", header, rows)
    return lines + pictures(runner.directory, figures)


def section_relations(runner, maps, results):
    lines = [
        "## Relations before and after close_loops", "",
        "Errors of hand-verified relations of scans (Kuemmerle et al. 2009), all "
        "and those of scans more than 30 s apart, and of nodes after a rigid "
        "alignment with the truth; of the maps that have relations.", ""]
    header = ["map", "of", "stage", "count", "mean [m]", "median", "90 %",
              "mean [deg]", "median", "90 %"]
    rows = []
    for evaluated in maps:
        for subject in ("relations", "loop relations", "nodes"):
            for stage, numbers in results[evaluated.name].items():
                values = numbers.get(subject)
                if values is None:
                    continue
                rows.append([evaluated.name, subject, stage,
                             show(values["count"], 0),
                             *(show(values[q], 3) for q in (
                                 "mean_m", "median_m", "p90_m", "mean_deg",
                                 "median_deg", "p90_deg"))])
    write_table(runner.directory / "relations.csv", header, rows)
    return lines + table(header, rows)


def read_scores(path):
    return {tuple(r[c] for c in IDS): (float(r["score"]), r["accepted"] == "1")
            for r in read_csv(path)}


IDS = ("reference_trajectory", "reference_index", "query_trajectory",
       "query_index")


def section_failures(strict, remarks):
    """Where methods fail, by numbers; why, by people."""
    lines = ["## Where it fails", ""]
    if remarks:
        lines += [remarks.strip(), ""]
    lines += [
        "Of the positive pairs of the strict protocol: right answers that score "
        "above every wrong one, right ones below, pairs with an answer near the "
        "truth or wrong, and pairs without any. The best wrong answer, with its "
        "score and how far it is off:", ""]
    rows = []
    for name, result in strict.items():
        for method in METHODS:
            labels = read_csv(result["labels"][method])
            scores = read_scores(result["matches"][method])
            def score_of(label):
                key = tuple(label[c] for c in IDS)
                turned = (*key[2:], *key[:2])
                return scores.get(key, scores.get(turned, (0., False)))[0]
            positives = [l for l in labels if l["positive"] == "1"]
            wrong = sorted((l for l in labels if l["verdict"] == "wrong"),
                           key=score_of, reverse=True)
            best_wrong = score_of(wrong[0]) if wrong else float("-inf")
            right = [score_of(l) for l in positives if l["verdict"] == "right"]
            num_positives = int(
                result["numbers"][f"matches {method}"]["positives"])
            off = "-"
            if wrong:
                w = wrong[0]
                off = (f"{w['reference_index']} and {w['query_index']}: "
                       f"{best_wrong:.2f}, {float(w['translation_error']):.1f} m, "
                       f"{float(w['rotation_error']) * 57.29578:.0f} deg")
            rows.append([
                name, method, num_positives,
                sum(s > best_wrong for s in right),
                sum(s <= best_wrong for s in right),
                sum(l["verdict"] == "near" for l in positives),
                sum(l["verdict"] == "wrong" for l in positives),
                num_positives - len(positives), off])
    lines += table(["map", "method", "positives", "right, above", "right, below",
                    "near", "wrong", "no answer", "best wrong answer"], rows)
    lines += [
        "Right ones among the answers to pairs of some overlap, whatever their "
        "score (in parentheses, the number of pairs that have an answer):", ""]
    bins = [(0.5, 0.6), (0.6, 0.7), (0.7, 0.8), (0.8, 1.01)]
    rows = []
    for name, result in strict.items():
        for method in METHODS:
            labels = read_csv(result["labels"][method])
            row = [name, method]
            for low, high in bins:
                inside = [l for l in labels
                          if low <= float(l["overlap"]) < high]
                right = sum(l["verdict"] == "right" for l in inside)
                row.append(f"{right / len(inside):.2f} ({len(inside)})"
                           if inside else "-")
            rows.append(row)
    header = ["map", "method", *(f"{a:g} to {min(b, 1.):g}" for a, b in bins)]
    return lines + table(header, rows)


def evaluate(arguments, maps, sessions):
    directory = arguments.output.with_suffix("").resolve()
    directory.mkdir(parents=True, exist_ok=True)
    started = datetime.datetime.now()
    with contextlib.ExitStack() as stack:
        work = (arguments.work or pathlib.Path(stack.enter_context(
            tempfile.TemporaryDirectory()))).resolve()
        work.mkdir(parents=True, exist_ok=True)
        runner = Runner(arguments.program.resolve(), work, directory,
                        arguments.threads)
        pair_results, strict, relation_results = {}, {}, {}
        for evaluated in maps:
            pair_results[evaluated.name] = random_pairs(runner, evaluated,
                                                        arguments)
            strict[evaluated.name] = all_pairs(runner, evaluated.name, evaluated)
            if evaluated.relations:
                relation_results[evaluated.name] = relations(runner, evaluated)
        session_names = []
        for query, reference in sessions:
            name = f"{query.name}_in_{reference.name}"
            session_names.append(name)
            strict[name] = all_pairs(runner, name, reference, query)
        figures = []
        if arguments.figures:
            figures = make_figures.paper_figures(
                runner.run, work, directory, maps, sessions,
                {name: result["matches"] for name, result in strict.items()},
                arguments.figures)
        remarks = (arguments.remarks.read_text(encoding="utf-8")
                   if arguments.remarks else "")
        minutes = (datetime.datetime.now() - started).total_seconds() / 60.
        command = shlex.join(["scripts/run_evaluation.sh", *(
            runner.short(a) for a in sys.argv[1:])])
        lines = [
            "# The paper's evaluation", "",
            f"Made by `{command}` on {datetime.date.today()}, commit "
            f"{commit_name()}, {processor()}, {os.cpu_count()} cores, in "
            f"{minutes:.0f} minutes. Tables, curves, plots, pictures, options "
            f"in force and commands are in {directory.name}/.", "",
            "Methods: *sdf* is this project's, as shipped; *paper* is Millane et "
            "al. 2019 as printed; *shape_context* is what they compare with, "
            "curvature clusters (Bosse and Zlot 2009) described by shape contexts "
            "(Belongie et al. 2002) on aggregated point clouds. paper and "
            "shape_context share matching and RANSAC.", "",
            "## Parameters", "", "The paper's Table I, and the parameters "
            "that it leaves open.", "",
            *parameter_table(runner),
            *section_random_pairs(runner, maps, pair_results, arguments),
            *section_free_space(runner, maps, pair_results),
            *section_all_pairs(runner, strict),
            *section_place_recognition(runner, strict, session_names, [
                f for f in figures if "match" in f[0]]),
            *section_relations(runner, [m for m in maps if m.relations],
                               relation_results),
            *section_failures(strict, remarks)]
        others = [f for f in figures if "match" not in f[0]]
        shown = pictures(directory, others)
        if shown:
            lines += ["## Features", "", *shown]
        (directory / "commands.txt").write_text(
            "\n".join(runner.commands) + "\n", encoding="utf-8")
    temporary = arguments.output.with_suffix(".tmp")
    temporary.write_text("\n".join(lines), encoding="utf-8")
    os.replace(temporary, arguments.output)
    print(arguments.output)


def main():
    parser = argparse.ArgumentParser(
        prog="run_evaluation.sh", description=__doc__,
        formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("maps", nargs="*", metavar="NAME=MAP,TRUTH[,RELATIONS]")
    parser.add_argument("--data", type=pathlib.Path,
                        default=DATA_DIR, help="where maps are looked for")
    parser.add_argument("--only", help="some of the maps, separated by commas")
    parser.add_argument("--sessions", default="willow_2:willow_1",
                        help="QUERY:MAP, by names, separated by commas; those "
                        "that are not there are passed over")
    parser.add_argument("--pairs", type=int, default=1000)
    parser.add_argument("--pairs_of", default="", metavar="NAME=N,...",
                        help="another number of random pairs for some maps")
    parser.add_argument("--seed", type=int, default=42)
    parser.add_argument("--work", type=pathlib.Path,
                        help="directory for what is in between; a run that was "
                        "broken off goes on from there")
    parser.add_argument("--neighbours", action="store_true",
                        help="also draw pairs among submaps that share scans")
    parser.add_argument("--threads", type=int, default=0,
                        help="of each run; 0: all cores")
    parser.add_argument("--figures", default="willow_1",
                        help="the map whose features are drawn, by name; none "
                        "if empty")
    parser.add_argument("--remarks", type=pathlib.Path,
                        help="Markdown to put where the report says where the "
                        "methods fail")
    parser.add_argument("--program", type=pathlib.Path,
                        default=PROGRAM)
    parser.add_argument("--output", type=pathlib.Path,
                        default=SOURCE_DIR / "docs" / "results"
                        / "evaluation.md")
    arguments = parser.parse_args()
    if arguments.pairs < 1:
        parser.error("--pairs must be positive")
    try:
        check_program(arguments.program)
        arguments.pairs_by_map = {}
        for part in filter(None, arguments.pairs_of.split(",")):
            name, _, number = part.partition("=")
            arguments.pairs_by_map[name] = int(number)
        maps = ([parse_map(m) for m in arguments.maps] if arguments.maps
                else discover(arguments.data))
        if arguments.only is not None:
            wanted = arguments.only.split(",")
            unknown = set(wanted) - {m.name for m in maps}
            if unknown:
                raise Failure(f"there is no map {sorted(unknown)[0]}")
            maps = [m for m in maps if m.name in wanted]
        if not maps:
            raise Failure(f"there is no map with a truth in {arguments.data}")
        by_name = {m.name: m for m in maps}
        sessions = []
        for session in filter(None, arguments.sessions.split(",")):
            query, colon, reference = session.partition(":")
            if not colon:
                raise Failure(f"a session is QUERY:MAP, not {session}")
            if query in by_name and reference in by_name:
                sessions.append((by_name[query], by_name[reference]))
        evaluate(arguments, maps, sessions)
    except (Failure, OSError, ValueError, KeyError) as failure:
        print(f"run_evaluation.sh: {failure}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
