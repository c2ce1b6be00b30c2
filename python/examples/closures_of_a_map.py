#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

"""From a map to a matched pair of submaps, step by step, with a picture.

usage: closures_of_a_map.py MAP.pbstream PICTURE.png [TRUTH.csv]

Needs python3-matplotlib. Without a map: `cartographer_sdf simulate` makes one.
"""

import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

import cartographer_sdf as sdf  # noqa: E402

COLORS = {"maximum": "red", "minimum": "gold", "saddle": "limegreen"}


def extent_of(array, resolution):
    return 0, array.shape[0] * resolution, 0, array.shape[1] * resolution


def draw_field(axes, field, place):
    """The distance field with the keypoints of a place, in the grid frame."""
    distance = np.where(field.observed, field.distance, np.nan)
    axes.imshow(distance.T, origin="lower", cmap="viridis",
                extent=extent_of(distance, field.resolution))
    positions = field.T_submap_grid.inverse().apply(place.positions)
    axes.scatter(*positions.T, s=14, c=[COLORS[kind] for kind in place.kinds], edgecolors="black",
                 linewidths=0.4)
    axes.set_title(f"Submap {place.id.trajectory},{place.id.index}: "
                   f"distance to walls, {len(place)} features")


def walls_of(grid):
    """Centres of occupied cells in the submap frame."""
    cells = np.argwhere(grid.known & (grid.probability > 0.5))
    return grid.T_submap_grid.apply((cells + 0.5) * grid.resolution)


def draw_pair(axes, reference, query, match):
    axes.plot(*walls_of(reference).T, ".", markersize=1, color="tab:blue", label="reference")
    axes.plot(*match.T_reference_query.apply(walls_of(query)).T, ".", markersize=1,
              color="tab:red", label="query")
    axes.plot(*match.inliers[:, :2].T, "k+", label=f"{len(match.inliers)} features that agree")
    axes.set_aspect("equal")
    axes.legend(loc="lower right", fontsize=7)
    axes.set_title(f"{tuple(match.reference)} and {tuple(match.query)}: score {match.score:.1f}")


def draw_paths(axes, before, after):
    for poses, color, label in ((before, "0.6", "before"), (after, "tab:blue", "after")):
        axes.plot(poses[:, 0], poses[:, 1], color=color, linewidth=0.8, label=label)
    axes.set_aspect("equal")
    axes.legend(loc="lower right", fontsize=7)
    axes.set_title("Submaps before and after closing loops")


def main(map_path, picture, truth=None):
    world = sdf.read_map(map_path)
    matches = sdf.recognize(sdf.describe_map(map_path))
    accepted = sorted((m for m in matches if m.accepted), key=lambda m: -m.score)
    print(f"{len(world.submaps)} submaps, {len(matches)} matches, {len(accepted)} accepted")
    if truth:
        print(f"recall {sdf.score_matches(matches, world, truth)['accepted_recall']:.3f}")
    if not accepted:
        sys.exit("no match was accepted")
    best = accepted[0]
    grid = world.grid(best.reference)
    closed = sdf.close_loops(map_path)
    figure, axes = plt.subplots(1, 3, figsize=(16, 5), constrained_layout=True)
    draw_field(axes[0], sdf.distance_field(grid), sdf.describe(grid, best.reference))
    draw_pair(axes[1], grid, world.grid(best.query), best)
    draw_paths(axes[2], *(np.array([tuple(pose) for _, pose in sorted(poses.items())])
                          for poses in (world.submaps, closed.submaps)))
    figure.savefig(picture, dpi=90)
    print(picture)


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    main(*sys.argv[1:])
