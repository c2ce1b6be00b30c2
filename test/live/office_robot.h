// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A robot that drives through a simulated office and feeds a map builder, be it
// a remote one.

#ifndef TEST_LIVE_OFFICE_ROBOT_H_
#define TEST_LIVE_OFFICE_ROBOT_H_

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "cartographer/common/time.h"
#include "cartographer/mapping/map_builder_interface.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/simulation/drive.h"
#include "cartographer_sdf/simulation/lidar.h"
#include "cartographer_sdf/simulation/office.h"
#include "glog/logging.h"
#include "test/live/host.h"

namespace cartographer_sdf::testing {

// Cartographer does without loop closing of its own, and optimises often. Its
// prediction lags behind turns where it has no IMU, hence its search.
inline constexpr char kWithoutOwnSearch[] =
    "TRAJECTORY_BUILDER_2D.use_online_correlative_scan_matching = true\n"
    "POSE_GRAPH.constraint_builder.sampling_ratio = 0.\n"
    "POSE_GRAPH.global_sampling_ratio = 0.\n"
    "POSE_GRAPH.optimize_every_n_nodes = 5\n"
    "TRAJECTORY_BUILDER_2D.submaps.num_range_data = 30\n";
// Between two scans, so that the motion filter keeps each.
inline constexpr double kStep = 0.25;     // [m]
inline constexpr double kTimeStep = 0.5;  // [s]

struct DrivenOffice {
  FloorPlan plan;
  std::vector<Rigid2> poses;  // T_world_robot, a step apart
};

// A round trip, and parts of it again.
inline const DrivenOffice& TheDrivenOffice() {
  static const DrivenOffice* const kInstance = [] {
    auto* const office = new DrivenOffice;
    office->plan = MakeOffice(OfficeOptions(), 3);
    DriveOptions drive;
    drive.length = 130.;
    const auto driven = Drive(office->plan, drive, 5);
    CHECK(driven.ok()) << driven.status();
    for (const DrivenPose& pose : *driven) {
      const Rigid2& T_world_robot = pose.T_world_robot;
      if (office->poses.empty() ||
          (office->poses.back().translation() - T_world_robot.translation())
                  .norm() >= kStep ||
          std::abs(
              (office->poses.back().Inverse() * T_world_robot).rotation()) >=
              0.1) {
        office->poses.push_back(T_world_robot);
      }
    }
    return office;
  }();
  return *kInstance;
}

class Robot {
 public:
  Robot(cartographer::mapping::MapBuilderInterface* const map_builder,
        const int trajectory_id, const unsigned seed)
      : map_builder_(map_builder),
        trajectory_id_(trajectory_id),
        random_(seed) {}

  // `stop` returns whether it is enough.
  void Drive(const std::vector<Rigid2>& poses,
             const std::function<bool()>& stop = {}) {
    LidarOptions lidar;
    lidar.num_beams = 240;
    for (const Rigid2& T_world_robot : poses) {
      seconds_ += kTimeStep;
      // Odometry starts anywhere; here it is that good, and that dense, that
      // the map is as the building.
      if (!T_world_odometry_) T_world_odometry_ = T_world_robot;
      const Rigid2 T_odometry_robot =
          T_world_odometry_->Inverse() * T_world_robot;
      constexpr int kNumOdometry = 10;
      const Rigid2 moved = T_odometry_previous_.Inverse() * T_odometry_robot;
      for (int k = 1; k <= kNumOdometry; ++k) {
        const double fraction = static_cast<double>(k) / kNumOdometry;
        FeedOdometry(
            map_builder_, trajectory_id_,
            seconds_ + (fraction - 1.) * kTimeStep,
            T_odometry_previous_ * Rigid2(fraction * moved.translation(),
                                          fraction * moved.rotation()));
      }
      T_odometry_previous_ = T_odometry_robot;
      FeedScan(
          map_builder_, trajectory_id_, seconds_,
          TakeScan(TheDrivenOffice().plan, {}, T_world_robot, lidar, &random_));
      if (stop && stop()) return;
    }
  }

 private:
  cartographer::mapping::MapBuilderInterface* const map_builder_;
  const int trajectory_id_;
  RandomNumbers random_;
  double seconds_ = 0.;
  std::optional<Rigid2> T_world_odometry_;
  Rigid2 T_odometry_previous_;
};

// Of a drive along `poses`, the pose at the time of a scan.
inline Rigid2 PoseAt(const std::vector<Rigid2>& poses,
                     const cartographer::common::Time time) {
  const double seconds = cartographer::common::ToSeconds(time - TimeOf(0.));
  return poses.at(static_cast<size_t>(std::lround(seconds / kTimeStep)) - 1);
}

}  // namespace cartographer_sdf::testing

#endif  // TEST_LIVE_OFFICE_ROBOT_H_
