// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A corridor of equal rooms, and matches of the submaps in it.

#ifndef TEST_TESTING_CORRIDOR_MAP_H_
#define TEST_TESTING_CORRIDOR_MAP_H_

#include <map>
#include <optional>

#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/place/trajectory_places.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/neighbourhood.h"
#include "cartographer_sdf/recognition/trajectory_links.h"
#include "test/testing/two_visits.h"

namespace cartographer_sdf::testing {

// One room every 10 m, each seen by one submap, of which nothing but the pose
// is known.
class CorridorMap {
 public:
  CorridorMap() {
    for (int index = 0; index < 20; ++index) {
      places_[{0, index}] = Place();
      odometry_[{0, index}] = {Rigid2(10. * index, 0., 0.), 10. * index};
    }
  }

  [[nodiscard]] NeighbourhoodMaps Within() const {
    return {{&places_, &odometry_}, {&places_, &odometry_}, 3};
  }
  [[nodiscard]] NeighbourhoodMaps Between() const {
    return {{&places_, &odometry_}, {&places_, &odometry_}, std::nullopt};
  }

 private:
  std::map<SubmapId, Place> places_;
  std::map<SubmapId, OdometryPose> odometry_;
};

inline Match AcceptedMatch(const int reference, const int query,
                           const Rigid2& pose, const double score) {
  Match match;
  match.pair = {{0, reference}, {0, query}, pose, score};
  match.verdict = Verdict::kAccepted;
  return match;
}

// Those of a trajectory whose link from submap 10 to 12 is broken.
inline TrajectoryLinks LinksBrokenAtTen() {
  const TwoVisits visits;
  const SlippedVisit slipped(visits);
  return TrajectoryLinks(TrajectoryLinkOptions(), VerificationOptions(),
                         slipped.Places(), MakeExecutor(1));
}

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_CORRIDOR_MAP_H_
