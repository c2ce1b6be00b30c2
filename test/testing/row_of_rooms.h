// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A building of equal rooms in a row, of which nothing within tells one from
// the next.

#ifndef TEST_TESTING_ROW_OF_ROOMS_H_
#define TEST_TESTING_ROW_OF_ROOMS_H_

#include <map>
#include <utility>

#include "cartographer_sdf/localization/placement.h"
#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/recognition/match.h"
#include "test/testing/building.h"

namespace cartographer_sdf::testing {

// From one to the next [m].
constexpr double kRoom = 4.;

// A corridor along x, from -14 m to 14 m, with a row of seven rooms above, each
// with a table at the same place. As far as they are not equal, every other
// room is wider at the cost of the next.
inline Building RowOfRooms(const double difference = 0.) {
  constexpr double kFirst = -14., kLast = 14., kDoorway = 2.6, kUpper = 6.6;
  Building row = {
      Wall({kFirst, 0.}, {kLast, 0.}), Wall({kFirst, kUpper}, {kLast, kUpper}),
      Wall({kFirst, 0.}, {kFirst, kUpper}), Wall({kLast, 0.}, {kLast, kUpper})};
  for (int k = 0; k < 7; ++k) {
    const double x = kFirst + k * kRoom + (k % 2) * difference;
    const double end = kFirst + (k + 1) * kRoom + ((k + 1) % 2) * difference;
    row.push_back(Wall({x, kDoorway}, {x, kUpper}));
    row.push_back(Wall({x, kDoorway}, {x + 1.2, kDoorway}));
    row.push_back(Wall({x + 2.4, kDoorway}, {end, kDoorway}));
    row.push_back(Furniture(x + 1., 5.6, 1.2, 0.8, 0.));
  }
  return row;
}

struct MapOfRow {
  std::map<SubmapId, Place> places;
  MapLayout layout{{}, {}, {}, DrivenDistances({}, {})};
};

// A submap from so far along the corridor to so far, with every room between.
inline MapOfRow SeeRooms(const Building& building, const double first,
                         const double last) {
  Viewpoints viewpoints;
  for (double x = first; x <= last; x += 1.) {
    viewpoints.push_back({x, 1.3});
  }
  for (double x = -12.; x <= 12.; x += kRoom) {
    if (x >= first && x <= last) viewpoints.push_back({x, 4.2});
  }
  const SubmapId id{0, 0};
  Place place =
      *DescribePlace(PlaceOptions(), id, SeeFrom(building, {}, viewpoints));
  FindSelfSimilarities(MatchOptions(), &place);
  PoseGraph graph;
  graph.submap_poses[id] = Rigid2();
  MapOfRow map;
  map.places.emplace(id, std::move(place));
  map.layout = MakeMapLayout(graph, {{id, OdometryPose()}}, map.places);
  return map;
}

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_ROW_OF_ROOMS_H_
