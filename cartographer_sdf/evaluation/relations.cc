// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/relations.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "cartographer_sdf/evaluation/tracking_pose.h"
#include "cartographer_sdf/file/text_file.h"

namespace cartographer_sdf {
namespace {

// Universal time: 100 ns ticks since 0001-01-01.
constexpr double kTicksPerSecond = 1e7;
constexpr int64_t kUnixEpochTicks = int64_t{719162} * 24 * 3600 * 10000000;
// Of the maps that were made from recordings without a clock, see the header.
constexpr int64_t kFirstScanTicks =
    kUnixEpochTicks + int64_t{1000000000} * 10000000;

constexpr double kMaxSecondsOutside = 1.;
constexpr double kMinLoopSeconds = 30.;

struct TimedPose {
  double time;           // [s] since the first scan
  Eigen::Vector3d pose;  // x, y and a yaw that does not jump
};

std::vector<TimedPose> Trajectory(const PoseGraph& pose_graph) {
  std::vector<std::pair<int64_t, Rigid2>> stamped;
  for (const auto& [id, node] : pose_graph.nodes) {
    stamped.emplace_back(node.time, TrackingPose(node));
  }
  std::stable_sort(
      stamped.begin(), stamped.end(),
      [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<TimedPose> trajectory;
  for (const auto& [ticks, pose] : stamped) {
    const double yaw =
        trajectory.empty()
            ? pose.rotation()
            : trajectory.back().pose.z() +
                  NormalizeAngle(pose.rotation() - trajectory.back().pose.z());
    trajectory.push_back(
        {static_cast<double>(ticks - kFirstScanTicks) / kTicksPerSecond,
         {pose.translation().x(), pose.translation().y(), yaw}});
  }
  return trajectory;
}

// Of a trajectory that is not empty; beyond its ends the nearest pose.
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

struct PoseErrors {
  std::vector<double> translations;
  std::vector<double> rotations;

  std::optional<PoseErrorStatistics> Summary() const {
    const std::optional<ErrorStatistics> translation = Summarize(translations);
    const std::optional<ErrorStatistics> rotation = Summarize(rotations);
    if (!translation.has_value() || !rotation.has_value()) return std::nullopt;
    return PoseErrorStatistics{*translation, *rotation};
  }
};

}  // namespace

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
  PoseErrors all;
  PoseErrors loops;
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
    const double translation =
        (T_first_second.translation() - relation.T_first_second.translation())
            .norm();
    const double rotation = std::abs(NormalizeAngle(
        T_first_second.rotation() - relation.T_first_second.rotation()));
    all.translations.push_back(translation);
    all.rotations.push_back(rotation);
    if (std::abs(relation.second_time - relation.first_time) >
        kMinLoopSeconds) {
      loops.translations.push_back(translation);
      loops.rotations.push_back(rotation);
    }
  }
  result.all = all.Summary();
  result.loops = loops.Summary();
  return result;
}

}  // namespace cartographer_sdf
