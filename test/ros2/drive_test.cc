// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Drives a recording through the node of cartographer_sdf_ros in ROS 2, and
// checks what comes out, as scripts/ros_drive_test.py does in ROS 1.
//
// usage: drive_test map LOG | drive_test localize LOG
//
// LOG is a CARMEN log of at least 500 s. Nodes are started by
// scripts/test_ros2.sh, with use_sim_time.

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cartographer_ros_msgs/srv/finish_trajectory.hpp"
#include "cartographer_ros_msgs/srv/read_metrics.hpp"
#include "cartographer_ros_msgs/srv/trajectory_query.hpp"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/recording/carmen_log.h"
#include "cartographer_sdf/recording/recording.h"
#include "cartographer_sdf_msgs/srv/locate.hpp"
#include "diagnostic_msgs/msg/diagnostic_array.hpp"
#include "geometry_msgs/msg/pose_with_covariance_stamped.hpp"
#include "nav_msgs/msg/odometry.hpp"
#include "rclcpp/rclcpp.hpp"
#include "rosgraph_msgs/msg/clock.hpp"
#include "sensor_msgs/msg/laser_scan.hpp"
#include "tf2_msgs/msg/tf_message.hpp"
#include "visualization_msgs/msg/marker_array.hpp"

namespace cartographer_sdf {
namespace {

using cartographer_ros_msgs::srv::FinishTrajectory;
using cartographer_ros_msgs::srv::ReadMetrics;
using cartographer_ros_msgs::srv::TrajectoryQuery;
using cartographer_sdf_msgs::srv::Locate;
using diagnostic_msgs::msg::DiagnosticArray;
using geometry_msgs::msg::PoseWithCovarianceStamped;
using geometry_msgs::msg::TransformStamped;
using nav_msgs::msg::Odometry;
using rosgraph_msgs::msg::Clock;
using ScanMessage = sensor_msgs::msg::LaserScan;
using tf2_msgs::msg::TFMessage;
using visualization_msgs::msg::MarkerArray;

// [s] of the recording per second.
constexpr double kMappingRate = 10.;
constexpr double kLocalizationRate = 5.;
// Pieces of the log, from one of which the robot is carried to the other [s];
// those of the test for ROS 1.
constexpr double kFirstBegin = 200.;
constexpr double kSecondBegin = 420.;
constexpr double kLength = 60.;
constexpr double kPause = 1.;
constexpr double kMaxError = 0.5;     // [m]
constexpr double kMaxRotation = 0.1;  // [rad]
constexpr double kMaxRange = 30.;     // [m] of the laser
constexpr std::chrono::seconds kPatience(60);

void Check(const bool condition, const std::string& what) {
  std::cout << (condition ? "ok   " : "FAIL ") << what << std::endl;
  if (!condition) std::exit(1);
}

// The same, without a line for what is no news.
void Require(const bool condition, const std::string& what) {
  if (!condition) Check(false, what);
}

builtin_interfaces::msg::Time ToStamp(const double time) {
  builtin_interfaces::msg::Time stamp;
  stamp.sec = static_cast<int32_t>(time);
  stamp.nanosec = static_cast<uint32_t>((time - stamp.sec) * 1e9);
  return stamp;
}

double ToSeconds(const builtin_interfaces::msg::Time& stamp) {
  return stamp.sec + 1e-9 * stamp.nanosec;
}

Rigid2 ToRigid2(const geometry_msgs::msg::Pose& pose) {
  return {pose.position.x, pose.position.y,
          2. * std::atan2(pose.orientation.z, pose.orientation.w)};
}

TransformStamped ToTransform(const double time, const std::string& parent,
                             const std::string& child,
                             const Rigid2& T_parent_child) {
  TransformStamped message;
  message.header.stamp = ToStamp(time);
  message.header.frame_id = parent;
  message.child_frame_id = child;
  message.transform.translation.x = T_parent_child.translation().x();
  message.transform.translation.y = T_parent_child.translation().y();
  message.transform.rotation.z = std::sin(T_parent_child.rotation() / 2.);
  message.transform.rotation.w = std::cos(T_parent_child.rotation() / 2.);
  return message;
}

// Publishes recordings as a robot with one laser and odometry would.
class Robot {
 public:
  explicit Robot(const rclcpp::Node::SharedPtr& node)
      : node_(node),
        scans_(node->create_publisher<ScanMessage>("scan", rclcpp::QoS(1000))),
        odometry_(node->create_publisher<Odometry>("odom", rclcpp::QoS(1000))),
        tf_(node->create_publisher<TFMessage>("/tf", rclcpp::QoS(100))),
        static_tf_(node->create_publisher<TFMessage>(
            "/tf_static", rclcpp::QoS(1).transient_local())),
        clock_(node->create_publisher<Clock>("/clock", rclcpp::QoS(10))) {
    TFMessage message;
    message.transforms = {ToTransform(0., "base_link", "laser", Rigid2())};
    static_tf_->publish(message);
  }

