#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

"""Measures what stages and kinds of keypoints are worth by taking them away.

Matches each data set with the shipped options and with variants of them, side
by side, and prints tables for docs/results/ablation.md. Of --study stages,
variants take one stage away on five maps; of --study keypoints, one kind of
keypoints, from matching, from retrieval or from both, on every map with a truth
and on simulated ones. The maps are no part of the project; see CONTRIBUTING.md.
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

import simulated_sets
from measuring import (BETWEEN, DATA_DIR, PROGRAM, SOURCE_DIR, WITHIN, Failure,
                       between, check_program, commit_name, numbers_of,
                       processor, read_csv, run)

# A place that is simulated counts with each of these seeds.
SEEDS = (1, 2, 3)
TINYSLAM = [between(f"tinyslam_exp{a}", f"tinyslam_exp{b}")
            for a, b in ((1, 3), (1, 4), (3, 4))]
RECORDED = {entry.name: entry for entry in WITHIN + BETWEEN + TINYSLAM}
STAGE_SETS = {"as recorded": ("intel", "aces", "mit_killian", "willow_1",
                              "willow_2")}
# Sets that nothing else claims are offices.
KEYPOINT_SETS = {
    "halls": ("wide_hall", "open_hall", "belgioioso", "fhw_1", "fhw_2",
              "fhw_1 x fhw_2"),
    "outdoors": ("houses", "freiburg_campus"),
    "other lidars": ("short_lidar", "sparse_lidar", "orebro",
                     *(entry.name for entry in TINYSLAM)),
}
KEYPOINT_SETS["offices"] = ("bare_office", *(
    name for name in RECORDED
    if not any(name in group for group in KEYPOINT_SETS.values())))


class Variant(typing.NamedTuple):
    name: str
    what: str
    # Lua; `place`, `match`, `retrieval`, `verification`, `judgement`, `weights`
    # and `neighbourhood` are those tables.
    overrides: str = ""
    flags: tuple = ()
    # Whether scores mean the same as in the shipped options, so that what is
    # accepted can be compared.
    comparable: bool = True


# Weights of terms that are not named stay as they were learned together with
# the others.
STAGE_VARIANTS = [
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

# Of where a kind of keypoints is taken away.
PARTS = {"": ("match.correspondence", "retrieval.pairs"),
         "_matching": ("match.correspondence",),
         "_retrieval": ("retrieval.pairs",)}


def without_kinds(name, what, kinds):
    """Variants that take kinds of keypoints away, everywhere or in one part."""
    return [Variant(f"{name}{suffix}", what + suffix.replace("_", ", only in "),
                    "\n".join(f"{part}.kinds.{kind} = false"
                              for part in parts for kind in kinds))
            for suffix, parts in PARTS.items()]


KEYPOINT_VARIANTS = [
    Variant("shipped", "all options as shipped"),
    *without_kinds("no_maxima", "without the middles of rooms", ("maxima",)),
    *without_kinds("no_saddles", "without narrow places", ("saddles",)),
    *without_kinds("walls_only", "without both: without free space",
                   ("maxima", "saddles")),
    *without_kinds("free_only", "without keypoints on walls", ("minima",)),
    Variant("clearance_1m", "no keypoints farther than 1 m from walls",
            "place.keypoint.max_clearance_meters = 1."),
]
# Each of the index's best five candidates becomes an answer, however bad.
CANDIDATES = """retrieval.min_num_candidates = 5
retrieval.max_num_candidates = 5
verification.ranking.min_coarse_score = -1e9
verification.ranking.min_fine_score = -1e9
verification.ranking.num_coarse_survivors = 1
verification.ranking.num_refined = 1
"""


class Study(typing.NamedTuple):
    sets: dict  # of names, by group
    variants: list
    # Whether it tells what the index proposes.
    with_candidates: bool


STUDIES = {"stages": Study(STAGE_SETS, STAGE_VARIANTS, False),
           "keypoints": Study(KEYPOINT_SETS, KEYPOINT_VARIANTS, True)}

PREAMBLE = """include "sdf_global_constraints.lua"
local place = SDF_GLOBAL_CONSTRAINTS.loop_closing.place
local recognition = SDF_GLOBAL_CONSTRAINTS.loop_closing.recognition
local match = recognition.match
local retrieval = recognition.retrieval
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

