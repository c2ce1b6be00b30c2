// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/scan_search.h"

#include <optional>
#include <utility>

#include "cartographer_sdf/geometry/distinct_poses.h"
#include "cartographer_sdf/live/host_conversion.h"
#include "cartographer_sdf/localization/union_grid.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

namespace mapping = cartographer::mapping;

// From one scan to the next, registration moves a pose less [m], [rad].
constexpr PoseTolerance kSamePoseOfSession{1., 0.2};

// Calls `use` with each planar grid of the trajectories and its pose in the
// map.
template <typename Use>
void ForEachGrid(
    const mapping::MapById<mapping::SubmapId, mapping::PoseGraph::SubmapData>&
        submaps,
    const std::vector<int>& trajectory_ids, const Use& use) {
  for (const int trajectory_id : trajectory_ids) {
    for (const auto& submap : submaps.trajectory(trajectory_id)) {
      if (submap.data.submap == nullptr) continue;
      const std::optional<OccupancyGrid> grid = CopyGrid(*submap.data.submap);
      if (grid) use(*grid, FromHost(submap.data.pose));
    }
  }
}

}  // namespace

std::unique_ptr<const PanoramaMap> DrawLoadedMap(
    const ViewpointOptions& options, const mapping::PoseGraph& pose_graph,
    const std::vector<int>& trajectory_ids) {
  const auto submaps = pose_graph.GetAllSubmapData();
  std::vector<GridFootprint> footprints;
  ForEachGrid(submaps, trajectory_ids,
              [&](const OccupancyGrid& grid, const Rigid2& T_map_submap) {
                footprints.push_back({grid.geometry, T_map_submap});
              });
  if (footprints.empty()) return nullptr;
  UnionGrid united(footprints);
  ForEachGrid(submaps, trajectory_ids,
              [&](const OccupancyGrid& grid, const Rigid2& T_map_submap) {
                united.Add(grid, T_map_submap);
              });
  const std::optional<OccupancyGrid> grid = united.Finish();
  if (!grid) return nullptr;
  std::vector<Eigen::Vector2d> driven_positions;
  const auto nodes = pose_graph.GetTrajectoryNodePoses();
  for (const int trajectory_id : trajectory_ids) {
    for (const auto& node : nodes.trajectory(trajectory_id)) {
      driven_positions.push_back(FromHost(node.data.global_pose).translation());
    }
  }
  std::optional<PanoramaMap> map =
      MakePanoramaMap(options, *grid, driven_positions);
  if (!map) return nullptr;
  return std::make_unique<const PanoramaMap>(*std::move(map));
}

ScanSearch::ScanSearch(const ScanLocalizationOptions& options,
                       const ScanSessionOptions& session_options)
    : options_(options), session_options_(session_options) {}

void ScanSearch::SetMap(std::unique_ptr<const PanoramaMap> map) {
  searches_.clear();
  map_ = std::move(map);
}

void ScanSearch::Start(const int trajectory_id) {
  CHECK(HasMap());
  searches_.erase(trajectory_id);
  searches_.emplace(
      trajectory_id,
      Search{ScanSession(options_, session_options_, *map_), std::nullopt});
}

ScanSearch::Step ScanSearch::Add(const int trajectory_id,
                                 const OdometryScan& scan) {
  if (searches_.count(trajectory_id) == 0) Start(trajectory_id);
  Search& search = searches_.at(trajectory_id);
  Step step;
  step.answer = search.session.Add(scan);
  std::optional<Rigid2> T_map_odometry;
  if (step.answer.T_map_robot) {
    T_map_odometry = *step.answer.T_map_robot * scan.T_odometry_robot.Inverse();
  }
  step.is_lost =
      search.T_map_odometry &&
      !(T_map_odometry &&
        AreNear(*search.T_map_odometry, *T_map_odometry,
                scan.T_odometry_robot.translation(), kSamePoseOfSession));
  search.T_map_odometry = T_map_odometry;
  return step;
}

}  // namespace cartographer_sdf
