// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What changed between a map and a query that was localised in it: walls of
// the one in the free space of the other, where the two agree in the rest.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_CHANGES_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_CHANGES_H_

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/grid/pair_pose.h"
#include "cartographer_sdf/localization/confirmation.h"

namespace cartographer_sdf {

enum class ChangeKind {
  kAppeared,  // the query has a wall where the map is free
  kVanished,  // the map has a wall where the query is free
};
// "appeared", "vanished".
[[nodiscard]] const char* ChangeKindName(ChangeKind kind);

struct Change {
  ChangeKind kind;
  Eigen::AlignedBox2d box;  // map frame [m]
  // Outline of what changed, as cells of 0.1 m [m^2]: less than the box.
  double wall_area = 0.;
};

// Compares the pairs of submaps that agree, each at its own pose, so that drift
// of either map does not count. A change is a connected piece of wall of 0.3 m
// at least that more pairs see changed than unchanged. The largest first; at
// most 1000.
[[nodiscard]] std::vector<Change> FindChanges(
    const PlacedMap& map, const PlacedMap& query,
    const std::vector<PairPose>& agreeing, const Executor& executor);

// Area of the boxes together, overlaps once [m^2].
[[nodiscard]] double ChangedArea(const std::vector<Change>& changes);

// Returns a clause for people: how much has appeared and vanished, and what is
// largest; "nothing has changed" if there are no changes.
[[nodiscard]] std::string DescribeChanges(const std::vector<Change>& changes);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_CHANGES_H_