COLUMNS = {"recall_p1": "recall at precision 1", "recall_p99": "at .99",
           "accepted_recall": "recall of accepted",
           "accepted_wrong": "accepted wrong",
           "candidate_recall": "recall of the index's best five",
           "cpu": "CPU time"}
IDS = ["reference_trajectory", "reference_index", "query_trajectory",
       "query_index"]
# Names of the selection's verdicts, see closing/closure.h.
REFUSED = ("inconsistent", "unsupported")


def configuration_name(name):
    return f"ablation_{name}.lua"


def candidates_of(variants):
    """{name of a variant: one that answers every pair that its index finds first};
    the same for variants that differ in matching only."""
    shared = {}
    for variant in variants:
        kept = "\n".join(line for line in variant.overrides.splitlines()
                         if not line.startswith("match."))
        shared.setdefault(kept, Variant(
            f"{variant.name}+candidates", "", f"{kept}\n{CANDIDATES}",
            ("--alone",), False))
        shared[variant.name] = shared[kept]
    return {variant.name: shared[variant.name] for variant in variants}


def write_configuration(work, variant):
    (work / configuration_name(variant.name)).write_text(
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
         configuration_name(variant.name)],
        capture_output=True, text=True, check=False)
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


def ids_of(rows):
    return {tuple(row[column] for column in IDS) for row in rows}


def seeds_of(names):
    """(name, seed) of each set; no seed where it is recorded."""
    return [(name, seed) for name in names
            for seed in (SEEDS if name in simulated_sets.PLACES else (None,))]


def entry_name(name, seed):
    return name if seed is None else f"{name}_{seed}"


class Measurement:
    """One data set, matched with each variant."""

    def __init__(self, program, work, data, entry):
        self.program = program
        self.options = work
        self.work = work / entry.name
        self.work.mkdir()
        self.map, self.truth = data / entry.map, data / entry.truth
        self.query, self.query_truth = [], []
        if entry.query:
            self.query = ["--query", data / entry.query]
            self.query_truth = ["--query_truth", data / entry.query_truth]

    def path(self, variant, kind):
        return self.work / kind / f"{variant.name}.csv"

    def match(self, variant):
        """CPU seconds."""
        flags = ["--configuration_directory", self.options]
        if "--method" not in variant.flags:
            flags += ["--configuration_basename",
                      configuration_name(variant.name)]
        return run(self.program, "match", "--input", self.map, *self.query,
                   "--output", self.path(variant, "matches"), "--threads", 1,
                   *flags, *variant.flags)[1]

    def evaluate(self, variants):
        """All variants at once, as finding what overlaps takes longest."""
        def paths(kind):
            return ",".join(str(self.path(v, kind)) for v in variants)
        run(self.program, "evaluate", "--input", self.map, "--truth", self.truth,
            *self.query, *self.query_truth, "--matches", paths("matches"),
            "--labels", paths("labels"), "--csv", self.work / "numbers.csv")
        return numbers_of(self.work / "numbers.csv")

    def measure(self, variants, candidates):
        """{name of a variant: numbers}; see candidates_of."""
        for kind in ("matches", "labels"):
            (self.work / kind).mkdir()
        tried = [*variants, *{v.name: v for v in candidates.values()}.values()]
        seconds = {variant.name: self.match(variant) for variant in tried}
        accepted = {}
        for variant in variants:
            path = self.path(variant, "matches")
            accepted[variant.name] = ids_of(
                row for row in read_csv(path) if row["accepted"] == "1")
            if "--agree" in variant.flags:
                drop_refused(path, path)
        numbers = self.evaluate(tried)
        results = {}
        for v in variants:
            subject = "matches" if len(tried) == 1 else f"matches {v.name}"
            results[v.name] = {
                "cpu": seconds[v.name],
                "positives": numbers[subject, "positives"],
                "recall_p1": numbers[subject, "recall_p1"],
                "recall_p99": numbers[subject, "recall_p99"],
                **self.accepted(v, accepted[v.name],
                                numbers[subject, "positives"])}
            if candidates:
                results[v.name]["candidate_recall"] = (
                    self.num_positives(candidates[v.name])
                    / max(1., numbers[subject, "positives"]))
        return results

    def accepted(self, variant, ids, positives):
        verdicts = [(row["verdict"], row["positive"])
                    for row in read_csv(self.path(variant, "labels"))
                    if tuple(row[column] for column in IDS) in ids]
        return {"accepted_recall":
                verdicts.count(("right", "1")) / max(1., positives),
                "accepted_wrong": sum(name == "wrong" for name, _ in verdicts)}

    def num_positives(self, variant):
        return sum(row["positive"] == "1"
                   for row in read_csv(self.path(variant, "labels")))


