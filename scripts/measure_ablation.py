#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

"""Measures what each stage is worth by taking it away.

Matches each data set with the shipped options and with variants of them, side
by side, and writes docs/results/ablation.md. The maps are no part of the
project; see CONTRIBUTING.md.
"""

import argparse
import concurrent.futures
import csv
import datetime
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile
import typing

from measuring import (DATA_DIR, PROGRAM, SOURCE_DIR, Failure, check_program,
                       commit_name, processor, read_csv)

# name: map, truth, and the same of a query map.
SETS = {
    "intel": ("intel_open_loop.pbstream", "intel.truth.csv"),
    "aces": ("aces_open_loop.pbstream", "aces.truth.csv"),
    "killian": ("mit_killian_open_loop.pbstream", "mit_killian.truth.csv"),
    "willow_1": ("willow_1.pbstream", "willow_1.truth.csv"),
    "willow_2": ("willow_2.pbstream", "willow_2.truth.csv"),
    "willow_2_in_1": ("willow_1.pbstream", "willow_1.truth.csv",
                      "willow_2.pbstream", "willow_2.truth.csv"),
}


class Variant(typing.NamedTuple):
    name: str
    what: str
    # Lua; `place`, `match`, `verification`, `judgement`, `weights` and
    # `neighbourhood` are
    # those tables.
    overrides: str = ""
    flags: tuple = ()
    # Whether scores mean the same as in the shipped options, so that what is
    # accepted can be compared.
    comparable: bool = True


# Weights of terms that are not named stay as they were learned together with
# the others.
VARIANTS = [
    Variant("shipped", "all options as shipped"),
    Variant("alone", "each pair by itself, without its neighbourhood", "",
            ("--alone",), False),
    Variant("all_pairs", "every pair is matched, not only those that the index "
            "proposes", "", ("--all_pairs",)),
    Variant("no_proposals", "neighbourhoods are verified, but propose no poses",
            "neighbourhood.min_proposing_score = 1e9"),
    Variant("paper", "the method as published: ratio test, RANSAC, inliers "
            "counted", "", ("--method", "paper"), False),
    Variant("any_kind", "a keypoint matches any kind",
            "match.correspondence.same_kind_only = false"),
    Variant("no_distance_entry", "no mean distance in the descriptor",
            "place.descriptor.distance_weight = 0."),
    Variant("no_clearance_gate", "keypoints match at any distance to walls",
            "match.correspondence.max_clearance_difference_meters = 1e6"),
    Variant("no_distance", "neither of the two",
            "place.descriptor.distance_weight = 0.\n"
            "match.correspondence.max_clearance_difference_meters = 1e6"),
    *[Variant(f"clearance_{meters:g}m",
              f"no keypoints farther than {meters:g} m from walls",
              f"place.keypoint.max_clearance_meters = {meters:g}")
      for meters in (2., 1.5, 1., 0.5)],
    Variant("ranking_hits_only", "hypotheses are ranked without contradictions",
            "verification.ranking.contradiction_weight = 0."),
    Variant("score_without_contradictions",
            "neither the score nor the verdict knows of contradictions",
            'drop("contradiction")\n'
            "judgement.max_contradiction_ratio = 1.", (), False),
    Variant("no_contradictions", "both; they still tell refined poses of "
            "a pair apart",
            "verification.ranking.contradiction_weight = 0.\n"
            'drop("contradiction")\n'
            "judgement.max_contradiction_ratio = 1.", (), False),
    Variant("certainty_ignored",
            "every wall and every free cell is as certain as any",
            "verification.agreement.weigh_by_certainty = false", (), False),
    Variant("no_rivals", "the next best pose does not matter",
            'drop("margin")\njudgement.min_margin = 0.', (), False),
    Variant("wall_evidence_as_score", "the score is the walls' evidence alone",
            'keep("wall_evidence")', (), False),
    Variant("agree", "and accepted matches must agree with each other", "",
            ("--agree",)),
]

PREAMBLE = """include "sdf_global_constraints.lua"
local place = SDF_GLOBAL_CONSTRAINTS.loop_closing.place
local recognition = SDF_GLOBAL_CONSTRAINTS.loop_closing.recognition
local match = recognition.match
local verification = match.verification
local neighbourhood = recognition.neighbourhood
local judgement = verification.judgement
local weights = judgement.score_weights
-- Takes terms out of the score.
local function drop(part)
  local found = false
  for name in pairs(weights) do
    for k = 1, #name do
      if string.sub(name, k, k + #part - 1) == part then
        weights[name] = 0.
        found = true
      end
    end
  end
  if not found then error("no weight is called " .. part) end
end
-- Makes one term the score.
local function keep(kept)
  if weights[kept] == nil then error("no weight is called " .. kept) end
  for name in pairs(weights) do weights[name] = 0. end
  weights[kept] = 1.
end
"""

