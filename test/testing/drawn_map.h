// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Drawn buildings as a robot knows them, and what it sees in them where it
// stands.

#ifndef TEST_TESTING_DRAWN_MAP_H_
#define TEST_TESTING_DRAWN_MAP_H_

#include <algorithm>
#include <cmath>
#include <vector>

#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/grid/scan.h"
#include "test/testing/building.h"

namespace cartographer_sdf::testing {

// The two rooms and their corridor, in the world frame.
inline OccupancyGrid TwoRoomsGrid() {
  Viewpoints viewpoints = WestRoomViewpoints();
  for (const Eigen::Vector2d& point : EastRoomViewpoints()) {
    viewpoints.push_back(point);
  }
  for (const double x : {-2., 1., 5.5, 8., 10.6, 13.}) {
    viewpoints.emplace_back(x, 6.1);
  }
  return SeeFrom(TwoRooms(), Rigid2(), viewpoints);
}

// Whether one of the poses is as near to the truth as a search is fine.
inline bool HasPoseNear(const std::vector<Rigid2>& poses, const Rigid2& truth) {
  return std::any_of(poses.begin(), poses.end(), [&truth](const Rigid2& pose) {
    return (pose.translation() - truth.translation()).norm() < 0.4 &&
           std::abs(NormalizeAngle(pose.rotation() - truth.rotation())) < 0.1;
  });
}

// Whether the few are the first of the many, which are more.
inline bool AreFirstOf(const std::vector<Rigid2>& few,
                       const std::vector<Rigid2>& many) {
  return few.size() < many.size() &&
         std::equal(few.begin(), few.end(), many.begin(),
                    [](const Rigid2& a, const Rigid2& b) {
                      return a.translation() == b.translation() &&
                             a.rotation() == b.rotation();
                    });
}

// Echoes in the robot's frame, of beams all round that go no farther than 9 m.
inline RobotScan ScanFrom(const Building& building,
                          const Rigid2& T_world_robot) {
  RobotScan scan;
  for (const SurfacePoint& point : TakeScan(building, T_world_robot)) {
    scan.scan.returns.push_back(point.position.cast<float>());
  }
  return scan;
}

// Only what lies within half of the field of view of straight ahead.
inline RobotScan Narrowed(const RobotScan& scan, const double field_of_view) {
  RobotScan narrowed = scan;
  narrowed.scan.returns.clear();
  for (const Eigen::Vector2f& point : scan.scan.returns) {
    if (std::abs(std::atan2(point.y(), point.x())) <= 0.5 * field_of_view) {
      narrowed.scan.returns.push_back(point);
    }
  }
  return narrowed;
}

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_DRAWN_MAP_H_
