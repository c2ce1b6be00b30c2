// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/simulated_map.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/simulation/random_numbers.h"

namespace cartographer_sdf {
namespace {

// 2001-09-09 01:46:40 UTC, a billion seconds after 1970, in ticks of 100 ns
// since the year 1, which is 719162 days earlier.
constexpr int64_t kTicksPerSecond = 10'000'000;
constexpr int64_t kStartTime =
    (719'162LL * 24 * 3600 + 1'000'000'000LL) * kTicksPerSecond;

// Of the host's 2D defaults, TRAJECTORY_BUILDER and POSE_GRAPH.
constexpr double kIntraTranslationWeight = 5e2;
constexpr double kIntraRotationWeight = 1.6e3;

int64_t ToTicks(const double seconds) {
  return kStartTime +
         static_cast<int64_t>(std::llround(seconds * kTicksPerSecond));
}

// Indices of the poses whose scans become nodes.
std::vector<size_t> FilterMotion(const std::vector<DrivenPose>& drive,
                                 const LocalSlamOptions& options) {
  std::vector<size_t> kept = {0};
  for (size_t k = 1; k < drive.size(); ++k) {
    const Rigid2 T_last_robot =
        drive[kept.back()].T_world_robot.Inverse() * drive[k].T_world_robot;
    // Rounding must not decide on steps that add up to the distance.
    if (T_last_robot.translation().norm() > options.node_distance - 1e-6 ||
        std::abs(T_last_robot.rotation()) > options.node_rotation - 1e-6) {
      kept.push_back(k);
    }
  }
  return kept;
}

// The first point of each voxel.
PointCloud2 FilterVoxels(const std::vector<Eigen::Vector2f>& points,
                         const double voxel_size) {
  std::set<std::pair<int, int>> voxels;
  PointCloud2 filtered;
  for (const Eigen::Vector2f& point : points) {
    const Eigen::Array2i voxel =
        (point.cast<double>().array() / voxel_size).floor().cast<int>();
    if (voxels.insert({voxel.x(), voxel.y()}).second) filtered.push_back(point);
  }
  return filtered;
}

SimulatedSubmap MakeSubmap(const std::vector<SimulatedNode>& nodes,
                           const std::vector<Scan>& scans, const int first_node,
                           const int end_node, const ScanGridOptions& options) {
  SimulatedSubmap submap;
  submap.first_node = first_node;
  submap.end_node = end_node;
  const SimulatedNode& first = nodes[first_node];
  submap.T_local_submap = Rigid2(first.T_local_node.translation(), 0.);
  const Rigid2 T_submap_local = submap.T_local_submap.Inverse();
  submap.T_world_submap =
      first.T_world_node * (T_submap_local * first.T_local_node).Inverse();
  ScanGrid grid(options);
  for (int k = first_node; k != end_node; ++k) {
    grid.Insert(T_submap_local * nodes[k].T_local_node, scans[k]);
  }
  submap.grid = grid.Crop();
  return submap;
}

// Each submap takes the nodes of two intervals, and shares each with another.
std::vector<SimulatedSubmap> MakeSubmaps(
    const std::vector<SimulatedNode>& nodes, const std::vector<Scan>& scans,
    const SimulationOptions& options, const ProgressCallback& on_progress) {
  const int interval = options.local_slam.num_range_data;
  const int num_submaps = static_cast<int>(nodes.size()) / interval - 1;
  std::vector<SimulatedSubmap> submaps;
  for (int k = 0; k != num_submaps; ++k) {
    submaps.push_back(MakeSubmap(nodes, scans, k * interval, (k + 2) * interval,
                                 options.grid));
    if (on_progress) on_progress(0.5 + 0.5 * (k + 1.) / num_submaps);
  }
  return submaps;
}

// As FilterMotion, without those at the end that fill no submap.
absl::StatusOr<std::vector<size_t>> ChooseNodes(
    const std::vector<DrivenPose>& drive, const LocalSlamOptions& options) {
  std::vector<size_t> kept = FilterMotion(drive, options);
  const int num_submaps =
      static_cast<int>(kept.size()) / options.num_range_data - 1;
  if (num_submaps < 1) {
    return absl::InvalidArgumentError(
        absl::StrCat("the drive has ", kept.size(), " nodes, but a submap is ",
                     "finished only after ", 2 * options.num_range_data));
  }
  kept.resize((num_submaps + 1) * options.num_range_data);
  return kept;
}

std::vector<DrivenPose> PosesAt(const std::vector<size_t>& indices,
                                const std::vector<DrivenPose>& drive) {
  std::vector<DrivenPose> poses;
  for (const size_t k : indices) poses.push_back(drive[k]);
  return poses;
}

std::vector<Scan> TakeScans(const FloorPlan& plan, const People& people,
                            const std::vector<DrivenPose>& poses,
                            const LidarOptions& options,
                            const ProgressCallback& on_progress,
                            RandomNumbers* const random) {
  std::vector<Scan> scans;
  for (const DrivenPose& pose : poses) {
    scans.push_back(TakeScan(plan, people.At(pose.seconds, pose.T_world_robot),
                             pose.T_world_robot, options, random));
    if (on_progress) {
      on_progress(0.5 * static_cast<double>(scans.size()) /
                  static_cast<double>(poses.size()));
    }
  }
  return scans;
}

std::vector<SimulatedNode> MakeNodes(const std::vector<size_t>& kept,
                                     const std::vector<DrivenPose>& drive,
                                     const std::vector<DriftedPose>& drifted,
                                     const std::vector<Scan>& scans,
                                     const LocalSlamOptions& options) {
  std::vector<SimulatedNode> nodes;
  for (size_t n = 0; n != kept.size(); ++n) {
    const size_t k = kept[n];
    nodes.push_back({ToTicks(drive[k].seconds), drifted[k].T_local_robot,
                     drive[k].T_world_robot,
                     FilterVoxels(scans[n].returns, options.voxel_size)});
  }
  return nodes;
}

// Up to pose `last`, which counts.
std::vector<SimulatedOdometry> MakeOdometry(
    const size_t last, const std::vector<DrivenPose>& drive,
    const std::vector<DriftedPose>& drifted) {
  std::vector<SimulatedOdometry> odometry;
  for (size_t k = 0; k <= last; ++k) {
    odometry.push_back(
        {ToTicks(drive[k].seconds), drifted[k].T_odometry_robot});
  }
  return odometry;
}

}  // namespace

std::string Validate(const LocalSlamOptions& options) {
  if (options.num_range_data < 1 || options.num_range_data > 10000) {
    return "num_range_data must lie between 1 and 10000";
  }
  if (!(options.node_distance >= 0.01 && options.node_distance <= 10.)) {
    return "node_distance must lie between 0.01 m and 10 m";
  }
  if (!(options.node_rotation >= 0.01 && options.node_rotation <= M_PI)) {
    return "node_rotation must lie between 0.01 rad and pi";
  }
  if (!(options.voxel_size >= 1e-3 && options.voxel_size <= 10.)) {
    return "voxel_size must lie between 0.001 m and 10 m";
  }
  return "";
}

std::string Validate(const SimulationOptions& options) {
  for (const std::string& problem :
       {Validate(options.drive), Validate(options.lidar),
        Validate(options.people), Validate(options.drift),
        Validate(options.local_slam), Validate(options.grid)}) {
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
      ChooseNodes(*drive, options.local_slam);
  if (!kept.ok()) return kept.status();
  RandomNumbers lidar_random(seed, RandomStream::kLidar);
  const std::vector<Scan> scans =
      TakeScans(plan, *people, PosesAt(*kept, *drive), options.lidar,
                on_progress, &lidar_random);
  SimulatedMap map;
  map.nodes = MakeNodes(*kept, *drive, drifted, scans, options.local_slam);
  map.odometry = MakeOdometry(kept->back(), *drive, drifted);
  map.submaps = MakeSubmaps(map.nodes, scans, options, on_progress);
  return map;
}

std::vector<Constraint> IntraSubmapConstraints(const SimulatedMap& map) {
  std::vector<Constraint> constraints;
  for (size_t i = 0; i != map.submaps.size(); ++i) {
    const SimulatedSubmap& submap = map.submaps[i];
    for (int j = submap.first_node; j != submap.end_node; ++j) {
      Constraint constraint;
      constraint.submap = {0, static_cast<int>(i)};
      constraint.node = {0, j};
      constraint.T_submap_node =
          submap.T_local_submap.Inverse() * map.nodes[j].T_local_node;
      constraint.translation_weight = kIntraTranslationWeight;
      constraint.rotation_weight = kIntraRotationWeight;
      constraint.tag = Constraint::Tag::kIntraSubmap;
      constraints.push_back(constraint);
    }
  }
  return constraints;
}

}  // namespace cartographer_sdf
