// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/torn_submaps.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/closing/constraint_generation.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

std::vector<PlacedScan> ScansOf(const InsertedNodes& nodes,
                                const std::map<NodeId, PointCloud2>& clouds) {
  std::vector<PlacedScan> scans;
  for (const auto& [node, T_submap_node] : nodes) {
    const auto cloud = clouds.find(node);
    if (cloud == clouds.end()) continue;
    scans.push_back({T_submap_node, {cloud->second, {}}});
  }
  return scans;
}

}  // namespace

std::map<SubmapId, Tear> FindTornSubmaps(
    const TearOptions& options, const PoseGraph& pose_graph,
    const std::map<NodeId, PointCloud2>& scans, const Executor& executor,
    const ProgressCallback& on_progress) {
  CHECK_EQ(Validate(options), "");
  const std::map<SubmapId, InsertedNodes> nodes = FindInsertedNodes(pose_graph);
  const std::vector<std::pair<SubmapId, InsertedNodes>> submaps(nodes.begin(),
                                                                nodes.end());
  std::vector<std::optional<Tear>> tears(submaps.size());
  TaskProgress progress(on_progress, submaps.size());
  executor(submaps.size(), [&](const size_t k) {
    tears[k] = FindTear(options, ScansOf(submaps[k].second, scans));
    progress.TaskIsDone();
  });
  std::map<SubmapId, Tear> torn;
  for (size_t k = 0; k < submaps.size(); ++k) {
    if (tears[k]) torn.emplace(submaps[k].first, *tears[k]);
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
