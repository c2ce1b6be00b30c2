// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Errors of a map against relations that were verified by hand [Kuemmerle2009]:
// where one scan was seen from another. Unlike poses in a world frame, they do
// not spread an error at one place over the whole map.

#ifndef CARTOGRAPHER_SDF_EVALUATION_RELATIONS_H_
#define CARTOGRAPHER_SDF_EVALUATION_RELATIONS_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/evaluation/error_statistics.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

struct Relation {
  // Indices of scans; fractions are allowed.
  double first_scan = 0.;
  double second_scan = 0.;
  Rigid2 T_first_second;
  // When the scans were recorded [s], by the recording's clock.
  double first_time = 0.;
  double second_time = 0.;
};

// Lines of i, j, x, y, theta, t1, t2 [m, rad, s] and possibly more, apart by
// white space; what follows a # is ignored.
[[nodiscard]] absl::StatusOr<std::vector<Relation>> ReadRelations(
    const std::string& path);

struct RelationErrors {
  // None where no relation lies within the map's time.
  std::optional<PoseErrorStatistics> all;
  // Of those whose scans were recorded more than 30 s apart.
  std::optional<PoseErrorStatistics> loops;
  // Relations of scans more than 1 s before or after all nodes.
  int num_skipped = 0;
};

// Scan i is stamped 1e9 + i * seconds_per_scan in the map [s, Unix time];
// poses of the tracking frame are interpolated linearly at that time.
[[nodiscard]] RelationErrors EvaluateRelations(
    const PoseGraph& pose_graph, const std::vector<Relation>& relations,
    double seconds_per_scan);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_RELATIONS_H_
