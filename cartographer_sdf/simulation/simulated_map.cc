// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/simulated_map.h"

#include <cmath>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/geometry/number_range.h"
#include "cartographer_sdf/grid/scan_grid.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/simulation/random_numbers.h"

namespace cartographer_sdf {
namespace {

// 2001-09-09 01:46:40 UTC, a billion seconds after 1970.
constexpr int64_t kStartTime =
    kUnixEpochTicks + 1'000'000'000LL * kTicksPerSecond;

// A scan becomes a node when the robot has moved or turned this much since the
// last one [m, rad].
constexpr double kNodeDistance = 0.2;
constexpr double kNodeRotation = 10. * M_PI / 180.;
// Side of the squares from which a node keeps one point each [m].
constexpr double kVoxelSize = 0.05;

int64_t ToTicks(const double seconds) {
  return kStartTime +
         static_cast<int64_t>(std::llround(seconds * kTicksPerSecond));
}

// Indices of the poses whose scans become nodes.
std::vector<size_t> FilterMotion(const std::vector<DrivenPose>& drive) {
  std::vector<size_t> kept = {0};
  for (size_t k = 1; k < drive.size(); ++k) {
    const Rigid2 T_last_robot =
        drive[kept.back()].T_world_robot.Inverse() * drive[k].T_world_robot;
    // Rounding must not decide when steps add up exactly to the distance.
    if (T_last_robot.translation().norm() > kNodeDistance - 1e-6 ||
        std::abs(T_last_robot.rotation()) > kNodeRotation - 1e-6) {
      kept.push_back(k);
    }
  }
  return kept;
}

// The first point of each voxel.
PointCloud2 FilterVoxels(const std::vector<Eigen::Vector2f>& points) {
  std::set<std::pair<int, int>> voxels;
  PointCloud2 filtered;
  for (const Eigen::Vector2f& point : points) {
    const Eigen::Array2i voxel =
        (point.cast<double>().array() / kVoxelSize).floor().cast<int>();
    if (voxels.insert({voxel.x(), voxel.y()}).second) filtered.push_back(point);
  }
  return filtered;
}

SimulatedSubmap MakeSubmap(const std::vector<SimulatedNode>& nodes,
                           const std::vector<Scan>& scans, const int first_node,
                           const int end_node) {
  SimulatedSubmap submap;
  submap.first_node = first_node;
  submap.end_node = end_node;
  const SimulatedNode& first = nodes[first_node];
  submap.T_local_submap = Rigid2(first.T_local_node.translation(), 0.);
  const Rigid2 T_submap_local = submap.T_local_submap.Inverse();
  submap.T_world_submap =
      first.T_world_node * (T_submap_local * first.T_local_node).Inverse();
  ScanGrid grid((ScanGridOptions()));
  for (int k = first_node; k != end_node; ++k) {
    grid.Insert(T_submap_local * nodes[k].T_local_node, scans[k]);
  }
  submap.grid = grid.Crop();
  return submap;
}

// Each submap takes the nodes of two intervals and shares each with another
// submap.
std::vector<SimulatedSubmap> MakeSubmaps(
    const std::vector<SimulatedNode>& nodes, const std::vector<Scan>& scans,
    const int interval, const ProgressCallback& on_progress) {
  const int num_submaps = static_cast<int>(nodes.size()) / interval - 1;
  std::vector<SimulatedSubmap> submaps;
  for (int k = 0; k != num_submaps; ++k) {
    submaps.push_back(
        MakeSubmap(nodes, scans, k * interval, (k + 2) * interval));
    if (on_progress) on_progress(0.5 + 0.5 * (k + 1.) / num_submaps);
  }
  return submaps;
}

// As FilterMotion, without nodes at the end that do not fill a submap.
absl::StatusOr<std::vector<size_t>> ChooseNodes(
    const std::vector<DrivenPose>& drive, const int num_range_data) {
  std::vector<size_t> kept = FilterMotion(drive);
  const int num_submaps = static_cast<int>(kept.size()) / num_range_data - 1;
  if (num_submaps < 1) {
    return absl::InvalidArgumentError(
        absl::StrCat("the drive has ", kept.size(), " nodes, but a submap is ",
                     "finished only after ", 2 * num_range_data));
  }
  kept.resize(static_cast<size_t>(num_submaps + 1) *
              static_cast<size_t>(num_range_data));
  return kept;
}

}  // namespace

std::string Validate(const SimulationOptions& options) {
  for (const std::string& problem :
       {Validate(options.drive), Validate(options.lidar),
        Validate(options.people), Validate(options.drift),
        FirstOutside({{"num_range_data", options.num_range_data, 1, 10000}})}) {
    if (!problem.empty()) return problem;
  }
  return "";
}

absl::StatusOr<SimulatedMap> Simulate(const FloorPlan& plan,
                                      const SimulationOptions& options,
                                      const uint32_t seed,
                                      const ProgressCallback& on_progress) {
  const std::string problem = Validate(options);
  if (!problem.empty()) return absl::InvalidArgumentError(problem);
  const absl::StatusOr<std::vector<DrivenPose>> drive =
      Drive(plan, options.drive, seed);
  if (!drive.ok()) return drive.status();
  const absl::StatusOr<People> people =
      PlacePeople(plan, options.people, drive->back().seconds, seed);
  if (!people.ok()) return people.status();
  RandomNumbers drift_random(seed, RandomStream::kDrift);
  const std::vector<DriftedPose> drifted =
      AddDrift(*drive, options.drift, &drift_random);
  const absl::StatusOr<std::vector<size_t>> kept =
      ChooseNodes(*drive, options.num_range_data);
  if (!kept.ok()) return kept.status();
  RandomNumbers lidar_random(seed, RandomStream::kLidar);
  SimulatedMap map;
  std::vector<Scan> scans;
  for (const size_t k : *kept) {
    const auto& [seconds, T_world_robot] = (*drive)[k];
    scans.push_back(TakeScan(plan, people->At(seconds, T_world_robot),
                             T_world_robot, options.lidar, &lidar_random));
    map.nodes.push_back({ToTicks(seconds), drifted[k].T_local_robot,
                         T_world_robot, FilterVoxels(scans.back().returns)});
    if (on_progress) {
      on_progress(0.5 * static_cast<double>(scans.size()) /
                  static_cast<double>(kept->size()));
    }
  }
  for (size_t k = 0; k <= kept->back(); ++k) {
    map.odometry.push_back(
        {ToTicks((*drive)[k].seconds), drifted[k].T_odometry_robot});
  }
  map.submaps =
      MakeSubmaps(map.nodes, scans, options.num_range_data, on_progress);
  return map;
}

}  // namespace cartographer_sdf
