// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Two maps that are alike but for a wall: of a bare hall, 14 m x 10 m, in one
// submap, and in two, of which the first has a straight wall along the middle,
// with a way round it at either end.

#ifndef TEST_TESTING_DIVIDED_HALL_H_
#define TEST_TESTING_DIVIDED_HALL_H_

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/neighbourhood.h"
#include "test/testing/building.h"

namespace cartographer_sdf::testing {

struct DividedHall {
  static constexpr SubmapId kHall{0, 0}, kDivided{1, 0}, kBefore{1, 2};

  explicit DividedHall(const double wall_length) {
    const Building bare = BareRoom(14., 10.);
    Building with_wall = bare;
    with_wall.push_back(
        Wall({-0.5 * wall_length, 0.}, {0.5 * wall_length, 0.}));
    Add(&hall, {kHall}, {bare});
    Add(&divided, {kDivided, kBefore}, {with_wall, bare});
  }

  // At the same place.
  [[nodiscard]] static Match MakeMatch(const double score) {
    Match match;
    match.pair = {kHall, kDivided, Rigid2(), score};
    match.pair_score = score;
    match.verdict = Verdict::kAccepted;
    return match;
  }

  [[nodiscard]] NeighbourhoodMaps Maps() const {
    return {{&hall.places, &hall.odometry},
            {&divided.places, &divided.odometry},
            std::nullopt};
  }

  struct Map {
    std::map<SubmapId, Place> places;
    std::map<SubmapId, OdometryPose> odometry;
  };
  Map hall, divided;

 private:
  static void Add(Map* const map, const std::vector<SubmapId>& ids,
                  const std::vector<Building>& buildings) {
    for (size_t k = 0; k < ids.size(); ++k) {
      map->places.emplace(ids[k], *DescribePlace(PlaceOptions(), ids[k],
                                                 SeeFrom(buildings[k], {},
                                                         {{-4., -3.},
                                                          {-4., 3.},
                                                          {4., -3.},
                                                          {4., 3.},
                                                          {0., 3.},
                                                          {0., -3.}})));
      map->odometry[ids[k]].distance_driven = static_cast<double>(k);
    }
  }
};

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_DIVIDED_HALL_H_
