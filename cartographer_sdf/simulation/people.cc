// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/people.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "absl/status/status.h"
#include "cartographer_sdf/geometry/number_range.h"
#include "cartographer_sdf/simulation/drive.h"
#include "cartographer_sdf/simulation/path_planner.h"
#include "cartographer_sdf/simulation/random_numbers.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Least distance between a person's centre and walls [m].
constexpr double kClearance = 0.3;

using Places = std::vector<Eigen::Vector2d>;

const Eigen::Vector2d& AtOrLast(const Places& places, const double index) {
  CHECK(!places.empty());
  return places[std::min(static_cast<size_t>(std::max(0., index)),
                         places.size() - 1)];
}

// Positions of a walking person, every People::kTimeStep.
absl::StatusOr<Places> Walk(const FloorPlan& plan, const double duration,
                            RandomNumbers* const random) {
  DriveOptions walk;
  walk.clearance = kClearance;
  walk.speed = People::kWalkingSpeed;
  // Turns on the spot take time without walking.
  walk.length = std::max(1., walk.speed * duration);
  walk.turn_rate = 3.;
  walk.time_step = People::kTimeStep;
  const absl::StatusOr<std::vector<DrivenPose>> driven =
      Drive(plan, walk, static_cast<uint32_t>(random->Index(1 << 30)));
  if (!driven.ok()) return driven.status();
  Places places;
  for (const DrivenPose& pose : *driven) {
    places.push_back(pose.T_world_robot.translation());
  }
  return places;
}

// All places where a person can stand.
Places FindRoom(const FloorPlan& plan) {
  const NavigationGrid grid = MakeNavigationGrid(plan, kClearance);
  Places room;
  for (int j = 0; j != grid.geometry.size.y(); ++j) {
    for (int i = 0; i != grid.geometry.size.x(); ++i) {
      if (!grid.reachable(i, j)) continue;
      room.push_back(grid.geometry.CellCentre({i, j}));
    }
  }
  return room;
}

Places DrawPlaces(const Places& room, const int num_places,
                  RandomNumbers* const random) {
  Places places;
  for (int n = 0; n != num_places; ++n) {
    places.push_back(room[random->Index(static_cast<int>(room.size()))]);
  }
  return places;
}

}  // namespace

std::string Validate(const PeopleOptions& options) {
  return FirstOutside({{"num_walking", options.num_walking, 0, 100},
                       {"num_standing", options.num_standing, 0, 1000}});
}

std::vector<Person> People::At(const double seconds,
                               const Rigid2& T_world_robot) const {
  std::vector<Person> people;
  const auto add = [&](const Eigen::Vector2d& position) {
    if ((position - T_world_robot.translation()).norm() > kRobotSpace) {
      people.push_back({position, kRadius});
    }
  };
  for (const auto& walk : walks) add(AtOrLast(walk, seconds / kTimeStep));
  for (size_t k = 0; k != stands.size(); ++k) {
    add(AtOrLast(stands[k], seconds / kStandingTime + shifts[k]));
  }
  return people;
}

absl::StatusOr<People> PlacePeople(const FloorPlan& plan,
                                   const PeopleOptions& options,
                                   const double duration, const uint32_t seed) {
  CHECK_EQ(Validate(options), "");
  People people;
  RandomNumbers random(seed, RandomStream::kPeople);
  for (int k = 0; k != options.num_walking; ++k) {
    absl::StatusOr<Places> walk = Walk(plan, duration, &random);
    if (!walk.ok()) return walk.status();
    people.walks.push_back(*std::move(walk));
  }
  if (options.num_standing == 0) return people;
  const Places room = FindRoom(plan);
  if (room.empty()) {
    return absl::InvalidArgumentError("the floor plan has no room for people");
  }
  const int num_stands =
      static_cast<int>(std::ceil(duration / People::kStandingTime)) + 1;
  for (int k = 0; k != options.num_standing; ++k) {
    people.shifts.push_back(random.Uniform(0., 1.));
    people.stands.push_back(DrawPlaces(room, num_stands, &random));
  }
  return people;
}

}  // namespace cartographer_sdf
