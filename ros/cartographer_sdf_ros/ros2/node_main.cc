// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The node of cartographer_ros (ROS 2) with the searcher around its map
// builder. Flags are those of cartographer_node, so that launch files carry
// over. Compiled against the headers of Humble and cartographer_ros 2.0.9002
// (scripts/check_ros2.py), not run yet.

#include <chrono>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "cartographer/mapping/map_builder.h"
#include "cartographer_ros/metrics/family_factory.h"
#include "cartographer_ros/node.h"
#include "cartographer_ros/node_options.h"
#include "cartographer_ros/ros_log_sink.h"
#include "cartographer_ros/time_conversion.h"
#include "cartographer_ros_msgs/msg/status_code.hpp"
#include "cartographer_ros_msgs/srv/read_metrics.hpp"
#include "cartographer_sdf/live/map_builder.h"
#include "cartographer_sdf/live/operator_desk.h"
#include "cartographer_sdf_msgs/srv/locate.hpp"
#include "cartographer_sdf_ros/messages.h"
#include "cartographer_sdf_ros/node_flags.h"
#include "diagnostic_msgs/msg/diagnostic_array.hpp"
#include "geometry_msgs/msg/pose_with_covariance_stamped.hpp"
#include "glog/logging.h"
#include "rclcpp/rclcpp.hpp"
#include "std_srvs/srv/trigger.hpp"
#include "tf2_ros/buffer.h"
#include "tf2_ros/transform_listener.h"
#include "visualization_msgs/msg/marker_array.hpp"

namespace cartographer_sdf {
namespace {

namespace mapping = cartographer::mapping;

using cartographer_ros_msgs::srv::ReadMetrics;
using cartographer_sdf_msgs::srv::Locate;
using diagnostic_msgs::msg::DiagnosticArray;
using PoseMessage = geometry_msgs::msg::PoseWithCovarianceStamped;
using std_srvs::srv::Trigger;
using visualization_msgs::msg::MarkerArray;

constexpr double kTransformCacheSeconds = 10.;
constexpr int kQueueSize = 10;

NodeParameters LoadNodeParameters(rclcpp::Node* const ros_node) {
  return LoadParameters([ros_node](const std::string& name, auto* const value) {
    *value = ros_node->declare_parameter(name, *value);
  });
}

// Topics and services beside those of cartographer_node. Served by the thread
// that spins.
class OperatorTopics {
 public:
  // Owns none of them; all must outlive this. `metrics` may be null.
  OperatorTopics(const std::string& map_frame,
                 const cartographer_ros::TrajectoryOptions& trajectory_options,
                 OperatorDesk* const desk, cartographer_ros::Node* const node,
                 rclcpp::Node* const ros_node,
                 cartographer_ros::metrics::FamilyFactory* const metrics)
      : map_frame_(map_frame),
        trajectory_options_(trajectory_options),
        parameters_(LoadNodeParameters(ros_node)),
        desk_(desk),
        node_(node),
        ros_node_(ros_node),
        metrics_(metrics) {
    CreatePublishers();
    CreateServices();
    using std::chrono::milliseconds;
    timers_ = {ros_node->create_wall_timer(milliseconds(100),
                                           [this] { PublishResults(); }),
               ros_node->create_wall_timer(milliseconds(1000),
                                           [this] { PublishStatus(); }),
               ros_node->create_wall_timer(milliseconds(2000),
                                           [this] { PublishMarkers(); })};
  }

 private:
  void CreatePublishers() {
    // What was published last is had by those that subscribe later.
    const rclcpp::QoS latched = rclcpp::QoS(kQueueSize).transient_local();
    for (const std::string& topic :
         {parameters_.pose_topic, parameters_.initial_pose_topic}) {
      if (topic.empty()) continue;
      pose_publishers_.push_back(
          ros_node_->create_publisher<PoseMessage>(topic, latched));
    }
    if (!parameters_.matches_topic.empty()) {
      marker_publisher_ = ros_node_->create_publisher<MarkerArray>(
          parameters_.matches_topic, latched);
    }
    if (!parameters_.diagnostics_topic.empty()) {
      diagnostics_publisher_ = ros_node_->create_publisher<DiagnosticArray>(
          parameters_.diagnostics_topic, kQueueSize);
    }
  }

  void CreateServices() {
    localize_ = ros_node_->create_service<Trigger>(
        "sdf_localize",
        [this](const std::shared_ptr<Trigger::Request>,
               const std::shared_ptr<Trigger::Response> response) {
          ServeLocalize(parameters_, MakeActions(), desk_, response.get());
        });
    locate_ = ros_node_->create_service<Locate>(
        "sdf_locate", [this](const std::shared_ptr<Locate::Request> request,
                             const std::shared_ptr<Locate::Response> response) {
          const auto time = ServeLocate(*request, map_frame_, MakeActions(),
                                        desk_, response.get());
          if (time) {
            response->pose.header.stamp = cartographer_ros::ToRos(*time);
          }
        });
    read_metrics_ = ros_node_->create_service<ReadMetrics>(
        "sdf_read_metrics",
        [this](const std::shared_ptr<ReadMetrics::Request>,
               const std::shared_ptr<ReadMetrics::Response> response) {
          HandleMetrics(response);
        });
  }

  void PublishResults() {
    for (const LocalizationResult& result : desk_->TakeResults()) {
      if (!result.localized) continue;
      PoseMessage message;
      FillPose(result, map_frame_, &message);
      message.header.stamp = cartographer_ros::ToRos(result.time);
      for (const auto& publisher : pose_publishers_) {
        publisher->publish(message);
      }
    }
  }

