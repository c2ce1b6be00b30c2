#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

"""Learns the weights of the score (verification.score_weights) and reports.

Matches maps whose truth is known, labels the answers, and fits a logistic
regression of right against wrong answers on the terms of the score, whatever
they are called. Each building weighs the same, and so do all pairs of
different buildings together, in which every answer is wrong; answers that are
near (neither right nor wrong) are left out. Terms are standardised, and the
weights, but for the bias, held by an L2 penalty.

A report in Markdown goes to stdout: for each building the quality of weights
that were learned without it, calibration, and the weights of all as Lua.
Progress goes to stderr. The same input gives the same report.

Maps come from --data (those of the table below that are there), from --sets
(a CSV file with the columns building, map, truth, query_building, query,
query_truth, the last three empty where a map is matched with itself; paths are
relative to the file), and from simulated buildings.

Matches are made as shipped, among the pairs that the index and neighbours
propose, so that the terms are those that the weights will meet.

With --neighbours it learns the weights of the score in the neighbourhood
(neighbourhood.weights) instead, whose terms build on the pair's own score in
force: learn that one first.
"""

import argparse
import csv
import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    print("learn_score.py: install the Debian package python3-numpy",
          file=sys.stderr)
    sys.exit(1)

from measuring import (DATA_DIR, PROGRAM, SOURCE_DIR, Failure,  # noqa: E402
                       check_program)

# building, map, truth, and the same of a query map.
def within(building, name, map_name=""):
    return (building, f"{map_name or name}.pbstream", f"{name}.truth.csv")


def between(building, first, second):
    return (building, f"{first}.pbstream", f"{first}.truth.csv", building,
            f"{second}.pbstream", f"{second}.truth.csv")


def strangers(building, name, other_building, other):
    return (building, f"{name}.pbstream", "", other_building,
            f"{other}.pbstream", "")


# Without maps of equal rooms: where nothing in two submaps tells them apart,
# there is nothing to learn (recognition/rival_matches.h).
REAL_SETS = [
    within("intel", "intel", "intel_open_loop"),
    within("aces", "aces", "aces_open_loop"),
    within("killian", "mit_killian", "mit_killian_open_loop"),
    *(within(building, name) for building, name in (
        ("willow", "willow_1"), ("willow", "willow_2"), ("fr079", "fr079"),
        ("belgioioso", "belgioioso"), ("fhw", "fhw_1"), ("fhw", "fhw_2"),
        ("orebro", "orebro"), ("campus", "freiburg_campus"),
        ("tsc", "tsc_2016"), ("tsc", "tsc_2017"), ("labc", "labc_bare1"),
        ("labc", "labc_furn"), ("labc", "labc_d3a"),
        ("officeb", "officeb_bare"), ("floors", "field/floor_4"),
        ("floors", "field/floor_6"))),
    between("willow", "willow_1", "willow_2"),
    between("fhw", "fhw_1", "fhw_2"),
    between("tsc", "tsc_2016", "tsc_2017"),
    between("labc", "labc_bare1", "labc_furn"),
    between("labc", "labc_bare1", "labc_d3a"),
    between("labc", "labc_furn", "labc_d3a"),
    between("floors", "field/floor_4", "field/floor_6"),
    strangers("intel", "intel_open_loop", "aces", "aces_open_loop"),
    strangers("intel", "intel_open_loop", "willow", "willow_1"),
    strangers("intel", "intel_open_loop", "fr079", "fr079"),
    strangers("aces", "aces_open_loop", "willow", "willow_2"),
    strangers("aces", "aces_open_loop", "bare_corner", "field/bare_corner"),
    strangers("aces", "aces_open_loop", "floors", "field/floor_4"),
    strangers("killian", "mit_killian_open_loop", "willow", "willow_1"),
    strangers("killian", "mit_killian_open_loop", "intel", "intel_open_loop"),
    strangers("killian", "mit_killian_open_loop", "aces", "aces_open_loop"),
    strangers("killian", "mit_killian_open_loop", "officeb", "officeb_bare"),
    strangers("killian", "mit_killian_open_loop", "belgioioso", "belgioioso"),
    strangers("fr079", "fr079", "orebro", "orebro"),
    strangers("tsc", "tsc_2016", "labc", "labc_bare1"),
    strangers("officeb", "officeb_bare", "labc", "labc_furn"),
    strangers("belgioioso", "belgioioso", "fhw", "fhw_1"),
]
# plan_seed, width, height [m], length of the drive [m].
SIMULATED = [(1, 40, 30, 400), (2, 60, 40, 700), (3, 35, 35, 400),
             (4, 80, 50, 900), (5, 50, 30, 600), (6, 45, 45, 600)]

