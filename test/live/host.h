// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A stock Cartographer for tests, and a simulated robot that feeds it.

#ifndef TEST_LIVE_HOST_H_
#define TEST_LIVE_HOST_H_

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "cartographer/common/configuration_file_resolver.h"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/common/time.h"
#include "cartographer/mapping/map_builder.h"
#include "cartographer/sensor/odometry_data.h"
#include "cartographer/sensor/timed_point_cloud_data.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/geometry/rigid3.h"
#include "cartographer_sdf/simulation/lidar.h"

namespace cartographer_sdf::testing {

constexpr char kRange[] = "range";
constexpr char kOdometry[] = "odometry";

struct StockOptions {
  cartographer::mapping::proto::MapBuilderOptions map_builder;
  cartographer::mapping::proto::TrajectoryBuilderOptions trajectory_builder;
};

// Cartographer's own defaults for 2D without IMU, changed by lines of Lua.
inline StockOptions MakeStockOptions(const std::string& lines) {
  auto resolver =
      std::make_unique<cartographer::common::ConfigurationFileResolver>(
          std::vector<std::string>{TEST_HOST_CONFIGURATION_DIRECTORY});
  cartographer::common::LuaParameterDictionary dictionary(
      "include \"map_builder.lua\"\ninclude \"trajectory_builder.lua\"\n"
      "MAP_BUILDER.use_trajectory_builder_2d = true\n"
      "MAP_BUILDER.num_background_threads = 2\n"
      "TRAJECTORY_BUILDER_2D.use_imu_data = false\n"
      "POSE_GRAPH.constraint_builder.log_matches = false\n"
      "POSE_GRAPH.optimization_problem.ceres_solver_options.num_threads = 1\n" +
          lines +
          "\nreturn { map_builder = MAP_BUILDER, trajectory_builder = "
          "TRAJECTORY_BUILDER }\n",
      std::move(resolver));
  return {cartographer::mapping::CreateMapBuilderOptions(
              dictionary.GetDictionary("map_builder").get()),
          cartographer::mapping::CreateTrajectoryBuilderOptions(
              dictionary.GetDictionary("trajectory_builder").get())};
}

inline std::set<cartographer::mapping::MapBuilderInterface::SensorId>
SensorIds() {
  using SensorId = cartographer::mapping::MapBuilderInterface::SensorId;
  return {SensorId{SensorId::SensorType::RANGE, kRange},
          SensorId{SensorId::SensorType::ODOMETRY, kOdometry}};
}

inline cartographer::common::Time TimeOf(const double seconds) {
  return cartographer::common::FromUniversal(0) +
         cartographer::common::FromSeconds(1e9 + seconds);
}

// `T_odometry_robot` in any frame.
inline void FeedOdometry(
    cartographer::mapping::MapBuilderInterface* const map_builder,
    const int trajectory_id, const double seconds,
    const Rigid2& T_odometry_robot) {
  const Rigid3 pose = Embed3D(T_odometry_robot);
  map_builder->GetTrajectoryBuilder(trajectory_id)
      ->AddSensorData(kOdometry, cartographer::sensor::OdometryData{
                                     TimeOf(seconds),
                                     cartographer::transform::Rigid3d(
                                         pose.translation, pose.rotation)});
}

// In the robot's frame.
inline void FeedScan(
    cartographer::mapping::MapBuilderInterface* const map_builder,
    const int trajectory_id, const double seconds, const Scan& scan) {
  cartographer::sensor::TimedPointCloudData data;
  data.time = TimeOf(seconds);
  data.origin = Eigen::Vector3f::Zero();
  for (const Eigen::Vector2f& point : scan.returns) {
    data.ranges.push_back({{point.x(), point.y(), 0.f}, 0.f});
  }
  // Beyond the host's largest range: no echo.
  constexpr float kNoEcho = 1000.f;
  for (const Eigen::Vector2f& miss : scan.misses) {
    const Eigen::Vector2f end = kNoEcho * miss.normalized();
    data.ranges.push_back({{end.x(), end.y(), 0.f}, 0.f});
  }
  map_builder->GetTrajectoryBuilder(trajectory_id)->AddSensorData(kRange, data);
}

}  // namespace cartographer_sdf::testing

#endif  // TEST_LIVE_HOST_H_