COLUMNS = [("recall_p1", "recall at precision 1"), ("recall_p99", "at .99"),
           ("accepted_recall", "recall of accepted"),
           ("accepted_wrong", "accepted wrong"), ("cpu", "CPU time")]
IDS = ["reference_trajectory", "reference_index", "query_trajectory",
       "query_index"]
# Names of the selection's verdicts, see closing/closure.h.
REFUSED = ("inconsistent", "unsupported")


def run(arguments):
    """The CPU seconds that a run of the program takes, user and system."""
    with tempfile.TemporaryFile("w+") as errors:
        child = subprocess.Popen(list(map(str, arguments)),
                                 stdout=subprocess.DEVNULL, stderr=errors)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode != 0:
            errors.seek(0)
            raise Failure(errors.read().strip() or
                          f"{shlex.join(map(str, arguments))} failed")
    return usage.ru_utime + usage.ru_stime


def configuration_name(variant):
    return f"ablation_{variant.name}.lua"


def write_configuration(work, variant):
    (work / configuration_name(variant)).write_text(
        f"{PREAMBLE}{variant.overrides}\nreturn SDF_GLOBAL_CONSTRAINTS\n",
        encoding="utf-8")


def check_configuration(program, work, variant):
    """Fails where the overrides do not fit the options; sooner than a run of
    many minutes would."""
    no_map = work / "no_map"
    no_map.touch()
    result = subprocess.run(
        [program, "match", "--input", no_map, "--output", "-",
         "--configuration_directory", work, "--configuration_basename",
         configuration_name(variant)], capture_output=True, text=True, check=False)
    if "configuration file" in result.stderr:
        raise Failure(f"variant {variant.name}: {result.stderr.strip()}")


def drop_refused(matches, kept):
    """Copies a table of matches without those that the selection refused: they
    are no answers any more."""
    rows = read_csv(matches)
    with open(kept, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0].keys() if rows else IDS)
        writer.writeheader()
        writer.writerows(r for r in rows if r["verdict"] not in REFUSED)


def measure(program, data, work, name, variant):
    """The numbers of one variant on one data set."""
    paths = [data / path for path in SETS[name]]
    base = work / f"{name}.{variant.name}"
    matches, labels, numbers = (
        pathlib.Path(f"{base}.{kind}.csv")
        for kind in ("matches", "labels", "numbers"))
    flags = ["--configuration_directory", work]
    if "--method" not in variant.flags:
        flags += ["--configuration_basename", configuration_name(variant)]
    query = ["--query", paths[2]] if len(paths) == 4 else []
    cpu = run([program, "match", "--input", paths[0], *query, "--output",
               matches, "--threads", 1, *flags, *variant.flags])
    accepted = {tuple(row[c] for c in IDS) for row in read_csv(matches)
                if row["accepted"] == "1"}
    if "--agree" in variant.flags:
        kept = pathlib.Path(f"{base}.kept.csv")
        drop_refused(matches, kept)
        matches = kept
    if query:
        query += ["--query_truth", paths[3]]
    run([program, "evaluate", "--input", paths[0], "--truth", paths[1], *query,
         "--matches", matches, "--labels", labels, "--csv", numbers])
    values = {row["quantity"]: float(row["value"]) for row in read_csv(numbers)
              if row["subject"] == "matches"}
    verdicts = [(row["verdict"], row["positive"]) for row in read_csv(labels)
                if tuple(row[c] for c in IDS) in accepted]
    right = sum(verdict == ("right", "1") for verdict in verdicts)
    return {"recall_p1": values["recall_p1"],
            "recall_p99": values["recall_p99"],
            "accepted_recall": right / max(1., values["positives"]),
            "accepted_wrong": sum(v == "wrong" for v, _ in verdicts),
            "cpu": cpu}


def format_number(column, numbers, shipped, comparable):
    if column in ("accepted_recall", "accepted_wrong") and not comparable:
        return "-"
    if column == "accepted_wrong":
        return str(numbers[column])
    if column == "cpu":
        return f"{numbers[column] / shipped[column]:.2f}"
    return f"{numbers[column]:.3f}"