ID_COLUMNS = ["reference_trajectory", "reference_index", "query_trajectory",
              "query_index"]
DIFFERENT = "different buildings"
# Log-odds from which on a match is accepted by default.
THRESHOLD = 4.
CALIBRATION_EDGES = [0., .01, .05, .2, .5, .8, .95, .99, .999, 1.]


def tell(text):
    print(text, file=sys.stderr, flush=True)


# --- Learning. ----------------------------------------------------------------


class Answers:
    """Answers of one data set: terms (n x k), right, wrong and to_positive
    (n, boolean)."""

    def __init__(self, name, building, query_building, names, terms, right,
                 wrong, to_positive, num_positives):
        self.name = name
        self.building = building
        self.query_building = query_building
        self.names = names
        self.terms = np.asarray(terms, dtype=float).reshape(-1, len(names))
        self.right = np.asarray(right, dtype=bool)
        self.wrong = np.asarray(wrong, dtype=bool)
        self.to_positive = np.asarray(to_positive, dtype=bool)
        self.num_positives = num_positives

    @property
    def group(self):
        return (self.building if self.building == self.query_building
                else DIFFERENT)

    def shows(self, building):
        return building in (self.building, self.query_building)


def fit(terms, right, sample_weights, penalty):
    """Weights (k) and bias of the logistic regression that minimises the
    weighted mean of the negative log-likelihood and penalty / 2 * |w|^2, w
    being the weights of the standardised terms; by Newton's method."""
    total = sample_weights.sum()
    mean = sample_weights @ terms / total
    deviation = np.sqrt(sample_weights @ (terms - mean) ** 2 / total)
    # A term that never changes says nothing.
    deviation[deviation < 1e-12] = np.inf
    x = np.column_stack([(terms - mean) / deviation, np.ones(len(terms))])
    y = right.astype(float)
    share = sample_weights / total
    hold = np.append(np.full(terms.shape[1], penalty), 1e-9)
    w = np.zeros(x.shape[1])

    def loss(v):
        z = x @ v
        return share @ (np.logaddexp(0., z) - y * z) + 0.5 * hold @ v ** 2

    for _ in range(200):
        p = probability(x @ w)
        gradient = x.T @ (share * (p - y)) + hold * w
        hessian = (x.T * (share * p * (1. - p))) @ x + np.diag(hold)
        step = np.linalg.solve(hessian, gradient)
        scale = 1.
        while scale > 1e-9 and loss(w - scale * step) > loss(w):
            scale *= 0.5
        w = w - scale * step
        if np.abs(scale * step).max() < 1e-10:
            break
    weights = w[:-1] / deviation
    return weights, w[-1] - weights @ mean


def probability(log_odds):
    return np.exp(-np.logaddexp(0., -log_odds))


def fit_sets(sets, penalty):
    """Of answers that are right or wrong; every group weighs the same."""
    terms, right, sample_weights = [], [], []
    judged = [answers.right | answers.wrong for answers in sets]
    counts = {}
    for answers, used in zip(sets, judged):
        counts[answers.group] = counts.get(answers.group, 0) + int(used.sum())
    for answers, used in zip(sets, judged):
        if not used.any():
            continue
        terms.append(answers.terms[used])
        right.append(answers.right[used])
        sample_weights.append(
            np.full(int(used.sum()), 1. / counts[answers.group]))
    if not terms:
        raise Failure("no answers to learn from")
    right = np.concatenate(right)
    if right.all() or not right.any():
        raise Failure("learning takes right answers and wrong ones")
    return fit(np.concatenate(terms), right, np.concatenate(sample_weights),
               penalty)


