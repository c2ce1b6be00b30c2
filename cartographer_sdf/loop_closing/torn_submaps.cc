// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/loop_closing/torn_submaps.h"

#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Scans held at once: some hundred megabytes where each has a thousand points.
constexpr size_t kMaxScansAtOnce = 20000;

struct SubmapScans {
  SubmapId id;
  std::map<NodeId, Rigid2> T_submap_node;
};

std::vector<SubmapScans> InsertedNodes(const PoseGraph& pose_graph) {
  std::map<SubmapId, std::map<NodeId, Rigid2>> inserted;
  for (const Constraint& constraint : pose_graph.constraints) {
    if (constraint.tag != Constraint::Tag::kIntraSubmap) continue;
    inserted[constraint.submap].emplace(constraint.node,
                                        constraint.T_submap_node);
  }
  std::vector<SubmapScans> submaps;
  for (auto& [id, nodes] : inserted) submaps.push_back({id, std::move(nodes)});
  return submaps;
}

std::vector<InsertedScan> ScansOf(const SubmapScans& submap,
                                  const std::map<NodeId, PointCloud2>& clouds) {
  std::vector<InsertedScan> scans;
  for (const auto& [node, T_submap_node] : submap.T_submap_node) {
    const auto cloud = clouds.find(node);
    if (cloud != clouds.end()) scans.push_back({T_submap_node, cloud->second});
  }
  return scans;
}

}  // namespace

absl::StatusOr<std::map<SubmapId, Tear>> FindTornSubmaps(
    const TearOptions& options, const std::string& path,
    const PoseGraph& pose_graph, const Executor& executor,
    const ProgressCallback& on_progress) {
  CHECK_EQ(Validate(options), "");
  const std::vector<SubmapScans> submaps = InsertedNodes(pose_graph);
  std::vector<std::optional<Tear>> tears(submaps.size());
  for (size_t begin = 0; begin < submaps.size();) {
    std::set<NodeId> nodes;
    size_t end = begin;
    // One submap at least, however many scans it has.
    for (; end < submaps.size(); ++end) {
      const auto& more = submaps[end].T_submap_node;
      if (end > begin && nodes.size() + more.size() > kMaxScansAtOnce) break;
      for (const auto& entry : more) nodes.insert(entry.first);
    }
    const absl::StatusOr<std::map<NodeId, PointCloud2>> clouds =
        ReadPointClouds(path, nodes);
    if (!clouds.ok()) return clouds.status();
    executor(end - begin, [&](const size_t k) {
      tears[begin + k] =
          FindTear(options, ScansOf(submaps[begin + k], *clouds));
    });
    begin = end;
    if (on_progress) {
      on_progress(static_cast<double>(end) /
                  static_cast<double>(submaps.size()));
    }
  }
  std::map<SubmapId, Tear> torn;
  for (size_t k = 0; k < submaps.size(); ++k) {
    if (tears[k]) torn.emplace(submaps[k].id, *tears[k]);
  }
  return torn;
}

std::string DescribeTear(const SubmapId& id, const Tear& tear) {
  return absl::StrFormat(
      "%d,%d: part %d against part %d off by %.2f m, %.1f deg", id.trajectory,
      id.index, tear.second_part + 1, tear.first_part + 1, tear.translation,
      std::abs(tear.T_first_second.rotation()) * 180. / M_PI);
}

}  // namespace cartographer_sdf
