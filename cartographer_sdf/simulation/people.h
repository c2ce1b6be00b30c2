// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// People in a building while a robot drives through it: some walk all the time,
// some stand for a while here and then there. Seen as discs, as high as the
// lidar. They keep away from walls and out of the robot's way.

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

// Nobody, as they are made.
struct People {
  static constexpr double kRadius = 0.2;        // of each [m]
  static constexpr double kWalkingSpeed = 1.2;  // [m/s]
  // How long one stands in a place [s].
  static constexpr double kStandingTime = 120.;
  // Between the centres of robot and person [m].
  static constexpr double kRobotSpace = 0.6;

  // For each who walks, the places every kTimeStep; for each who stands, those
  // of each kStandingTime, shifted by a time of one's own.
  static constexpr double kTimeStep = 0.1;  // [s]
  std::vector<std::vector<Eigen::Vector2d>> walks;
  std::vector<std::vector<Eigen::Vector2d>> stands;
  std::vector<double> shifts;

  // All who are farther than `kRobotSpace` from the robot; the others have
  // stepped aside. Times beyond the duration: as at its end.
  [[nodiscard]] std::vector<Person> At(double seconds,
                                       const Rigid2& T_world_robot) const;
};

// For `duration` seconds; the same for the same arguments. An error where the
// plan has no room for people.
[[nodiscard]] absl::StatusOr<People> PlacePeople(const FloorPlan& plan,
                                                 const PeopleOptions& options,
                                                 double duration,
                                                 uint32_t seed);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_SIMULATION_PEOPLE_H_