def quality(answers, scores):
    """Recall at precision 1 and 0.99, and how many wrong answers score above
    the threshold. As evaluate does it, but of equal scores the wrong ones come
    first."""
    order = np.lexsort((~answers.wrong, -scores))
    right = np.cumsum((answers.right & answers.to_positive)[order])
    wrong = np.cumsum(answers.wrong[order])
    precision = right / np.maximum(1, right + wrong)
    num_positives = max(1, answers.num_positives)
    at_1 = right[wrong == 0].max(initial=0) / num_positives
    at_99 = right[precision >= 0.99].max(initial=0) / num_positives
    return at_1, at_99, int((answers.wrong & (scores > THRESHOLD)).sum())


def calibration(predicted, right):
    """Rows (from, to, count, mean prediction, observed) of bins in use."""
    rows = []
    for low, high in zip(CALIBRATION_EDGES, CALIBRATION_EDGES[1:]):
        inside = (predicted >= low) & ((predicted < high) | (high == 1.))
        if inside.any():
            rows.append((low, high, int(inside.sum()), predicted[inside].mean(),
                         right[inside].mean()))
    return rows


# --- Report. ------------------------------------------------------------------


def reliability_plot(predicted, observed):
    """An SVG drawing: of what is predicted with some probability, how much is
    right. One line for each building, a thick one for all together."""
    size, margin = 400, 50

    def point(x, y):
        return f"{margin + x * size:.1f},{margin + (1. - y) * size:.1f}"

    def line(rows, style):
        points = " ".join(point(row[3], row[4]) for row in rows)
        return f'<polyline points="{points}" fill="none" {style}/>'
    side = size + 2 * margin
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {side} '
             f'{side}" font-family="sans-serif" font-size="13">',
             "<title>Reliability of the score, whole buildings left out"
             "</title>",
             f'<rect width="{side}" height="{side}" fill="white"/>',
             f'<rect x="{margin}" y="{margin}" width="{size}" height="{size}" '
             'fill="none" stroke="#888"/>',
             f'<line x1="{margin}" y1="{margin + size}" x2="{margin + size}" '
             f'y2="{margin}" stroke="#888" stroke-dasharray="4 4"/>']
    for tick in (0., 0.25, 0.5, 0.75, 1.):
        x, y = margin + tick * size, margin + (1. - tick) * size
        parts += [f'<text x="{x}" y="{margin + size + 18}" '
                  f'text-anchor="middle">{tick:g}</text>',
                  f'<text x="{margin - 8}" y="{y + 4}" text-anchor="end">'
                  f"{tick:g}</text>"]
    parts += [f'<text x="{side / 2}" y="{side - 10}" text-anchor="middle">'
              "predicted probability of being right</text>",
              f'<text transform="translate(16 {side / 2}) rotate(-90)" '
              'text-anchor="middle">fraction that is right</text>']
    for group in predicted:
        parts.append(line(calibration(predicted[group], observed[group]),
                          'stroke="#0072b2" stroke-opacity="0.35"'))
    rows = calibration(np.concatenate(list(predicted.values())),
                       np.concatenate(list(observed.values())))
    parts.append(line(rows, 'stroke="#d55e00" stroke-width="3"'))
    return "\n".join([*parts, "</svg>"]) + "\n"


