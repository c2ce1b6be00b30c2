#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of README.md, or the paper's figures of any map.

usage: make_figures.py [PROGRAM, default build/cartographer_sdf]
       make_figures.py --paper MAP.pbstream TRUTH.csv OUTPUT_DIRECTORY
                       [QUERY.pbstream QUERY_TRUTH.csv] [--program PROGRAM]

The first simulates a map, closes its loops, and takes the two maps out of the
report: docs/images/before.png and after.png. The second draws, after the
figures of Millane et al. 2019: a probability grid beside its distance field
(Fig. 2), the field as a surface with keypoints by class (Fig. 3), a feature with
its window of weighted gradients and its histogram (Fig. 4), precision and recall
(Fig. 5 and 7), masks (Fig. 6), and a match within the map and of the query in
the map (Fig. 1 and 8).
"""

import argparse
import base64
import collections
import pathlib
import re
import shutil
import subprocess
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parent.parent
PICTURE_PIXELS = 700


# What `figures` draws of a submap, and what it shows.
SUBMAP_FIGURES = (
    ("grid.png", "A submap as a probability grid"),
    ("field.png", "The signed distance field: blue is far from walls, "
     "contours are half a metre apart"),
    ("keypoints.png", "Keypoints by class: maxima red, saddles green, minima "
     "yellow"),
    ("surface.png", "The field as a surface, with its keypoints"),
    ("feature_location.png", "Where a feature lies"),
    ("feature_window.png", "A feature's window: weighted gradients and their "
     "dominant direction (red)"),
    ("feature_histogram.svg", "The descriptor of that feature"),
    ("mask_2.0m.png", "Where features may lie within 2 m of walls"),
    ("mask_1.5m.png", "within 1.5 m"),
    ("mask_1.0m.png", "within 1 m"),
    ("mask_0.5m.png", "and within 0.5 m"),
)

Session = collections.namedtuple("Session", "name path truth")


def paper_figures(run, work, directory, maps, sessions, matches, chosen):
    """Draws by `run`, which takes the program's arguments. `matches` are tables
    of `match` by the name of the map (or "QUERY_in_MAP") and the method; the map
    called `chosen` is drawn. Returns file names with captions."""
    figures = []
    for evaluated in maps:
        if evaluated.name != chosen:
            continue
        drawn = work / f"{evaluated.name}.figures"
        run("figures", "--input", evaluated.path, "--method", "sdf",
            "--matches", matches[evaluated.name]["sdf"], "--output", drawn)
        for name, caption in (*SUBMAP_FIGURES, (
                "match_map.png", "A match of the end of the drive (red) with an "
                "earlier submap (blue), where the open map has them")):
            target = f"{evaluated.name}.{name}"
            shutil.copy(drawn / name, directory / target)
            figures.append((target, f"{evaluated.name}: {caption}"))
    for query, reference in sessions:
        name = f"{query.name}_in_{reference.name}"
        drawn = work / f"{name}.figures"
        run("figures", "--input", reference.path, "--query", query.path,
            "--method", "sdf", "--matches", matches[name]["sdf"], "--output",
            drawn)
        target = f"{name}.match_map.png"
        shutil.copy(drawn / "match_map.png", directory / target)
        figures.append((target, f"{query.name} (red) in the map of "
                        f"{reference.name} (blue), put there by the match "
                        "that is drawn"))
    return figures


def draw_paper(arguments):
    program = str(arguments.program)

    def run(*words):
        subprocess.run([program, *map(str, words)], check=True,
                       stdout=subprocess.DEVNULL)

    map_path, truth, output, *query = arguments.paper
    output = pathlib.Path(output)
    output.mkdir(parents=True, exist_ok=True)
    evaluated = Session("map", map_path, truth)
    sessions = []
    matches = {}
    with tempfile.TemporaryDirectory() as work:
        matches["map"] = {"sdf": f"{work}/matches.csv"}
        run("match", "--input", map_path, "--output", matches["map"]["sdf"])
        if query:
            sessions = [(Session("query", *query), evaluated)]
            matches["query_in_map"] = {"sdf": f"{work}/localised.csv"}
            run("match", "--input", map_path, "--query", query[0], "--output",
                matches["query_in_map"]["sdf"])
        figures = paper_figures(run, pathlib.Path(work), output, [evaluated],
                                sessions, matches, "map")
    run("evaluate", "--input", map_path, "--truth", truth, "--random_pairs",
        1000, "--max_clearances", "2.0,1.5,1.0,0.5", "--plot",
        output / "precision_recall.svg", "--free_space_plot",
        output / "free_space.svg")
    figures += [("precision_recall.svg", ""), ("free_space.svg", "")]
    for name, _ in figures:
        print(output / name)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("readme_program", nargs="?", metavar="PROGRAM")
    parser.add_argument("--program", default=SOURCE / "build" / "cartographer_sdf")
    parser.add_argument("--paper", nargs="+", metavar="FILE")
    arguments = parser.parse_args()
    if arguments.paper:
        if len(arguments.paper) not in (3, 5):
            parser.error("--paper takes three files, or five")
        draw_paper(arguments)
        return
    program = arguments.readme_program or str(arguments.program)
    with tempfile.TemporaryDirectory() as directory:
        work = pathlib.Path(directory)
        (work / "figures.lua").write_text(
            'include "sdf_global_constraints.lua"\n'
            f"SDF_GLOBAL_CONSTRAINTS.report.map_picture_pixels = {PICTURE_PIXELS}\n"
            "return SDF_GLOBAL_CONSTRAINTS\n")
        for arguments in (
                ["simulate", "--output", f"{work}/open_loop.pbstream", "--truth", f"{work}/truth.csv"],
                ["close_loops", "--input", f"{work}/open_loop.pbstream", "--output",
                 f"{work}/closed.pbstream", "--report", f"{work}/report",
                 "--configuration_directory", str(work),
                 "--configuration_basename", "figures.lua"]):
            subprocess.run([program, *arguments], check=True, stdout=subprocess.DEVNULL)
        page = (work / "report" / "index.html").read_text()
    pictures = re.findall(r"data:image/png;base64,([A-Za-z0-9+/=]+)", page)
    images = SOURCE / "docs" / "images"
    images.mkdir(parents=True, exist_ok=True)
    for name, picture in zip(("before", "after"), pictures):
        (images / f"{name}.png").write_bytes(base64.b64decode(picture))
        print(images / f"{name}.png")


if __name__ == "__main__":
    main()
