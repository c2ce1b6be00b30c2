// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef TEST_FUZZ_DRAWN_ROOM_H_
#define TEST_FUZZ_DRAWN_ROOM_H_

#include <optional>
#include <utility>

#include "cartographer_sdf/localization/panorama_file.h"
#include "glog/logging.h"
#include "test/testing/rectangular_room.h"

namespace cartographer_sdf::fuzz {

// Of a room of 5 m by 3 m, with few viewpoints.
inline DrawnMap DrawRoom() {
  CellGeometry geometry;
  geometry.size = {60, 40};
  geometry.resolution = 0.1;
  geometry.T_submap_grid = Rigid2(-3., -2., 0.);
  const OccupancyGrid grid = RectangularRoom(5., 3., 0.2, geometry);
  ViewpointOptions options;
  options.step_meters = 1.;
  std::optional<PanoramaMap> panoramas = MakePanoramaMap(options, grid, {});
  CHECK(panoramas.has_value());
  return {grid, *std::move(panoramas)};
}

// Of poses that came out.
inline void CheckCandidates(const ScanLocalization& found) {
  for (const ScanCandidate& candidate : found.candidates) {
    CHECK(candidate.T_map_robot.translation().allFinite());
    CHECK(candidate.probability >= 0. && candidate.probability <= 1.);
    CHECK(candidate.covariance.allFinite());
  }
}

}  // namespace cartographer_sdf::fuzz

#endif  // TEST_FUZZ_DRAWN_ROOM_H_