def report(sets, penalty, plot=None):
    """Markdown: each building by the weights of the others, then all. With
    `plot`, also writes the reliability plot to that file."""
    names = sets[0].names
    lines = ["# Weights of the score", "",
             f"{len(sets)} data sets, {len(names)} terms, L2 penalty "
             f"{penalty:g} on standardised terms.", "",
             "## Left out one by one", "",
             "Weights are learned without any map of the building (of either "
             "building).", "",
             "| data set | answers | right | wrong | recall at precision 1 | "
             f"at .99 | wrong above {THRESHOLD:g} | right above {THRESHOLD:g} |",
             "| --- | --- | --- | --- | --- | --- | --- | --- |"]
    left_out = {}
    predicted, observed = {}, {}
    for answers in sets:
        key = frozenset((answers.building, answers.query_building))
        if key not in left_out:
            others = [other for other in sets
                      if not any(other.shows(building) for building in key)]
            try:
                left_out[key] = fit_sets(others, penalty)
            except Failure as failure:
                tell(f"without {', '.join(sorted(key))}: {failure}")
                left_out[key] = None
        if left_out[key] is None:
            continue
        weights, bias = left_out[key]
        scores = answers.terms @ weights + bias
        at_1, at_99, num_wrong = quality(answers, scores)
        recalls = (["-", "-"] if answers.group == DIFFERENT
                   else [f"{at_1:.3f}", f"{at_99:.3f}"])
        above = int((answers.right & (scores > THRESHOLD)).sum())
        lines.append("| " + " | ".join(
            [answers.name, str(len(scores)), str(int(answers.right.sum())),
             str(int(answers.wrong.sum())), *recalls, str(num_wrong),
             str(above)]) + " |")
        used = answers.right | answers.wrong
        predicted.setdefault(answers.group, []).append(
            probability(scores[used]))
        observed.setdefault(answers.group, []).append(answers.right[used])
    lines += ["", "## Calibration", "",
              "Of the left-out buildings: answers whose predicted probability "
              "lies in a range, and how many of them are right.", "",
              "| building | predicted | answers | mean predicted | observed |",
              "| --- | --- | --- | --- | --- |"]
    predicted = {group: np.concatenate(values)
                 for group, values in predicted.items()}
    observed = {group: np.concatenate(values)
                for group, values in observed.items()}
    if plot:
        plot.write_text(reliability_plot(predicted, observed),
                        encoding="utf-8")
    everything = {"all": (np.concatenate(list(predicted.values())),
                          np.concatenate(list(observed.values())))}
    for group, (guesses, truth) in {
            **everything,
            **{name: (predicted[name], observed[name])
               for name in predicted}}.items():
        for low, high, count, mean, fraction in calibration(guesses, truth):
            lines.append(f"| {group} | {low:g} to {high:g} | {count} | "
                         f"{mean:.4f} | {fraction:.4f} |")
    weights, bias = fit_sets(sets, penalty)
    lines += ["", "## Learned on all", "",
              "| data set | recall at precision 1 | at .99 | "
              f"wrong above {THRESHOLD:g} |",
              "| --- | --- | --- | --- |"]
    for answers in sets:
        at_1, at_99, num_wrong = quality(answers,
                                         answers.terms @ weights + bias)
        recalls = (["-", "-"] if answers.group == DIFFERENT
                   else [f"{at_1:.3f}", f"{at_99:.3f}"])
        lines.append(f"| {answers.name} | {recalls[0]} | {recalls[1]} | "
                     f"{num_wrong} |")
    lines += ["", "```lua",
              f"{'weights' if 'pair_score' in names else 'score_weights'} = {{"]
    lines += [f"  {name} = {format_lua(weight)},"
              for name, weight in zip([*names, "bias"], [*weights, bias])]
    lines += ["},", "```"]
    return "\n".join(lines) + "\n"


def format_lua(number):
    """Three digits, and a point."""
    text = f"{float(f'{number:.3g}'):.6f}".rstrip("0")
    return "0." if text == "-0." else text


# --- Files. -------------------------------------------------------------------


def read_csv(path):
    with open(path, newline="", encoding="utf-8") as file:
        reader = csv.DictReader(file)
        rows = list(reader)
        return reader.fieldnames or [], rows


def ids_of(row):
    return tuple(int(row[column]) for column in ID_COLUMNS)


def read_answers(name, building, query_building, terms_path, labels_path,
                 num_positives):
    """Without labels every answer is wrong."""
    columns, rows = read_csv(terms_path)
    names = [c for c in columns if c not in [*ID_COLUMNS, "score"]]
    labels = None
    if labels_path is not None:
        labels = {ids_of(row): row for row in read_csv(labels_path)[1]}
    terms, right, wrong, to_positive = [], [], [], []
    for row in rows:
        label = {"verdict": "wrong", "positive": "0"}
        if labels is not None:
            # Pairs that share scans or have no truth have no label.
            label = labels.get(ids_of(row))
            if label is None:
                continue
        terms.append([float(row[n]) for n in names])
        right.append(label["verdict"] == "right")
        wrong.append(label["verdict"] == "wrong")
        to_positive.append(label["positive"] == "1")
    return Answers(name, building, query_building, names, terms, right, wrong,
                   to_positive, num_positives)


