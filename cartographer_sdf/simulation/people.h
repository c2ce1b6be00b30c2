// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// People in a building while a robot drives through it: some walk all the time,
// others stand for a while in changing places. The lidar sees them as discs.
// They keep away from walls and out of the robot's way.

#ifndef CARTOGRAPHER_SDF_SIMULATION_PEOPLE_H_
#define CARTOGRAPHER_SDF_SIMULATION_PEOPLE_H_

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/simulation/floor_plan.h"

namespace cartographer_sdf {

struct PeopleOptions {
  int num_walking = 0;
  int num_standing = 0;
};

[[nodiscard]] std::string Validate(const PeopleOptions& options);

// In the world frame [m].
struct Person {
  Eigen::Vector2d position;
  double radius = 0.;
};

// Default-constructed, there are no people.
struct People {
  static constexpr double kRadius = 0.2;        // of each [m]
  static constexpr double kWalkingSpeed = 1.2;  // [m/s]
  // Time that a person stands in one place [s].
  static constexpr double kStandingTime = 120.;
  // Least distance between the centres of robot and person [m].
  static constexpr double kRobotSpace = 0.6;

  // For each walking person, the positions every kTimeStep; for each standing
  // person, a position per kStandingTime and an individual time shift.
  static constexpr double kTimeStep = 0.1;  // [s]
  std::vector<std::vector<Eigen::Vector2d>> walks;
  std::vector<std::vector<Eigen::Vector2d>> stands;
  std::vector<double> shifts;

  // Everyone farther than `kRobotSpace` from the robot; the others have stepped
  // aside. Times beyond the duration yield the positions at its end.
  [[nodiscard]] std::vector<Person> At(double seconds,
                                       const Rigid2& T_world_robot) const;
};

// Places people for `duration` seconds. Deterministic. Fails if the plan has no
// room for people.
[[nodiscard]] absl::StatusOr<People> PlacePeople(const FloorPlan& plan,
                                                 const PeopleOptions& options,
                                                 double duration,
                                                 uint32_t seed);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_SIMULATION_PEOPLE_H_