  // Adds `offset` to the stamps [s], and plays `rate` seconds per second.
  void Play(const Recording& recording, const double offset,
            const double rate) {
    begin_ = std::chrono::steady_clock::now();
    first_ = recording.scans.front().time + offset;
    rate_ = rate;
    for (size_t k = 0; k < recording.scans.size(); ++k) {
      if (k == 0) {
        PublishOdometry(first_, recording.scans[k].T_odometry_robot);
      } else {
        for (const MotionSample& sample :
             MotionBetween(recording.scans[k - 1], recording.scans[k])) {
          PublishOdometry(sample.time + offset, sample.T_odometry_robot);
        }
      }
      PublishScan(recording, recording.scans[k], offset);
    }
  }

 private:
  // Sets the clock, and waits until it is that time.
  void WaitFor(const double time) {
    Clock message;
    message.clock = ToStamp(time);
    const auto due =
        begin_ + std::chrono::duration<double>((time - first_) / rate_);
    do {
      rclcpp::spin_some(node_);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    } while (std::chrono::steady_clock::now() < due);
    clock_->publish(message);
  }

  void PublishOdometry(const double time, const Rigid2& T_odometry_robot) {
    WaitFor(time);
    const TransformStamped transform =
        ToTransform(time, "odom", "base_link", T_odometry_robot);
    Odometry message;
    message.header = transform.header;
    message.child_frame_id = transform.child_frame_id;
    message.pose.pose.position.x = transform.transform.translation.x;
    message.pose.pose.position.y = transform.transform.translation.y;
    message.pose.pose.orientation = transform.transform.rotation;
    odometry_->publish(message);
    TFMessage transforms;
    transforms.transforms = {transform};
    tf_->publish(transforms);
  }

  void PublishScan(const Recording& recording, const LaserScan& scan,
                   const double offset) {
    ScanMessage message;
    message.header.stamp = ToStamp(scan.time + offset);
    message.header.frame_id = "laser";
    message.angle_min = static_cast<float>(recording.first_angle);
    message.angle_increment = static_cast<float>(recording.angle_increment);
    message.angle_max =
        static_cast<float>(recording.first_angle +
                           recording.angle_increment *
                               static_cast<double>(scan.ranges.size() - 1));
    message.range_max = static_cast<float>(kMaxRange);
    message.ranges.assign(scan.ranges.begin(), scan.ranges.end());
    scans_->publish(message);
  }

  const rclcpp::Node::SharedPtr node_;
  const rclcpp::Publisher<ScanMessage>::SharedPtr scans_;
  const rclcpp::Publisher<Odometry>::SharedPtr odometry_;
  const rclcpp::Publisher<TFMessage>::SharedPtr tf_;
  const rclcpp::Publisher<TFMessage>::SharedPtr static_tf_;
  const rclcpp::Publisher<Clock>::SharedPtr clock_;
  std::chrono::steady_clock::time_point begin_;
  double first_ = 0.;
  double rate_ = 1.;
};

// What an operator's screen has received.
class Screen {
 public:
  explicit Screen(const rclcpp::Node::SharedPtr& node) : node_(node) {
    const rclcpp::QoS latched = rclcpp::QoS(10).transient_local();
    poses_ = node->create_subscription<PoseWithCovarianceStamped>(
        "/sdf_pose", latched,
        [this](const PoseWithCovarianceStamped::ConstSharedPtr message) {
          poses.push_back(*message);
        });
    statuses_ = node->create_subscription<DiagnosticArray>(
        "/diagnostics", 10,
        [this](const DiagnosticArray::ConstSharedPtr message) {
          states.insert(message->status.at(0).values.at(0).value);
        });
    matches_ = node->create_subscription<MarkerArray>(
        "/sdf_matches", latched,
        [this](const MarkerArray::ConstSharedPtr message) {
          num_matches = 0;
          for (const auto& marker : message->markers) {
            if (marker.ns == "in_graph") num_matches = marker.points.size() / 2;
          }
        });
  }

  template <typename Condition>
  bool WaitUntil(const Condition& condition) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (!condition() && std::chrono::steady_clock::now() < end) {
      rclcpp::spin_some(node_);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return condition();
  }

  std::vector<PoseWithCovarianceStamped> poses;
  std::set<std::string> states;
  size_t num_matches = 0;  // in the graph

