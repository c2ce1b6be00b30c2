#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of the documentation, or the paper's figures of any map.

usage: make_figures.py [PROGRAM, default build/cartographer_sdf]
       make_figures.py --data DIRECTORY [--program PROGRAM]
       make_figures.py --paper MAP.pbstream TRUTH.csv OUTPUT_DIRECTORY
                       [QUERY.pbstream QUERY_TRUTH.csv] [--program PROGRAM]

The first simulates maps and draws demo.png, two_sessions.png and
symptom_wrong.png of docs/images. The second draws those of real maps:
killian.png, symptom_twice.png and symptom_torn.png. The third draws, after the figures of Millane et al. 2019: a
probability grid beside its distance field (Fig. 2), the field as a surface with
keypoints by class (Fig. 3), a feature with its window of weighted gradients and
its histogram (Fig. 4), precision and recall (Fig. 5 and 7), masks (Fig. 6), and
a match within the map and of the query in the map (Fig. 1 and 8).
"""

import argparse
import collections
import pathlib
import shutil
import subprocess
import tempfile

import draw_maps

SOURCE = pathlib.Path(__file__).resolve().parent.parent
IMAGES = SOURCE / "docs" / "images"


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


class MapDrawer:
    """Runs the program in a folder and draws maps beside each other."""

    def __init__(self, program, folder):
        self.program = str(program)
        self.folder = pathlib.Path(folder)

    def run(self, *words):
        subprocess.run([self.program, *map(str, words)], check=True, cwd=self.folder, stdout=subprocess.DEVNULL)

    def draw(self, picture, maps, pixel, bar, window=None):
        for path in maps:
            self.run("export", path, "--map_filestem", pathlib.Path(path).stem)
        yamls = [self.folder / f"{pathlib.Path(path).stem}.yaml" for path in maps]
        (IMAGES / picture).write_bytes(draw_maps.draw(yamls, pixel, window, bar))
        print(IMAGES / picture)


def draw_simulated(drawer):
    drawer.run("simulate", "-o", "monday.pbstream", "--truth", "monday.csv")
    drawer.run("simulate", "-o", "tuesday.pbstream", "--truth", "tuesday.csv", "--seed", 2, "--length", 150)
    drawer.run("close_loops", "monday.pbstream", "-o", "monday_closed.pbstream")
    drawer.run("merge", "monday_closed.pbstream", "tuesday.pbstream", "-o", "merged.pbstream")
    drawer.draw("demo.png", ("monday.pbstream", "monday_closed.pbstream"), 0.1, 5)
    drawer.draw("two_sessions.png", ("monday_closed.pbstream", "tuesday.pbstream", "merged.pbstream"), 0.15, 5)
    drawer.run("falsify", "monday.pbstream", "-o", "spoilt.pbstream", "--wrong_constraints", "wrong.csv",
               "--kinds", "random", "--pairs", 1, "--seed", 3)
    drawer.run("close_loops", "spoilt.pbstream", "-o", "closed.pbstream")
    drawer.run("audit", "closed.pbstream", "-o", "mended.pbstream")
    drawer.draw("symptom_wrong.png", ("spoilt.pbstream", "mended.pbstream"), 0.1, 5)


def draw_real(drawer, data):
    killian = data / "mit_killian_open_loop.pbstream"
    drawer.run("close_loops", killian, "-o", "closed.pbstream")
    drawer.draw("killian.png", (killian, "closed.pbstream"), 0.5, 50)
    drawer.draw("symptom_twice.png", (killian, "closed.pbstream"), 0.2, 10, (-110, -20, 20, 90))
    drawer.run("figures", data / "fr079.pbstream", "--submap", "0,20", "-o", "torn")
    shutil.copy(drawer.folder / "torn" / "grid.png", IMAGES / "symptom_torn.png")
    print(IMAGES / "symptom_torn.png")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("drawing_program", nargs="?", metavar="PROGRAM")
    parser.add_argument("--program", default=SOURCE / "build" / "cartographer_sdf")
    parser.add_argument("--data", type=pathlib.Path, metavar="DIRECTORY")
    parser.add_argument("--paper", nargs="+", metavar="FILE")
    arguments = parser.parse_args()
    if arguments.paper:
        if len(arguments.paper) not in (3, 5):
            parser.error("--paper takes three files, or five")
        draw_paper(arguments)
        return
    IMAGES.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        drawer = MapDrawer(pathlib.Path(arguments.drawing_program or arguments.program).resolve(), folder)
        if arguments.data:
            draw_real(drawer, arguments.data.resolve())
        else:
            draw_simulated(drawer)


if __name__ == "__main__":
    main()