def report(names, variants, results, jobs):
    lines = [
        "# What each stage is worth", "",
        f"Made by `{shlex.join(['scripts/measure_ablation.py', *sys.argv[1:]])}`"
        f" on {datetime.date.today()}, commit {commit_name()}, {processor()}, "
        f"{os.cpu_count()} cores, {jobs} runs at a time.", "",
        "Each variant takes one thing away from the shipped options, on the "
        "same binary. Recall is of positive pairs with a right answer (0.5 m, "
        "10 degrees) by falling score, whatever the verdict: before the first "
        "wrong one, and at a precision of .99. Where a variant changes what the "
        "score means, \"-\" stands for what is accepted, and recall at "
        "precision 1 is the fair number; weights that remain are those that "
        "were learned with the others. CPU time is that of the whole run, as a "
        "multiple of the shipped one's.", "",
        "| variant | |", "| --- | --- |"]
    lines += [f"| {v.name} | {v.what} |" for v in variants]
    for column, title in COLUMNS:
        lines += ["", f"## {title[0].upper()}{title[1:]}", "",
                  "| variant | " + " | ".join(names) + " |",
                  "| --- |" + " --- |" * len(names)]
        for variant in variants:
            cells = [format_number(column, results[name, variant.name],
                                   results[name, "shipped"], variant.comparable)
                     for name in names]
            lines.append(f"| {variant.name} | " + " | ".join(cells) + " |")
    seconds = ", ".join(f"{name} {results[name, 'shipped']['cpu']:.1f} s"
                        for name in names)
    lines += ["", f"CPU time of the shipped options: {seconds}."]
    return "\n".join(lines) + "\n"


def choose(what, text, known):
    if text is None:
        return list(known)
    chosen = [part for part in text.split(",") if part]
    for name in chosen:
        if name not in known:
            raise Failure(f"there is no {what} {name!r}; there are "
                          f"{', '.join(known)}")
    return [name for name in known if name in chosen]


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--data", type=pathlib.Path,
                        default=DATA_DIR, help="where the maps are")
    parser.add_argument("--sets", help=f"some of {','.join(SETS)}")
    parser.add_argument("--variants", help="some of "
                        + ",".join(v.name for v in VARIANTS)
                        + "; shipped is always among them")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1,
                        help="runs at a time, of one thread each")
    parser.add_argument("--program", type=pathlib.Path,
                        default=PROGRAM)
    parser.add_argument("--output", type=pathlib.Path,
                        default=SOURCE_DIR / "docs" / "results"
                        / "ablation.md")
    arguments = parser.parse_args()
    if arguments.jobs < 1:
        parser.error("--jobs must be positive")
    try:
        names = choose("data set", arguments.sets, SETS)
        chosen = choose("variant", arguments.variants,
                        [v.name for v in VARIANTS])
        variants = [v for v in VARIANTS if v.name in {*chosen, "shipped"}]
        for name in list(names):
            if not all((arguments.data / path).exists() for path in SETS[name]):
                print(f"skip {name}: it is not in {arguments.data}",
                      file=sys.stderr)
                names.remove(name)
        if not names:
            raise Failure("there is not one data set")
        program = arguments.program.resolve()
        check_program(program)
        results = {}
        with tempfile.TemporaryDirectory() as directory:
            work = pathlib.Path(directory)
            # A long run does not mind that they are worked on.
            program = pathlib.Path(shutil.copy2(program, work))
            for path in (SOURCE_DIR / "configuration_files").glob("*.lua"):
                shutil.copy2(path, work)
            for variant in variants:
                write_configuration(work, variant)
                check_configuration(program, work, variant)
            with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
                # Variants of one data set side by side, so that what else the
                # machine does meets all alike.
                futures = {
                    pool.submit(measure, program, arguments.data, work, name,
                                variant): (name, variant.name)
                    for name in names for variant in variants}
                try:
                    for future in concurrent.futures.as_completed(futures):
                        results[futures[future]] = future.result()
                        print(f"{' '.join(futures[future])} ({len(results)} of "
                              f"{len(futures)})", file=sys.stderr, flush=True)
                except BaseException:
                    pool.shutdown(cancel_futures=True)
                    raise
        arguments.output.parent.mkdir(parents=True, exist_ok=True)
        arguments.output.write_text(
            report(names, variants, results, arguments.jobs), encoding="utf-8")
        print(arguments.output)
    except (Failure, OSError, ValueError, KeyError) as failure:
        print(f"measure_ablation.py: {failure}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
