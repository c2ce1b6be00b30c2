// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// One drive that sees two rooms, and later both again.

#ifndef TEST_TESTING_TWO_VISITS_H_
#define TEST_TESTING_TWO_VISITS_H_

#include <iterator>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/neighbourhood.h"
#include "test/testing/building.h"

namespace cartographer_sdf::testing {

class TwoVisits {
 public:
  static constexpr SubmapId kWestFirst{0, 0};
  static constexpr SubmapId kEastFirst{0, 2};
  static constexpr SubmapId kWestAgain{0, 10};
  static constexpr SubmapId kEastAgain{0, 12};

  // Local SLAM is exact but for the way between the rooms on the second visit,
  // and lost in between the visits.
  explicit TwoVisits(const Rigid2& T_room_driftedroom = {}) {
    Add(kWestFirst, Rigid2(3., 2., 0.4), WestRoomViewpoints(), {});
    Add(kEastFirst, Rigid2(12., 2., 1.4), EastRoomViewpoints(), {});
    const Rigid2 lost(7., -40., 2.);
    Add(kWestAgain, Rigid2(4., 3., -1.),
        {{2.2, 2.4}, {4.4, 3.2}, {6.3, 4.2}, {2., 1.}}, lost);
    Add(kEastAgain, Rigid2(13., 1., 0.2),
        {{10.8, 2.4}, {11.2, -0.6}, {13.8, 1.}, {13.3, 3.2}}, lost);
    OdometryPose& last = odometry_.at(kEastAgain);
    last.T_local_submap = last.T_local_submap * T_room_driftedroom;
  }

  [[nodiscard]] TrajectoryPlaces Places() const {
    return {&places_, &odometry_};
  }
  [[nodiscard]] const Rigid2& T_world_submap(const SubmapId& id) const {
    return T_world_submap_.at(id);
  }
  [[nodiscard]] Rigid2 T_west_first_west_again() const {
    return T_world_submap(kWestFirst).Inverse() * T_world_submap(kWestAgain);
  }

 private:
  void Add(const SubmapId& id, const Rigid2& T_world_submap,
           const Viewpoints& viewpoints, const Rigid2& T_local_world) {
    std::optional<Place> place = DescribePlace(
        PlaceOptions(), id, SeeFrom(TwoRooms(), T_world_submap, viewpoints));
    CHECK(place.has_value());
    places_.emplace(id, *std::move(place));
    T_world_submap_[id] = T_world_submap;
    odometry_[id] = {T_local_world * T_world_submap, 10. * id.index};
  }

  std::map<SubmapId, Place> places_;
  std::map<SubmapId, OdometryPose> odometry_;
  std::map<SubmapId, Rigid2> T_world_submap_;
};

// Of more visits: those after the second see what the second does. Their west
// rooms match each other by themselves, as if the features of the east rooms
// had failed.
class ManyVisits {
 public:
  explicit ManyVisits(const int num_visits) {
    const TwoVisits visits;
    for (int k = 0; k < num_visits; ++k) {
      Add(visits, k == 0 ? TwoVisits::kWestFirst : TwoVisits::kWestAgain,
          West(k), 100. * k);
      Add(visits, k == 0 ? TwoVisits::kEastFirst : TwoVisits::kEastAgain,
          East(k), 100. * k);
    }
  }

  static SubmapId West(const int visit) { return {0, 10 * visit}; }
  static SubmapId East(const int visit) { return {0, 10 * visit + 2}; }

  [[nodiscard]] TrajectoryPlaces Places() const {
    return {&places_, &odometry_};
  }
  [[nodiscard]] Match WestMatch(const int reference, const int query) const {
    std::optional<Match> match = MatchPlaces(
        MatchOptions(), places_.at(West(reference)), places_.at(West(query)));
    CHECK(match.has_value());
    return *std::move(match);
  }
  [[nodiscard]] std::vector<Match> WestMatches() const {
    std::vector<Match> matches;
    for (auto a = places_.begin(); a != places_.end(); ++a) {
      for (auto b = std::next(a); b != places_.end(); ++b) {
        const int first = a->first.index, second = b->first.index;
        if (first % 10 != 0 || second % 10 != 0) continue;
        matches.push_back(WestMatch(first / 10, second / 10));
      }
    }
    return matches;
  }

 private:
  void Add(const TwoVisits& visits, const SubmapId& original,
           const SubmapId& id, const double distance_driven) {
    Place place = visits.Places().places->at(original);
    place.id = id;
    places_.emplace(id, std::move(place));
    odometry_[id] = visits.Places().odometry->at(original);
    odometry_[id].distance_driven += distance_driven;
  }

  std::map<SubmapId, Place> places_;
  std::map<SubmapId, OdometryPose> odometry_;
};

// A visit that sees the west room twice, as the submaps kWestAgain and
// kEastAgain, between which local SLAM slips by two metres and a quarter turn.
class SlippedVisit {
 public:
  explicit SlippedVisit(const TwoVisits& visits,
                        const Rigid2& slip = Rigid2(2., 0., 1.57)) {
    const Place& first = visits.Places().places->at(TwoVisits::kWestAgain);
    Place second = visits.Places().places->at(TwoVisits::kWestFirst);
    second.id = TwoVisits::kEastAgain;
    places_.emplace(first.id, first);
    places_.emplace(second.id, second);
    odometry_[first.id] = {Rigid2(), 0.};
    odometry_[second.id] = {visits.T_west_first_west_again().Inverse() * slip,
                            20.};
  }

  [[nodiscard]] TrajectoryPlaces Places() const {
    return {&places_, &odometry_};
  }

 private:
  std::map<SubmapId, Place> places_;
  std::map<SubmapId, OdometryPose> odometry_;
};

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_TWO_VISITS_H_