def format_number(column, value, shipped, comparable=True):
    if column in ("accepted_recall", "accepted_wrong") and not comparable:
        return "-"
    if column == "accepted_wrong":
        return str(value)
    return f"{value / shipped if column == 'cpu' else value:.3f}"


def table(corner, names, rows):
    """Lines of a table; `rows` are names with cells."""
    return [f"| {corner} | " + " | ".join(names) + " |",
            "| --- |" + " --- |" * len(names),
            *(f"| {name} | " + " | ".join(cells) + " |" for name, cells in rows)]


def heading(text):
    return ["", f"## {text[0].upper()}{text[1:]}", ""]


def columns_of(results):
    first = next(iter(results.values()))["shipped"]
    return [column for column in COLUMNS if column in first]


def stage_tables(variants, results):
    """A table for each number, of variants and sets."""
    lines = []
    for column in columns_of(results):
        lines += heading(COLUMNS[column]) + table(
            "variant", list(results),
            [(v.name, [format_number(column, of_set[v.name][column],
                                     of_set["shipped"][column], v.comparable)
                       for of_set in results.values()]) for v in variants])
    return lines


def pooled(column, name, sets):
    """The number of a variant in several sets: recall is that of all positive
    pairs, all else a sum."""
    if "recall" not in column:
        return sum(of_set[name][column] for of_set in sets)
    positives = [of_set[name]["positives"] for of_set in sets]
    return (sum(count * of_set[name][column]
                for count, of_set in zip(positives, sets))
            / max(1., sum(positives)))


def largest_change(column, name, results, sign):
    """The set in which a variant loses (-1) or gains (1) most."""
    def change(of_set):
        return sign * (of_set[name][column] - of_set["shipped"][column])
    most = max(results, key=lambda key: change(results[key]))
    if change(results[most]) < 5e-4:
        return "-"
    return (f"{most} {results[most]['shipped'][column]:.3f} to "
            f"{results[most][name][column]:.3f}")


def keypoint_tables(variants, results, groups):
    """For each number a table of variants and groups of sets, with the sets that
    change most; then one of all sets, the worst first."""
    lines = []
    for column in columns_of(results):
        if column == "recall_p99":
            continue
        is_recall = "recall" in column
        rows = []
        for v in variants:
            if column == "candidate_recall" and v.name.endswith("_matching"):
                continue
            cells = [format_number(column, pooled(column, v.name, sets),
                                   pooled(column, "shipped", sets))
                     for sets in groups.values()]
            if is_recall:
                cells += [largest_change(column, v.name, results, sign)
                          for sign in (-1, 1)]
            rows.append((v.name, cells))
        lines += heading(COLUMNS[column]) + table(
            "variant", [*groups, *(("largest loss", "largest gain")
                                   if is_recall else ())], rows)
    whole = [v.name for v in variants
             if not v.name.endswith(("_matching", "_retrieval"))]
    worst_first = sorted(results.items(), key=lambda item: min(
        item[1][name]["accepted_recall"] for name in whole))
    return lines + heading("set by set") + [
        "Recall at precision 1; recall of accepted; accepted wrong; recall of the "
        "index's best five.", ""] + table(
            "set, positives", whole,
            [(f"{name}, {of_set['shipped']['positives']:.0f}", [
                "; ".join(format_number(column, of_set[v][column], 1.)
                          for column in ("recall_p1", "accepted_recall",
                                         "accepted_wrong", "candidate_recall"))
                for v in whole]) for name, of_set in worst_first])


def groups_of(study, results):
    """{group: results of its sets}, where there are any."""
    groups = {}
    for group, names in study.sets.items():
        sets = [results[entry_name(*entry)] for entry in seeds_of(names)
                if entry_name(*entry) in results]
        if sets:
            groups[group] = sets
    return groups


