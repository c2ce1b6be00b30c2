// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/map_errors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "cartographer_sdf/file/text_file.h"
#include "cartographer_sdf/geometry/alignment.h"
#include "cartographer_sdf/geometry/rigid3.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {
namespace {

double Quantile(const std::vector<double>& sorted, const double fraction) {
  const double position = fraction * static_cast<double>(sorted.size() - 1);
  const size_t below = static_cast<size_t>(position);
  const size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - static_cast<double>(below)) *
                             (sorted[above] - sorted[below]);
}

// For maps of recordings without a clock, see the header.
constexpr int64_t kFirstScanTicks =
    kUnixEpochTicks + int64_t{1'000'000'000} * kTicksPerSecond;

constexpr double kMaxSecondsOutside = 1.;
constexpr double kMinLoopSeconds = 30.;

struct TimedPose {
  double time;           // [s] since the first scan
  Eigen::Vector3d pose;  // x, y and a yaw that does not jump
};

std::vector<TimedPose> Trajectory(const PoseGraph& pose_graph) {
  std::multimap<int64_t, Rigid2> stamped;
  for (const auto& [id, node] : pose_graph.nodes) {
    stamped.emplace(node.time, TrackingPose(node));
  }
  std::vector<TimedPose> trajectory;
  for (const auto& [ticks, pose] : stamped) {
    const double yaw =
        trajectory.empty()
            ? pose.rotation()
            : trajectory.back().pose.z() +
                  NormalizeAngle(pose.rotation() - trajectory.back().pose.z());
    trajectory.push_back(
        {static_cast<double>(ticks - kFirstScanTicks) /
             static_cast<double>(kTicksPerSecond),
         {pose.translation().x(), pose.translation().y(), yaw}});
  }
  return trajectory;
}

// Requires a non-empty trajectory; beyond its ends, returns the nearest pose.
Rigid2 PoseAt(const std::vector<TimedPose>& trajectory, const double time) {
  const auto after = std::upper_bound(
      trajectory.begin(), trajectory.end(), time,
      [](const double t, const TimedPose& pose) { return t < pose.time; });
  Eigen::Vector3d pose;
  if (after == trajectory.begin()) {
    pose = after->pose;
  } else if (after == trajectory.end()) {
    pose = trajectory.back().pose;
  } else {
    const auto before = after - 1;
    pose = before->pose + (time - before->time) / (after->time - before->time) *
                              (after->pose - before->pose);
  }
  return Rigid2(pose.head<2>(), pose.z());
}

// A node or submap of a drive: its pose by local SLAM and the true one, and the
// distance driven in truth.
struct DrivenPose {
  Rigid2 T_local_pose;
  Rigid2 T_world_pose;
  double distance = 0.;
};

void AddToDrive(const Rigid2& T_local_pose, const Rigid2& T_world_pose,
                std::vector<DrivenPose>* const drive) {
  DrivenPose driven{T_local_pose, T_world_pose, 0.};
  if (!drive->empty()) {
    driven.distance =
        drive->back().distance +
        (T_world_pose.translation() - drive->back().T_world_pose.translation())
            .norm();
  }
  drive->push_back(driven);
}

// The nodes of each trajectory that have a true pose.
std::map<int, std::vector<DrivenPose>> NodeDrivesOf(const PoseGraph& pose_graph,
                                                    const Truth& truth) {
  std::map<int, std::vector<DrivenPose>> drives;
  for (const auto& [id, node] : pose_graph.nodes) {
    const auto T_world_tracking = truth.T_world_tracking.find(id);
    if (T_world_tracking == truth.T_world_tracking.end()) continue;
    const Rigid2& T_local_node = node.T_local_node.value_or(node.T_map_node);
    AddToDrive(Project2D(Embed3D(T_local_node) *
                         Rigid3::Rotation(node.gravity_alignment)),
               T_world_tracking->second, &drives[id.trajectory]);
  }
  return drives;
}

// The submaps of each trajectory that have a true pose, and nodes that say
// where local SLAM put them.
std::map<int, std::vector<DrivenPose>> SubmapDrivesOf(
    const PoseGraph& pose_graph, const Truth& truth) {
  std::map<SubmapId, Rigid2> T_local_submap;
  for (const Constraint& constraint : pose_graph.constraints) {
    if (constraint.tag != Constraint::Tag::kIntraSubmap) continue;
    const std::optional<Rigid2>& T_local_node =
        pose_graph.nodes.at(constraint.node).T_local_node;
    if (!T_local_node) continue;
    T_local_submap.emplace(constraint.submap,
                           *T_local_node * constraint.T_submap_node.Inverse());
  }
  std::map<int, std::vector<DrivenPose>> drives;
  for (const auto& [id, T_local] : T_local_submap) {
    const auto T_world_submap = truth.T_world_submap.find(id);
    if (T_world_submap == truth.T_world_submap.end()) continue;
    AddToDrive(T_local, T_world_submap->second, &drives[id.trajectory]);
  }
  return drives;
}

void CompareDrive(const std::vector<DrivenPose>& drive,
                  DriveComparison* const comparison) {
  constexpr double kLength = 10.;    // [m] of a stretch
  constexpr double kMaxDrift = 1.5;  // [m] along it
  size_t end = 0;
  double next_begin = 0.;
  for (size_t begin = 0; begin < drive.size(); ++begin) {
    if (drive[begin].distance < next_begin) continue;
    while (end < drive.size() &&
           drive[end].distance < drive[begin].distance + kLength) {
      ++end;
    }
    if (end == drive.size()) return;
    next_begin = drive[begin].distance + kLength / 10.;
    const Rigid2 by_slam =
        drive[begin].T_local_pose.Inverse() * drive[end].T_local_pose;
    const Rigid2 in_truth =
        drive[begin].T_world_pose.Inverse() * drive[end].T_world_pose;
    ++comparison->num_stretches;
    comparison->num_different +=
        (by_slam.translation() - in_truth.translation()).norm() > kMaxDrift;
  }
}

}  // namespace

