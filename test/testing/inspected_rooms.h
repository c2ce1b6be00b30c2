// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// An inspection of two rooms beside each other, of two trajectories, before and
// after.

#ifndef TEST_TESTING_INSPECTED_ROOMS_H_
#define TEST_TESTING_INSPECTED_ROOMS_H_

#include "cartographer_sdf/report/inspection.h"
#include "cartographer_sdf/report/inspection_maps.h"
#include "test/testing/rectangular_room.h"

namespace cartographer_sdf::testing {

class InspectedRooms {
 public:
  InspectedRooms() {
    for (const int trajectory : {0, 1}) {
      const SubmapId id{trajectory, 0};
      before.submap_poses[id] = Rigid2(9. * trajectory, 0., 0.);
      after.submap_poses[id] = Rigid2(4.1 * trajectory, 0., 0.);
      for (PoseGraph* const graph : {&before, &after}) {
        for (const int k : {0, 1}) {
          Node& node = graph->nodes[{trajectory, k}];
          node.time = int64_t{k} * 5 * kTicksPerSecond;
          node.T_map_node = graph->submap_poses[id] * Rigid2(0.5 * k, 0.25, 0.);
        }
      }
      inspection.submaps[id] = {room_.geometry, id};
    }
    inspection.title = "two rooms";
    inspection.verdict = "They are joined.";
    inspection.sessions = {{"rooms"}};
    inspection.states = {{"before", "Before", "as it was", &before},
                         {"after", "After", "as it is", &after}};
    InspectedRow row;
    row.status = "in_graph";
    // The left wall of the second is the right one of the first.
    row.pair = {{0, 0}, {1, 0}, Rigid2(4.1, 0., 0.), 1.};
    row.values = {12.345};
    inspection.tables = {{"closures",
                          "Closures",
                          "",
                          {{"score", "score", "", 1, "How sure.", true,
                            Measure::Bound::kAtLeast, 4., "a.b.min_score"}},
                          {{"in_graph", "in the graph", Tone::kGood, "It is."}},
                          {row}}};
    options.map_picture_pixels = 300;
    options.submap_picture_pixels = 50;
  }
  InspectedRooms(const InspectedRooms&) = delete;
  InspectedRooms& operator=(const InspectedRooms&) = delete;

  [[nodiscard]] absl::Status Draw() {
    return DrawInspection(
        options,
        [this](const SubmapCallback& on_submap) {
          ++num_readings;
          for (const auto& [id, submap] : inspection.submaps) {
            on_submap(id, {}, room_);
          }
          return absl::OkStatus();
        },
        &inspection);
  }

  ReportOptions options;
  Inspection inspection;
  PoseGraph before, after;
  int num_readings = 0;

 private:
  const OccupancyGrid room_ = RectangularRoom(
      4., 3., 0.1, CellGeometry{{100, 80}, 0.05, Rigid2(-2.5, -2., 0.)});
};

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_INSPECTED_ROOMS_H_