def report(study, variants, results, jobs):
    """`results` are of sets, by name of the variant."""
    lines = [
        f"Made by `{shlex.join(['scripts/measure_ablation.py', *sys.argv[1:]])}`"
        f" on {datetime.date.today()}, commit {commit_name()}, {processor()}, "
        f"{os.cpu_count()} cores, {jobs} sets at a time.", "",
        "Recall is of positive pairs with a right answer (0.5 m, 10 degrees) by "
        "falling score, whatever the verdict: before the first wrong one, and at "
        "a precision of .99. Where a variant changes what the score means, \"-\" "
        "stands for what is accepted; weights that remain are those that were "
        "learned with the others. CPU time is that of the whole run, as a multiple "
        "of the shipped one's.", "",
        "| variant | |", "| --- | --- |"]
    lines += [f"| {v.name} | {v.what} |" for v in variants]
    if study.with_candidates:
        lines += keypoint_tables(variants, results, groups_of(study, results))
    else:
        lines += stage_tables(variants, results)
    seconds = ", ".join(f"{name} {of_set['shipped']['cpu']:.1f} s"
                        for name, of_set in results.items())
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


def is_here(data, name):
    if name in simulated_sets.PLACES:
        return True
    entry = RECORDED[name]
    return all((data / path).exists()
               for path in (entry.map, entry.truth, entry.query))


class Bench:
    """A program and configurations that a long run does not share with who works
    on them meanwhile."""

    def __init__(self, work, arguments, study, variants):
        self.work = work
        self.data = arguments.data.resolve()
        self.program = pathlib.Path(shutil.copy2(arguments.program, work))
        self.variants = variants
        self.candidates = (candidates_of(variants) if study.with_candidates
                           else {})
        for path in (SOURCE_DIR / "configuration_files").glob("*.lua"):
            shutil.copy2(path, work)
        for variant in (*variants, *self.candidates.values()):
            write_configuration(work, variant)
            check_configuration(self.program, work, variant)

    def measure(self, name, seed):
        """{name of a variant: numbers} of a set."""
        entry = (RECORDED[name] if seed is None else
                 simulated_sets.simulate(self.program, self.work, name, seed))
        return Measurement(self.program, self.work, self.data,
                           entry).measure(self.variants, self.candidates)


def parse_arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--study", choices=list(STUDIES), default="stages")
    parser.add_argument("--data", type=pathlib.Path,
                        default=DATA_DIR, help="where the maps are")
    parser.add_argument("--sets", help="some of the study's, by commas")
    parser.add_argument("--variants", help="some of the study's, by commas; "
                        "shipped is always among them")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1,
                        help="sets at a time, of one thread each")
    parser.add_argument("--program", type=pathlib.Path, default=PROGRAM)
    parser.add_argument("--output", type=pathlib.Path, required=True,
                        help="Markdown file; written anew after each set")
    arguments = parser.parse_args()
    if arguments.jobs < 1:
        parser.error("--jobs must be positive")
    return arguments


def names_to_measure(arguments, study):
    names = choose("data set", arguments.sets,
                   [name for group in study.sets.values() for name in group])
    for name in list(names):
        if not is_here(arguments.data, name):
            print(f"skip {name}: it is not in {arguments.data}", file=sys.stderr)
            names.remove(name)
    if not names:
        raise Failure("there is not one data set")
    return names


def measure_all(arguments, study):
    chosen = choose("variant", arguments.variants,
                    [v.name for v in study.variants])
    variants = [v for v in study.variants if v.name in {*chosen, "shipped"}]
    sets = seeds_of(names_to_measure(arguments, study))
    check_program(arguments.program)
    with (tempfile.TemporaryDirectory() as work,
          concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool):
        bench = Bench(pathlib.Path(work), arguments, study, variants)
        # Variants of one data set in turn, so that what else the machine does
        # meets all alike.
        futures = [pool.submit(bench.measure, *entry) for entry in sets]
        results = {}
        try:
            for entry, future in zip(sets, futures):
                name = entry_name(*entry)
                results[name] = future.result()
                arguments.output.write_text(
                    report(study, variants, results, arguments.jobs),
                    encoding="utf-8")
                print(f"{name} ({len(results)} of {len(sets)})",
                      file=sys.stderr, flush=True)
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


def main():
    arguments = parse_arguments()
    try:
        measure_all(arguments, STUDIES[arguments.study])
    except (Failure, OSError, ValueError, KeyError) as failure:
        print(f"measure_ablation.py: {failure}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
