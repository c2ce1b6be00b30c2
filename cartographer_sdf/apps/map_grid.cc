// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/map_grid.h"

#include <map>
#include <optional>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "cartographer_sdf/localization/union_grid.h"

namespace cartographer_sdf {
namespace {

// Progress of one of two equal halves of the work.
ProgressCallback HalfOf(const ProgressCallback& on_progress,
                        const double begin) {
  if (!on_progress) return {};
  return [&on_progress, begin](const double fraction) {
    on_progress(begin + 0.5 * fraction);
  };
}

}  // namespace

absl::StatusOr<MapGrid> ReadMapGrid(const MapSource& source,
                                    const ProgressCallback& on_progress) {
  const absl::StatusOr<MapState> state =
      ReadMap(source, {}, HalfOf(on_progress, 0.));
  if (!state.ok()) return state.status();
  const std::map<SubmapId, Rigid2>& poses = state->pose_graph.submap_poses;
  std::vector<GridFootprint> footprints;
  for (const auto& [id, summary] : state->submaps) {
    const auto pose = poses.find(id);
    if (pose != poses.end()) {
      footprints.push_back({summary.geometry, pose->second});
    }
  }
  UnionGrid united(footprints);
  const absl::Status status =
      ReadMap(source,
              {[&](const SubmapId& id, const SubmapSummary&,
                   const OccupancyGrid& grid) {
                const auto pose = poses.find(id);
                if (pose != poses.end()) united.Add(grid, pose->second);
              }},
              HalfOf(on_progress, 0.5))
          .status();
  if (!status.ok()) return status;
  std::optional<OccupancyGrid> grid = united.Finish();
  if (!grid) {
    return absl::FailedPreconditionError(
        absl::StrCat(source.path, " has no submap with known cells"));
  }
  MapGrid map{*std::move(grid), {}};
  for (const auto& [id, node] : state->pose_graph.nodes) {
    map.driven_positions.push_back(node.T_map_node.translation());
  }
  return map;
}

}  // namespace cartographer_sdf
