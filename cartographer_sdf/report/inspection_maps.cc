// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/inspection_maps.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace cartographer_sdf {
namespace {

// Of all pictures that are painted at the same time: twelve bytes each.
constexpr double kMaxPaintedPixels = 24e6;

// The grids of one state in the map frame.
std::vector<PlacedGrid> GridsOf(const Inspection& inspection,
                                const PoseGraph& pose_graph,
                                const Rigid2& T_map_state) {
  std::vector<PlacedGrid> grids;
  for (const auto& [id, submap] : inspection.submaps) {
    const auto pose = pose_graph.submap_poses.find(id);
    if (pose == pose_graph.submap_poses.end()) continue;
    grids.push_back({submap.geometry, T_map_state * pose->second});
  }
  return grids;
}

// Paints all states at once, a painter for each session.
class StatesPainter {
 public:
  StatesPainter(const Inspection& inspection, const int max_pixels)
      : inspection_(inspection), T_map_states_(AlignStates(inspection.states)) {
    std::vector<PlacedGrid> all;
    for (size_t k = 0; k < inspection.states.size(); ++k) {
      for (const PlacedGrid& grid :
           GridsOf(inspection, *inspection.states[k].pose_graph,
                   T_map_states_[k])) {
        all.push_back(grid);
      }
    }
    const size_t num_painters =
        inspection.states.size() * inspection.sessions.size();
    const int affordable = static_cast<int>(
        std::sqrt(kMaxPaintedPixels /
                  static_cast<double>(std::max<size_t>(1, num_painters))));
    const MapPainter empty(all, std::clamp(max_pixels, 1, affordable));
    painters_.assign(
        inspection.states.size(),
        std::vector<MapPainter>(inspection.sessions.size(), empty));
    is_empty_ = all.empty();
  }

  void AddSubmap(const SubmapId& id, const OccupancyGrid& grid) {
    const auto submap = inspection_.submaps.find(id);
    if (submap == inspection_.submaps.end()) return;
    for (size_t k = 0; k < painters_.size(); ++k) {
      const PoseGraph& pose_graph = *inspection_.states[k].pose_graph;
      const auto pose = pose_graph.submap_poses.find(id);
      if (pose == pose_graph.submap_poses.end()) continue;
      painters_[k][submap->second.session].AddSubmap(
          grid, T_map_states_[k] * pose->second);
    }
  }

  void Finish(DrawnMaps* const drawn) const {
    if (is_empty_ || painters_.empty()) return;
    drawn->frame = painters_.front().front().frame();
    const Eigen::Array2i size = painters_.front().front().size();
    drawn->width = size.x();
    drawn->height = size.y();
    for (const std::vector<MapPainter>& sessions : painters_) {
      drawn->states.push_back(PictureOf(sessions));
    }
  }

 private:
  static StatePicture PictureOf(const std::vector<MapPainter>& sessions) {
    StatePicture picture;
    if (sessions.size() == 1) {
      picture.png = PaintIndexed(sessions.front(), kBlack).EncodePng();
      return picture;
    }
    picture.png = PaintOverlaid(sessions).EncodePng();
    picture.conflict_share = ConflictShare(sessions);
    for (size_t k = 0; k < sessions.size(); ++k) {
      picture.session_pngs.push_back(
          PaintWalls(sessions[k], CategoryColor(static_cast<int>(k)))
              .EncodePng());
    }
    return picture;
  }

  const Inspection& inspection_;
  const std::vector<Rigid2> T_map_states_;
  std::vector<std::vector<MapPainter>> painters_;
  bool is_empty_ = true;
};

// Of the pairs of rows, the first ones first.
std::set<SubmapId> SubmapsToPicture(const Inspection& inspection,
                                    const size_t max_num) {
  std::set<SubmapId> wanted;
  for (const InspectedTable& table : inspection.tables) {
    for (const InspectedRow& row : table.rows) {
      if (!row.pair) continue;
      std::set<SubmapId> more = {row.pair->reference, row.pair->query};
      more.insert(wanted.begin(), wanted.end());
      if (more.size() > max_num) return wanted;
      wanted = std::move(more);
    }
  }
  return wanted;
}

void FindOverlaps(Inspection* const inspection) {
  const std::map<SubmapId, SubmapRaster>& rasters = inspection->drawn.submaps;
  for (InspectedTable& table : inspection->tables) {
    for (InspectedRow& row : table.rows) {
      if (!row.pair) continue;
      const auto reference = rasters.find(row.pair->reference);
      const auto query = rasters.find(row.pair->query);
      if (reference == rasters.end() || query == rasters.end()) continue;
      row.p_reference_overlap = WhereWallsOverlap(
          reference->second, query->second, row.pair->T_reference_query);
    }
  }
}

}  // namespace

std::vector<PlacedGrid> PlaceGrids(const MapState& state,
                                   const PoseGraph& pose_graph) {
  std::vector<PlacedGrid> grids;
  for (const auto& [id, submap] : state.submaps) {
    const auto pose = pose_graph.submap_poses.find(id);
    if (pose != pose_graph.submap_poses.end()) {
      grids.push_back({submap.geometry, pose->second});
    }
  }
  return grids;
}

std::map<int, std::vector<Eigen::Vector2d>> PathsOf(
    const PoseGraph& pose_graph) {
  std::map<int, std::vector<Eigen::Vector2d>> paths;
  for (const auto& [id, node] : pose_graph.nodes) {
    paths[id.trajectory].push_back(node.T_map_node.translation());
  }
  return paths;
}

absl::Status DrawInspection(const ReportOptions& options,
                            const SubmapsReader& read_submaps,
                            Inspection* const inspection) {
  const std::set<SubmapId> wanted = SubmapsToPicture(
      *inspection, static_cast<size_t>(options.max_submap_pictures));
  StatesPainter painter(*inspection, options.map_picture_pixels);
  DrawnMaps* const drawn = &inspection->drawn;
  const absl::Status status = read_submaps(
      [&](const SubmapId& id, const SubmapSummary&, const OccupancyGrid& grid) {
        painter.AddSubmap(id, grid);
        if (wanted.count(id) == 0) return;
        SubmapRaster raster =
            RasterizeSubmap(grid, options.submap_picture_pixels);
        if (!raster.cells.empty()) drawn->submaps[id] = std::move(raster);
      });
  if (!status.ok()) return status;
  painter.Finish(drawn);
  FindOverlaps(inspection);
  return absl::OkStatus();
}

}  // namespace cartographer_sdf