std::optional<ErrorStatistics> Summarize(std::vector<double> errors) {
  if (errors.empty()) return std::nullopt;
  std::sort(errors.begin(), errors.end());
  ErrorStatistics statistics;
  statistics.count = static_cast<int>(errors.size());
  statistics.mean = std::accumulate(errors.begin(), errors.end(), 0.) /
                    static_cast<double>(errors.size());
  statistics.median = Quantile(errors, 0.5);
  statistics.percentile_90 = Quantile(errors, 0.9);
  statistics.max = errors.back();
  return statistics;
}

std::optional<PoseErrorStatistics> SummarizePoses(
    const std::vector<PoseError>& errors) {
  if (errors.empty()) return std::nullopt;
  std::vector<double> translations, rotations;
  for (const PoseError& error : errors) {
    translations.push_back(error.translation);
    rotations.push_back(error.rotation);
  }
  return PoseErrorStatistics{*Summarize(translations), *Summarize(rotations)};
}

Rigid2 TrackingPose(const Node& node) {
  return Project2D(Embed3D(node.T_map_node) *
                   Rigid3::Rotation(node.gravity_alignment));
}

std::optional<TrajectoryError> EvaluateTrajectory(const PoseGraph& pose_graph,
                                                  const Truth& truth) {
  std::vector<std::pair<Rigid2, Rigid2>> poses;  // in the world, in the map
  std::vector<Eigen::Vector2d> p_world;
  std::vector<Eigen::Vector2d> p_map;
  TrajectoryError result;
  for (const auto& [id, node] : pose_graph.nodes) {
    const auto T_world_tracking = truth.T_world_tracking.find(id);
    if (T_world_tracking == truth.T_world_tracking.end()) {
      ++result.num_skipped;
      continue;
    }
    poses.emplace_back(T_world_tracking->second, TrackingPose(node));
    p_world.push_back(poses.back().first.translation());
    p_map.push_back(poses.back().second.translation());
  }
  const std::optional<Rigid2> T_world_map = AlignPointPairs(p_world, p_map);
  if (!T_world_map.has_value()) return std::nullopt;
  result.T_world_map = *T_world_map;
  std::vector<PoseError> errors;
  for (const auto& [T_world_tracking, T_map_tracking] : poses) {
    const Rigid2 T_tracking_estimate =
        T_world_tracking.Inverse() * *T_world_map * T_map_tracking;
    errors.push_back({T_tracking_estimate.translation().norm(),
                      std::abs(T_tracking_estimate.rotation())});
  }
  result.errors = *SummarizePoses(errors);
  return result;
}

