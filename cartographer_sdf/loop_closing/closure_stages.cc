// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/loop_closing/closure_stages.h"

#include <algorithm>

#include "cartographer_sdf/loop_closing/loop_closing.h"

namespace cartographer_sdf {
namespace {

std::vector<SurfacePoint> ToSurfacePoints(const PointCloud2& cloud) {
  std::vector<SurfacePoint> points;
  points.reserve(cloud.size());
  for (const Eigen::Vector2f& point : cloud) {
    points.push_back({point.cast<double>(), 1.});
  }
  return points;
}

}  // namespace

void SelectClosures(const ConsistencyOptions& options, const MapState& state,
                    const std::map<SubmapId, Tear>& torn,
                    std::vector<ClosureOutcome>* const outcomes) {
  std::vector<LoopClosure> closures;
  for (const ClosureOutcome& outcome : *outcomes) {
    closures.push_back(outcome.match.closure);
    LoopClosure& closure = closures.back();
    if (torn.count(closure.reference) + torn.count(closure.query) > 0) {
      closure.score = std::min(closure.score, 0.);
    }
  }
  const std::vector<SelectionResult> results =
      SelectConsistent(options, OdometryPoses(state), closures);
  for (size_t k = 0; k < results.size(); ++k) {
    switch (results[k].selection) {
      case Selection::kSelected:
        (*outcomes)[k].fate = Fate::kInGraph;
        break;
      case Selection::kContradicted:
        (*outcomes)[k].fate = Fate::kContradicted;
        break;
      case Selection::kUnsupported:
        (*outcomes)[k].fate = Fate::kUnsupported;
        break;
    }
  }
}

absl::StatusOr<ScansByNode> ReadScans(
    const std::set<NodeId>& nodes, const PointCloudReader& read_point_clouds) {
  ScansByNode scans;
  if (nodes.empty()) return scans;
  const absl::StatusOr<std::map<NodeId, PointCloud2>> clouds =
      read_point_clouds(nodes);
  if (!clouds.ok()) return clouds.status();
  for (const auto& [node, cloud] : *clouds) {
    if (!cloud.empty()) scans.emplace(node, ToSurfacePoints(cloud));
  }
  return scans;
}

absl::StatusOr<ScansByNode> ReadScansToLift(
    const LiftingOptions& options, const PoseGraph& pose_graph,
    const std::vector<ClosureOutcome>& outcomes,
    const PointCloudReader& read_point_clouds) {
  std::set<SubmapId> submaps;
  for (const ClosureOutcome& outcome : outcomes) {
    if (outcome.fate != Fate::kInGraph) continue;
    submaps.insert(outcome.match.closure.reference);
    submaps.insert(outcome.match.closure.query);
  }
  std::set<NodeId> nodes;
  for (const SubmapId& submap : submaps) {
    for (const NodeId& node : NodesToLift(options, pose_graph, submap)) {
      nodes.insert(node);
    }
  }
  return ReadScans(nodes, read_point_clouds);
}

void LiftClosures(const LiftingOptions& options, const PoseGraph& pose_graph,
                  const std::map<SubmapId, Place>& places,
                  const ScansByNode& scans, const Executor& executor,
                  std::vector<ClosureOutcome>* const outcomes) {
  executor(outcomes->size(), [&](const size_t k) {
    ClosureOutcome& outcome = (*outcomes)[k];
    if (outcome.fate != Fate::kInGraph) return;
    const LoopClosure& closure = outcome.match.closure;
    outcome.constraints = LiftClosure(options, pose_graph, closure,
                                      places.at(closure.reference).surface,
                                      places.at(closure.query).surface, scans);
    if (outcome.constraints.empty()) outcome.fate = Fate::kScansDisagree;
  });
}

}  // namespace cartographer_sdf
