// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Errors of a map: of its nodes against their true poses, and of pairs of nodes
// against manually verified relations.

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

// Statistics of absolute errors, in their unit. Quantiles are interpolated
// linearly between the sorted values; the smallest is quantile 0, the largest
// quantile 1.
struct ErrorStatistics {
  int count = 0;
  double mean = 0.;
  double median = 0.;
  double percentile_90 = 0.;
  double max = 0.;
};

// None if there are no errors.
[[nodiscard]] std::optional<ErrorStatistics> Summarize(
    std::vector<double> errors);

// Error of a pose [m], [rad].
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

// Pose of the robot (map <- tracking frame). With IMU or odometry, the node
// frame of the pose graph differs from the tracking frame by an arbitrary yaw.
[[nodiscard]] Rigid2 TrackingPose(const Node& node);

// Absolute errors of the tracking frame at the nodes after a rigid alignment of
// their positions with the true ones (least squares).
struct TrajectoryError {
  Rigid2 T_world_map;
  PoseErrorStatistics errors;
  // Nodes of the map without a true pose.
  int num_skipped = 0;
};

// None if the common nodes do not determine the alignment: fewer than two, or
// all at one place.
[[nodiscard]] std::optional<TrajectoryError> EvaluateTrajectory(
    const PoseGraph& pose_graph, const Truth& truth);

// How a drive by local SLAM compares with the true one, stretch by stretch: by
// its nodes, or by its submaps if the truth has no nodes.
struct DriveComparison {
  int num_stretches = 0;
  // Whose ends lie elsewhere, by more than local SLAM drifts within one.
  int num_different = 0;
};
[[nodiscard]] DriveComparison CompareDrives(const PoseGraph& pose_graph,
                                            const Truth& truth);

// Returns an error if the truth is that of another map: if most stretches
// differ. `map_name` and `truth_name` are for its message.
[[nodiscard]] absl::Status CheckIsTruthOf(const std::string& map_name,
                                          const PoseGraph& pose_graph,
                                          const std::string& truth_name,
                                          const Truth& truth);

// Pose of one scan relative to another [Kuemmerle2009]. Unlike poses in a world
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

// Lines of i, j, x, y, theta, t1, t2 [m, rad, s] and possibly more fields,
// separated by white space; # starts a comment.
[[nodiscard]] absl::StatusOr<std::vector<Relation>> ReadRelations(
    const std::string& path);

struct RelationErrors {
  // None if no relation lies within the map's time.
  std::optional<PoseErrorStatistics> all;
  // Relations of scans recorded more than 30 s apart.
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
