// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Errors of a map: of its nodes against their true poses, and of pairs of nodes
// against relations that were verified by hand.

#ifndef CARTOGRAPHER_SDF_EVALUATION_MAP_ERRORS_H_
#define CARTOGRAPHER_SDF_EVALUATION_MAP_ERRORS_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/simulation/truth.h"

namespace cartographer_sdf {

// Of absolute errors, in their unit. Quantiles are interpolated linearly
// between the sorted values, the smallest being that of 0 and the largest that
// of 1.
struct ErrorStatistics {
  int count = 0;
  double mean = 0.;
  double median = 0.;
  double percentile_90 = 0.;
  double max = 0.;
};

// None of no errors.
[[nodiscard]] std::optional<ErrorStatistics> Summarize(
    std::vector<double> errors);

// Of poses: [m] and [rad].
struct PoseError {
  double translation = 0.;
  double rotation = 0.;
};
struct PoseErrorStatistics {
  ErrorStatistics translation;
  ErrorStatistics rotation;
};
[[nodiscard]] std::optional<PoseErrorStatistics> SummarizePoses(
    const std::vector<PoseError>& errors);

// Where the robot was and looked (map <- tracking frame): with IMU or odometry,
// the node frame of the pose graph is turned against it by any yaw.
[[nodiscard]] Rigid2 TrackingPose(const Node& node);

// Absolute errors of the tracking frame at the nodes after the rigid motion
// that brings their positions nearest to the true ones (least squares).
struct TrajectoryError {
  Rigid2 T_world_map;
  PoseErrorStatistics errors;
  // Nodes of the map that the truth does not know.
  int num_skipped = 0;
};

// None where the nodes in common do not determine the motion: fewer than two,
// or all at one place.
[[nodiscard]] std::optional<TrajectoryError> EvaluateTrajectory(
    const PoseGraph& pose_graph, const Truth& truth);

// Where one scan was seen from another [Kuemmerle2009]: unlike poses in a world
// frame, relations do not spread an error at one place over the whole map.
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

#endif  // CARTOGRAPHER_SDF_EVALUATION_MAP_ERRORS_H_