def read_set_list(path):
    columns, rows = read_csv(path)
    for column in ("building", "map", "truth"):
        if column not in columns:
            raise Failure(f'{path} has no column "{column}"')
    sets = []
    for row in rows:
        get = lambda column, row=row: (row.get(column) or "").strip()
        sets.append(tuple(get(c) for c in (
            "building", "map", "truth", "query_building", "query",
            "query_truth")))
    return sets


# --- The program. -------------------------------------------------------------

# All neighbours of all matches: what is refused at once teaches, too.
CONFIGURATION = """include "sdf_global_constraints.lua"
SDF_GLOBAL_CONSTRAINTS.loop_closing.recognition.neighbourhood.min_promising_score = -1e6
return SDF_GLOBAL_CONSTRAINTS
"""
# Few wrong answers lie near right ones: a weaker penalty follows single ones.
NEIGHBOURS_PENALTY = 1e-3
PENALTY = 1e-4


class Workshop:
    """Runs the program and keeps what it made in a folder, by the content of
    the program and its options. Both are copied there first: a long run does
    not mind that they are worked on."""

    def __init__(self, program, work, threads, neighbours=False):
        self.work = work
        self.threads = threads
        self.neighbours = neighbours
        check_program(program)
        options = {
            name: (SOURCE_DIR / "configuration_files" / name).read_bytes()
            for name in ("sdf_global_constraints.lua",
                         "sdf_advanced_options.lua")}
        digest = hashlib.sha256(program.read_bytes())
        for content in options.values():
            digest.update(content)
        digest.update(CONFIGURATION.encode())
        self.folder = (work / digest.hexdigest()[:12]).resolve()
        self.folder.mkdir(parents=True, exist_ok=True)
        self.program = self.folder / "cartographer_sdf"
        if not self.program.exists():
            shutil.copy2(program, self.program)
        for name, content in options.items():
            (self.folder / name).write_bytes(content)
        (self.folder / "learn.lua").write_text(CONFIGURATION,
                                               encoding="utf-8")

    def run(self, *arguments):
        result = subprocess.run([str(self.program), *map(str, arguments)],
                                stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE, text=True, check=False)
        if result.returncode != 0:
            raise Failure(result.stderr.strip() or
                          f"{self.program} {arguments[0]} failed")

    def simulate(self, plan_seed, width, height, length):
        """A building, driven through twice; (map, truth) of either."""
        sessions = []
        for seed in (plan_seed, plan_seed + 1000):
            name = f"simulated_{plan_seed}_{width}x{height}_{length}_{seed}"
            paths = (self.work / f"{name}.pbstream", self.work / f"{name}.csv")
            if not all(path.exists() for path in paths):
                tell(f"simulate {name}")
                self.run("simulate", "--output", paths[0], "--truth", paths[1],
                         "--plan_seed", plan_seed, "--plan_width", width,
                         "--plan_height", height, "--length", length,
                         "--seed", seed)
            sessions.append(paths)
        return sessions

    def answers(self, name, building, map_path, truth, query_building,
                query=None, query_truth=None):
        different = building != query_building
        stamp = hashlib.sha256()
        for path in (map_path, truth, query, query_truth):
            if path:
                stat = os.stat(path)
                stamp.update(f"{os.path.abspath(path)},{stat.st_size},"
                             f"{stat.st_mtime_ns};".encode())
        base = self.folder / stamp.hexdigest()[:16]
        terms, labels, numbers, matches = (
            pathlib.Path(f"{base}.{kind}.csv")
            for kind in ("neighbour_terms" if self.neighbours else "terms",
                         "labels", "numbers", "matches"))
        between = ["--query", query] if query else []
        if not (terms.exists() and matches.exists()):
            tell(f"match {name}")
            self.run("match", "--input", map_path, *between,
                     "--output", matches,
                     "--neighbour_terms" if self.neighbours else "--terms",
                     terms, "--threads", self.threads,
                     "--configuration_directory", self.folder,
                     "--configuration_basename", "learn.lua")
        num_positives = 0
        if not different:
            if not (labels.exists() and numbers.exists()):
                if query:
                    between += ["--query_truth", query_truth]
                self.run("evaluate", "--input", map_path, "--truth", truth,
                         *between, "--matches", matches, "--labels", labels,
                         "--csv", numbers)
            num_positives = int(float(next(
                row["value"] for row in read_csv(numbers)[1]
                if row["subject"] == "matches" and
                row["quantity"] == "positives")))
        return read_answers(name, building, query_building, terms,
                            None if different else labels, num_positives)