DriveComparison CompareDrives(const PoseGraph& pose_graph, const Truth& truth) {
  DriveComparison comparison;
  const bool has_nodes = !truth.T_world_tracking.empty();
  for (const auto& [trajectory, drive] :
       has_nodes ? NodeDrivesOf(pose_graph, truth)
                 : SubmapDrivesOf(pose_graph, truth)) {
    CompareDrive(drive, &comparison);
  }
  return comparison;
}

absl::Status CheckIsTruthOf(const std::string& map_name,
                            const PoseGraph& pose_graph,
                            const std::string& truth_name, const Truth& truth) {
  const DriveComparison comparison = CompareDrives(pose_graph, truth);
  if (2 * comparison.num_different <= comparison.num_stretches) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat(truth_name, " is the truth of another map: of ",
                   comparison.num_stretches, " stretches of the drive, ",
                   comparison.num_different, " go elsewhere in ", map_name));
}

absl::StatusOr<std::vector<Relation>> ReadRelations(const std::string& path) {
  constexpr size_t kNumFields = 7;
  const absl::StatusOr<std::vector<TextLine>> lines = ReadLines(path);
  if (!lines.ok()) return lines.status();
  std::vector<Relation> relations;
  for (const TextLine& line : *lines) {
    const std::string text = line.text.substr(0, line.text.find('#'));
    const std::vector<std::string> fields =
        absl::StrSplit(text, absl::ByAnyChar(" \t"), absl::SkipEmpty());
    if (fields.empty()) continue;
    if (fields.size() < kNumFields) {
      return LineError(path, line.number,
                       absl::StrCat(fields.size(), " numbers instead of ",
                                    kNumFields, " or more"));
    }
    std::vector<double> values;
    for (size_t k = 0; k != kNumFields; ++k) {
      const absl::StatusOr<double> value =
          ParseNumber(path, line.number, fields[k]);
      if (!value.ok()) return value.status();
      values.push_back(*value);
    }
    relations.push_back(Relation{values[0], values[1],
                                 Rigid2(values[2], values[3], values[4]),
                                 values[5], values[6]});
  }
  return relations;
}

RelationErrors EvaluateRelations(const PoseGraph& pose_graph,
                                 const std::vector<Relation>& relations,
                                 const double seconds_per_scan) {
  const std::vector<TimedPose> trajectory = Trajectory(pose_graph);
  RelationErrors result;
  std::vector<PoseError> all, loops;
  for (const Relation& relation : relations) {
    const double first = relation.first_scan * seconds_per_scan;
    const double second = relation.second_scan * seconds_per_scan;
    if (trajectory.empty() ||
        std::min(first, second) <
            trajectory.front().time - kMaxSecondsOutside ||
        std::max(first, second) > trajectory.back().time + kMaxSecondsOutside) {
      ++result.num_skipped;
      continue;
    }
    const Rigid2 T_first_second =
        PoseAt(trajectory, first).Inverse() * PoseAt(trajectory, second);
    const PoseError error = {
        (T_first_second.translation() - relation.T_first_second.translation())
            .norm(),
        std::abs(NormalizeAngle(T_first_second.rotation() -
                                relation.T_first_second.rotation()))};
    all.push_back(error);
    if (std::abs(relation.second_time - relation.first_time) >
        kMinLoopSeconds) {
      loops.push_back(error);
    }
  }
  result.all = SummarizePoses(all);
  result.loops = SummarizePoses(loops);
  return result;
}

}  // namespace cartographer_sdf
