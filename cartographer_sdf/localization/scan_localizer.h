// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Where in a map is a robot that stands still, by one scan or a few: all poses
// that explain them, each with its probability, and the probability that the
// robot is elsewhere, where the map never was.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_SCAN_LOCALIZER_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_SCAN_LOCALIZER_H_

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/grid/scan.h"
#include "cartographer_sdf/localization/echo_search.h"
#include "cartographer_sdf/localization/ray_map.h"
#include "cartographer_sdf/localization/scan_judgement.h"
#include "cartographer_sdf/localization/viewpoints.h"

namespace cartographer_sdf {

struct ScanLocalizationOptions {
  ViewpointOptions viewpoints;
  // Poses of the search by panoramas that are registered. Larger: slower, and
  // less likely that the right one is missed.
  int num_registered_poses = 200;
  // The same of the search by echoes alone (echo_search.h).
  int num_echo_poses = 100;
  // Fewer beams, of one per degree, show too little.
  int min_num_beams = 30;
  // Points farther from the sensor are left out [m].
  double max_range_meters = 60.;
  CandidateWeights candidate_weights;
  PresenceWeights presence_weights;
  // Least probability of a pose that is certain.
  double min_probability = 0.99;
};
[[nodiscard]] std::string Validate(const ScanLocalizationOptions& options);

// What localising scans needs of a map, computed once.
struct PanoramaMap {
  RayMap rays;
  Viewpoints viewpoints;
  EchoMap echoes;
};

// The grid's submap frame is the map frame. `driven_positions` [m, map frame]:
// see ReachableCells(). Nullopt where the map has no wall or no place for a
// robot.
[[nodiscard]] std::optional<PanoramaMap> MakePanoramaMap(
    const ViewpointOptions& options, const OccupancyGrid& grid,
    const std::vector<Eigen::Vector2d>& driven_positions);

// Of viewpoints that were made of the map before.
[[nodiscard]] PanoramaMap MakePanoramaMap(RayMap rays, Viewpoints viewpoints);

// The first part of LocalizeScans: searches by panoramas and by echoes, and
// registers with few beams. Returns distinct poses of the robot in the grid
// frame, the best first.
[[nodiscard]] std::vector<Rigid2> FindLikelyPoses(
    const ScanLocalizationOptions& options, const PanoramaMap& map,
    const std::vector<RobotScan>& scans,
    std::vector<std::pair<std::string, double>>* stage_seconds);

// Of scans from one place. Deterministic; uses one thread.
[[nodiscard]] ScanLocalization LocalizeScans(
    const ScanLocalizationOptions& options, const PanoramaMap& map,
    const std::vector<RobotScan>& scans);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_SCAN_LOCALIZER_H_
