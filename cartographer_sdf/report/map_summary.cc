// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/map_summary.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/report/text.h"

namespace cartographer_sdf {
namespace {

using Rows = std::vector<std::vector<std::string>>;

constexpr int64_t kSecondsFromYearOneTo1970 = 62135596800;
constexpr int64_t kSecondsFromYearOneTo10000 = 315537897600;

// Hostile files can have any times.
double SecondsBetween(const int64_t begin, const int64_t end) {
  return (static_cast<double>(end) - static_cast<double>(begin)) /
         static_cast<double>(kTicksPerSecond);
}

std::string FormatDuration(const double seconds) {
  if (!(seconds < 1e9)) return absl::StrFormat("%.3g s", seconds);
  if (seconds < 100.) return absl::StrFormat("%.1f s", seconds);
  const int64_t minutes = std::llround(seconds / 60.);
  if (minutes < 60) {
    const int64_t total = std::llround(seconds);
    return absl::StrFormat("%d min %02d s", total / 60, total % 60);
  }
  if (minutes < int64_t{48} * 60) {
    return absl::StrFormat("%d h %02d min", minutes / 60, minutes % 60);
  }
  return absl::StrFormat("%.1f days", seconds / 86400.);
}

std::string DescribeConstraints(const MapState& map) {
  int num_intra = 0, num_inter = 0, num_between_trajectories = 0;
  for (const Constraint& constraint : map.pose_graph.constraints) {
    ++(constraint.tag == Constraint::Tag::kIntraSubmap ? num_intra : num_inter);
    num_between_trajectories +=
        constraint.submap.trajectory != constraint.node.trajectory;
  }
  return absl::StrFormat(
      "%d intra-submap, %d inter-submap (%d between trajectories)", num_intra,
      num_inter, num_between_trajectories);
}

// Lines about all submaps and their grids, by topic.
Rows DescribeSubmaps(const MapState& map) {
  int num_finished = 0, num_tsdf = 0, num_probability = 0;
  double area = 0.;
  std::set<double> resolutions;
  for (const auto& [id, submap] : map.submaps) {
    const double resolution = submap.geometry.resolution;
    num_finished += submap.finished;
    area += submap.num_known_cells * resolution * resolution;
    if ((submap.geometry.size <= 0).any()) continue;
    ++(submap.is_tsdf ? num_tsdf : num_probability);
    resolutions.insert(resolution);
  }
  std::string submaps =
      absl::StrFormat("%d (%d finished)", map.submaps.size(), num_finished);
  if (map.num_unrecorded_submaps > 0) {
    absl::StrAppendFormat(&submaps, ", and %d poses without a submap",
                          map.num_unrecorded_submaps);
  }
  std::vector<std::string> kinds;
  if (num_probability > 0) {
    kinds.push_back(absl::StrCat(num_probability, " probability"));
  }
  if (num_tsdf > 0) kinds.push_back(absl::StrCat(num_tsdf, " TSDF"));
  std::string grids = kinds.empty() ? "none" : absl::StrJoin(kinds, " and ");
  if (!resolutions.empty()) {
    absl::StrAppendFormat(&grids, ", cells of %.4g m", *resolutions.begin());
  }
  if (resolutions.size() > 1) {
    absl::StrAppendFormat(&grids, " to %.4g m", *resolutions.rbegin());
  }
  return {
      {"submaps", submaps},
      {"grids", grids},
      {"observed area", absl::StrFormat("%.1f m2, submap by submap", area)}};
}

std::string DescribeTrajectories(const MapState& map) {
  Rows rows = {{"id", "submaps", "nodes", "duration", "length", "odometry",
                "gaps > 10 s", "begin"}};
  for (const auto& [id, trajectory] : SummarizeTrajectories(map)) {
    std::string gaps = absl::StrCat(trajectory.num_gaps);
    if (trajectory.num_gaps > 0) {
      absl::StrAppend(&gaps, ", up to ",
                      FormatDuration(trajectory.longest_gap_seconds));
    }
    const bool has_nodes = trajectory.num_nodes > 0;
    // The first node has no predecessor.
    const std::string odometry =
        trajectory.num_nodes_with_odometry == 0 ? "no"
        : trajectory.num_nodes_with_odometry >= trajectory.num_nodes - 1
            ? "yes"
            : absl::StrFormat("%d %% of nodes",
                              100 * trajectory.num_nodes_with_odometry /
                                  trajectory.num_nodes);
    rows.push_back(
        {absl::StrCat(id), absl::StrCat(trajectory.num_submaps),
         absl::StrCat(trajectory.num_nodes),
         has_nodes ? FormatDuration(trajectory.duration_seconds) : "-",
         absl::StrFormat("%.1f m", trajectory.length), odometry, gaps,
         has_nodes ? FormatUniversalTime(trajectory.begin_time) : "-"});
  }
  return FormatTable(rows);
}

}  // namespace

std::map<int, TrajectorySummary> SummarizeTrajectories(const MapState& map) {
  std::map<int, TrajectorySummary> trajectories;
  for (const auto& [id, pose] : map.pose_graph.submap_poses) {
    ++trajectories[id.trajectory].num_submaps;
  }
  const std::pair<const NodeId, Node>* previous = nullptr;
  std::map<int, std::pair<int64_t, int64_t>> times;
  for (const auto& entry : map.pose_graph.nodes) {
    const auto& [id, node] = entry;
    TrajectorySummary& trajectory = trajectories[id.trajectory];
    if (trajectory.num_nodes++ == 0) {
      trajectory.begin_time = node.time;
      times[id.trajectory] = {node.time, node.time};
    } else {
      trajectory.length += (node.T_map_node.translation() -
                            previous->second.T_map_node.translation())
                               .norm();
      const double gap = SecondsBetween(previous->second.time, node.time);
      if (gap > kGapSeconds) ++trajectory.num_gaps;
      trajectory.longest_gap_seconds =
          std::max(trajectory.longest_gap_seconds, gap);
    }
    auto& [first, last] = times[id.trajectory];
    first = std::min(first, node.time);
    last = std::max(last, node.time);
    trajectory.duration_seconds = SecondsBetween(first, last);
    if (node.T_previous_node_by_odometry.has_value()) {
      ++trajectory.num_nodes_with_odometry;
    }
    previous = &entry;
  }
  return trajectories;
}

std::string DescribeMap(const std::string& name, const MapState& map) {
  Rows records;
  for (const auto& [kind, count] : map.num_records) {
    records.push_back({kind, absl::StrCat(count)});
  }
  Rows lines = {{"format version", absl::StrCat(map.format_version)},
                {"trajectories", absl::StrCat(map.trajectories.size())}};
  for (std::vector<std::string>& line : DescribeSubmaps(map)) {
    lines.push_back(std::move(line));
  }
  std::string nodes = absl::StrCat(map.pose_graph.nodes.size());
  if (map.num_unrecorded_nodes > 0) {
    absl::StrAppend(&nodes, ", ", map.num_unrecorded_nodes,
                    " of them without data: the file was cut");
  }
  lines.push_back({"nodes", nodes});
  lines.push_back({"constraints", DescribeConstraints(map)});
  lines.push_back(
      {"landmarks", absl::StrCat(map.pose_graph.landmark_poses.size())});
  std::string text = absl::StrCat(name, "\n");
  for (const std::vector<std::string>& line : lines) {
    absl::StrAppendFormat(&text, "  %-16s%s\n", line[0], line[1]);
  }
  absl::StrAppend(&text, "\nTrajectories\n", DescribeTrajectories(map),
                  "\nRecords\n", FormatTable(records));
  return text;
}

std::string DescribeSlips(const Slips& slips, const PoseGraph& pose_graph) {
  if (slips.empty()) return "";
  double largest = 0.;
  for (const auto& [node, angle] : slips) {
    largest = std::max(largest, std::abs(angle));
  }
  const size_t num_submaps = SubmapsWithSlips(slips, pose_graph).size();
  return absl::StrFormat(
      "Local SLAM slipped at %d %s, in %d %s: there odometry turned by angles "
      "that differ by up to %.1f deg",
      slips.size(), slips.size() == 1 ? "step" : "steps", num_submaps,
      num_submaps == 1 ? "submap" : "submaps", largest * 180. / M_PI);
}

std::string FormatUniversalTime(const int64_t ticks) {
  const int64_t seconds = ticks / kTicksPerSecond;
  if (ticks < 0 || seconds >= kSecondsFromYearOneTo10000) return "-";
  const std::time_t unix_time = seconds - kSecondsFromYearOneTo1970;
  std::tm utc{};
  if (gmtime_r(&unix_time, &utc) == nullptr) return "-";
  return absl::StrFormat("%04d-%02d-%02d %02d:%02d:%02d UTC",
                         utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                         utc.tm_hour, utc.tm_min, utc.tm_sec);
}

}  // namespace cartographer_sdf