 private:
  const rclcpp::Node::SharedPtr node_;
  rclcpp::Subscription<PoseWithCovarianceStamped>::SharedPtr poses_;
  rclcpp::Subscription<DiagnosticArray>::SharedPtr statuses_;
  rclcpp::Subscription<MarkerArray>::SharedPtr matches_;
};

template <typename Service>
typename Service::Response::SharedPtr Call(
    const rclcpp::Node::SharedPtr& node, const std::string& name,
    const typename Service::Request& request = typename Service::Request()) {
  const auto client = node->create_client<Service>(name);
  Require(client->wait_for_service(kPatience), "there is " + name);
  auto answer = client->async_send_request(
      std::make_shared<typename Service::Request>(request));
  Require(rclcpp::spin_until_future_complete(node, answer, kPatience) ==
              rclcpp::FutureReturnCode::SUCCESS,
          name + " answers");
  return answer.get();
}

Locate::Response Find(const rclcpp::Node::SharedPtr& node,
                      const bool is_carried_away) {
  Locate::Request request;
  request.trajectory_id = -1;
  request.search = is_carried_away;
  request.restart = is_carried_away;
  return *Call<Locate>(node, "/sdf_locate", request);
}

// Checks a pose against those of the robot that mapped. `offset` was added to
// the stamps of the recording [s].
void CheckPose(const std::vector<geometry_msgs::msg::PoseStamped>& truth,
               const PoseWithCovarianceStamped& message, const double offset,
               const std::string& what) {
  const double time = ToSeconds(message.header.stamp) - offset;
  size_t k = 1;
  while (k + 1 < truth.size() && ToSeconds(truth[k].header.stamp) < time) ++k;
  const double begin = ToSeconds(truth[k - 1].header.stamp);
  const double span = ToSeconds(truth[k].header.stamp) - begin;
  const Rigid2 T_map_begin = ToRigid2(truth[k - 1].pose);
  const Rigid2 motion = T_map_begin.Inverse() * ToRigid2(truth[k].pose);
  const double part = span > 0. ? (time - begin) / span : 0.;
  const Rigid2 T_map_true = T_map_begin * Rigid2(part * motion.translation(),
                                                 part * motion.rotation());
  const Rigid2 error = T_map_true.Inverse() * ToRigid2(message.pose.pose);
  Check(error.translation().norm() < kMaxError &&
            std::abs(error.rotation()) < kMaxRotation,
        what + ": " + std::to_string(error.translation().norm()) + " m and " +
            std::to_string(error.rotation()) + " rad off");
}

void Map(const rclcpp::Node::SharedPtr& node, const Recording& recording) {
  Robot robot(node);
  Screen screen(node);
  // Discovers the node.
  Call<ReadMetrics>(node, "/sdf_read_metrics");
  robot.Play(recording, 0., kMappingRate);
  Check(screen.WaitUntil([&screen] { return screen.num_matches > 0; }),
        std::to_string(screen.num_matches) + " matches are shown");
  FinishTrajectory::Request request;
  Check(Call<FinishTrajectory>(node, "/finish_trajectory", request)
                ->status.code == 0,
        "the trajectory is finished");
  const auto metrics = Call<ReadMetrics>(node, "/sdf_read_metrics");
  Check(metrics->status.code == 0 && !metrics->metric_families.empty(),
        std::to_string(metrics->metric_families.size()) + " metrics");
  Check(screen.states == std::set<std::string>{"mapping"}, "status: mapping");
}

void Localize(const rclcpp::Node::SharedPtr& node, const Recording& recording) {
  Robot robot(node);
  Screen screen(node);
  Find(node, false);
  const std::vector<geometry_msgs::msg::PoseStamped> truth =
      Call<TrajectoryQuery>(node, "/trajectory_query")->trajectory;
  Check(truth.size() > 1, "the map has its trajectory");
  robot.Play(Cut(recording, kFirstBegin, kLength), 0., kLocalizationRate);
  Check(screen.WaitUntil([&screen] { return !screen.poses.empty(); }),
        "a pose is published");
  CheckPose(truth, screen.poses.front(), 0., "located");
  const Locate::Response found = Find(node, false);
  Check(found.located && found.probability > 0.99 && found.has_start_pose,
        "the service says so after " + std::to_string(found.distance_driven) +
            " m, probability " + std::to_string(found.probability));

  const Locate::Response lost = Find(node, true);
  Check(lost.success && !lost.located &&
            lost.trajectory_id == found.trajectory_id + 1,
        "carried away: a new trajectory is searched for");
  Check(screen.WaitUntil([&screen] { return screen.states.count("lost") > 0; }),
        "status: lost");
  screen.poses.clear();
  const double offset = kFirstBegin + kLength + kPause - kSecondBegin;
  robot.Play(Cut(recording, kSecondBegin, kLength), offset, kLocalizationRate);
  Check(screen.WaitUntil([&screen] { return !screen.poses.empty(); }),
        "it is found again");
  CheckPose(truth, screen.poses.front(), offset, "found again");
  Check(Find(node, false).trajectory_id == lost.trajectory_id,
        "the new trajectory goes on");
  Check(screen.states == std::set<std::string>{"searching", "located", "lost"},
        "status: searching, located, lost");
}

void Run(const std::string& kind, const std::string& path) {
  const auto recording = ReadCarmenLog(path, {});
  Require(recording.ok(), std::string(recording.status().message()));
  const auto node = rclcpp::Node::make_shared("drive_test");
  if (kind == "map") {
    Map(node, *recording);
  } else {
    Localize(node, *recording);
  }
}

}  // namespace
}  // namespace cartographer_sdf

int main(int argc, char** argv) {
  rclcpp::init(argc, argv);
  if (argc != 3) {
    std::cerr << "usage: drive_test map LOG | drive_test localize LOG\n";
    return 2;
  }
  cartographer_sdf::Run(argv[1], argv[2]);
  rclcpp::shutdown();
}