  TrajectoryActions MakeActions() {
    return {[this](const int trajectory_id) {
              return node_->FinishTrajectory(trajectory_id);
            },
            [this] {
              node_->StartTrajectoryWithDefaultTopics(trajectory_options_);
            }};
  }

  void PublishStatus() {
    if (diagnostics_publisher_ == nullptr) return;
    auto message = MakeDiagnostics<DiagnosticArray>(
        desk_->DescribeStatus(), ros_node_->get_fully_qualified_name());
    message.header.stamp = ros_node_->now();
    diagnostics_publisher_->publish(message);
  }

  void PublishMarkers() {
    if (marker_publisher_ == nullptr ||
        marker_publisher_->get_subscription_count() == 0) {
      return;
    }
    marker_publisher_->publish(MakeMarkers<MarkerArray>(
        desk_->DrawMatches(), map_frame_, ros_node_->now()));
  }

  void HandleMetrics(const std::shared_ptr<ReadMetrics::Response>& response) {
    using cartographer_ros_msgs::msg::StatusCode;
    response->timestamp = ros_node_->now();
    if (metrics_ == nullptr) {
      response->status.code = StatusCode::UNAVAILABLE;
      response->status.message = "-collect_metrics is not set";
      return;
    }
    metrics_->ReadMetrics(response);
    response->status.code = StatusCode::OK;
  }

  const std::string map_frame_;
  const cartographer_ros::TrajectoryOptions trajectory_options_;
  const NodeParameters parameters_;
  OperatorDesk* const desk_;
  cartographer_ros::Node* const node_;
  rclcpp::Node* const ros_node_;
  cartographer_ros::metrics::FamilyFactory* const metrics_;
  std::vector<rclcpp::Publisher<PoseMessage>::SharedPtr> pose_publishers_;
  rclcpp::Publisher<MarkerArray>::SharedPtr marker_publisher_;
  rclcpp::Publisher<DiagnosticArray>::SharedPtr diagnostics_publisher_;
  rclcpp::Service<Trigger>::SharedPtr localize_;
  rclcpp::Service<Locate>::SharedPtr locate_;
  rclcpp::Service<ReadMetrics>::SharedPtr read_metrics_;
  std::vector<rclcpp::TimerBase::SharedPtr> timers_;
};

void Run() {
  const rclcpp::Node::SharedPtr ros_node =
      rclcpp::Node::make_shared("cartographer_node");
  const auto tf_buffer = std::make_shared<tf2_ros::Buffer>(
      ros_node->get_clock(), tf2::durationFromSec(kTransformCacheSeconds),
      ros_node);
  const tf2_ros::TransformListener tf_listener(*tf_buffer);
  cartographer_ros::NodeOptions node_options;
  cartographer_ros::TrajectoryOptions trajectory_options;
  std::tie(node_options, trajectory_options) = cartographer_ros::LoadOptions(
      FLAGS_configuration_directory, FLAGS_configuration_basename);
  // The node's own registry is out of reach.
  cartographer_ros::metrics::FamilyFactory metrics;
  if (FLAGS_collect_metrics) RegisterMetrics(&metrics);
  OperatorDesk desk;
  // Without `cartographer_sdf::`, the compiler could not tell it from
  // Cartographer's function of that name.
  std::unique_ptr<mapping::MapBuilderInterface> map_builder =
      cartographer_sdf::CreateMapBuilder(
          mapping::CreateMapBuilder(node_options.map_builder_options),
          LoadOptionsOrDie(), [&desk](const LocalizationResult& result) {
            desk.OnLocalization(result);
          });
  desk.SetMapBuilder(map_builder.get());
  cartographer_ros::Node node(node_options, std::move(map_builder), tf_buffer,
                              ros_node, FLAGS_collect_metrics);
  const OperatorTopics topics(node_options.map_frame, trajectory_options, &desk,
                              &node, ros_node.get(),
                              FLAGS_collect_metrics ? &metrics : nullptr);
  if (!FLAGS_load_state_filename.empty()) {
    node.LoadState(FLAGS_load_state_filename, FLAGS_load_frozen_state);
  }
  if (FLAGS_start_trajectory_with_default_topics) {
    node.StartTrajectoryWithDefaultTopics(trajectory_options);
  }
  rclcpp::spin(ros_node);
  node.FinishAllTrajectories();
  node.RunFinalOptimization();
  if (!FLAGS_save_state_filename.empty()) {
    node.SerializeState(FLAGS_save_state_filename,
                        /*include_unfinished_submaps=*/true);
  }
}

}  // namespace
}  // namespace cartographer_sdf

int main(int argc, char** argv) {
  // First, as gflags puts the arguments into another order.
  rclcpp::init(argc, argv);
  // ROS's own arguments stay, which gflags does not know.
  google::AllowCommandLineReparsing();
  google::InitGoogleLogging(argv[0]);
  google::ParseCommandLineFlags(&argc, &argv, false);
  CHECK(!FLAGS_configuration_directory.empty())
      << "-configuration_directory is missing.";
  CHECK(!FLAGS_configuration_basename.empty())
      << "-configuration_basename is missing.";
  cartographer_ros::ScopedRosLogSink ros_log_sink;
  cartographer_sdf::Run();
  rclcpp::shutdown();
}