def make_answers(workshop, sets, directory):
    """Of the sets that are there."""
    for line in sets:
        building, map_name, truth_name, query_building, query, query_truth = (
            *line, *[""] * (6 - len(line)))
        query_building = query_building or building
        different = query_building != building
        paths = [directory / p if p else None
                 for p in (map_name, truth_name, query, query_truth)]
        needed = [paths[0], paths[2]] if different else paths
        name = pathlib.Path(map_name).stem
        if query:
            name = f"{pathlib.Path(query).stem} in {name}"
        if (different and not query) or (not different and not truth_name) or (
                not different and query and not query_truth):
            raise Failure(f"{name}: a map or a truth is not named")
        missing = [str(p) for p in needed if p and not p.exists()]
        if missing:
            tell(f"skip {name}: {', '.join(missing)} is missing")
            continue
        yield workshop.answers(name, building, paths[0],
                               None if different else paths[1], query_building,
                               paths[2], None if different else paths[3])


def make_simulated_answers(workshop, count):
    first_maps = []
    for plan_seed, width, height, length in SIMULATED[:count]:
        building = f"simulated_{plan_seed}"
        (a, a_truth), (b, b_truth) = workshop.simulate(plan_seed, width, height,
                                                       length)
        first_maps.append((building, a))
        yield workshop.answers(building, building, a, a_truth, building)
        yield workshop.answers(f"second in first of {building}", building, a,
                               a_truth, building, b, b_truth)
    for (building, a), (other, b) in zip(first_maps, first_maps[1:]):
        yield workshop.answers(f"{other} in {building}", building, a, None,
                               other, b)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--data", type=pathlib.Path,
                        default=DATA_DIR, help="where the real maps are")
    parser.add_argument("--sets", type=pathlib.Path, help="a list of more")
    parser.add_argument("--simulated", type=int, default=len(SIMULATED),
                        help="how many simulated buildings, at most "
                             f"{len(SIMULATED)}")
    parser.add_argument("--work", type=pathlib.Path,
                        help="keeps matches and simulated maps here and goes "
                             "on with them")
    parser.add_argument("--program", type=pathlib.Path,
                        default=PROGRAM)
    parser.add_argument("--threads", type=int, default=0,
                        help="0: as many as there are cores")
    parser.add_argument("--neighbours", action="store_true",
                        help="learn the score in the neighbourhood")
    parser.add_argument("--plot", type=pathlib.Path,
                        help="SVG file to draw the reliability to")
    parser.add_argument("--penalty", type=float,
                        help="of the L2 regularisation; by default "
                             f"{PENALTY:g}, with --neighbours "
                             f"{NEIGHBOURS_PENALTY:g}")
    arguments = parser.parse_args()
    if arguments.penalty is None:
        arguments.penalty = (NEIGHBOURS_PENALTY if arguments.neighbours
                             else PENALTY)
    if not arguments.penalty > 0.:
        parser.error("--penalty must be positive")
    if not 0 <= arguments.simulated <= len(SIMULATED):
        parser.error(f"--simulated must lie between 0 and {len(SIMULATED)}")
    with tempfile.TemporaryDirectory() as temporary:
        work = arguments.work or pathlib.Path(temporary)
        try:
            workshop = Workshop(arguments.program.resolve(), work,
                                arguments.threads, arguments.neighbours)
            sets = list(make_answers(workshop, REAL_SETS, arguments.data))
            if arguments.sets:
                sets += make_answers(workshop, read_set_list(arguments.sets),
                                     arguments.sets.parent)
            sets += make_simulated_answers(workshop, arguments.simulated)
            if not sets:
                raise Failure("there is not one data set")
            print(report(sets, arguments.penalty, arguments.plot), end="")
        except (Failure, OSError, ValueError, KeyError,
                StopIteration) as failure:
            tell(f"learn_score.py: {failure}")
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
