// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The node of cartographer_ros (ROS 1) with the searcher around its map
// builder. Flags are those of cartographer_node, so that launch files carry
// over.

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
#include "cartographer_ros_msgs/ReadMetrics.h"
#include "cartographer_ros_msgs/StatusCode.h"
#include "cartographer_sdf/live/map_builder.h"
#include "cartographer_sdf/live/operator_desk.h"
#include "cartographer_sdf_msgs/Locate.h"
#include "cartographer_sdf_ros/messages.h"
#include "cartographer_sdf_ros/node_flags.h"
#include "diagnostic_msgs/DiagnosticArray.h"
#include "geometry_msgs/PoseWithCovarianceStamped.h"
#include "glog/logging.h"
#include "ros/ros.h"
#include "std_srvs/Trigger.h"
#include "tf2_ros/buffer.h"
#include "tf2_ros/transform_listener.h"
#include "visualization_msgs/MarkerArray.h"

namespace cartographer_sdf {
namespace {

namespace mapping = cartographer::mapping;
using cartographer_ros_msgs::ReadMetrics;
using cartographer_sdf_msgs::Locate;
using PoseMessage = geometry_msgs::PoseWithCovarianceStamped;
using std_srvs::Trigger;

constexpr double kTransformCacheSeconds = 10.;
constexpr double kResultPeriodSeconds = 0.1;
constexpr double kStatusPeriodSeconds = 1.;
constexpr double kMarkerPeriodSeconds = 2.;
constexpr int kQueueSize = 10;

NodeParameters LoadNodeParameters() {
  const ros::NodeHandle handle("~");
  return LoadParameters([&handle](const std::string& name, auto* const value) {
    handle.getParam(name, *value);
  });
}

// Topics and services beside those of cartographer_node. Served by the thread
// that spins.
class OperatorTopics {
 public:
  // Owns none of them; all must outlive this.
  OperatorTopics(const std::string& map_frame,
                 const cartographer_ros::TrajectoryOptions& trajectory_options,
                 OperatorDesk* const desk, cartographer_ros::Node* const node,
                 cartographer_ros::metrics::FamilyFactory* const metrics)
      : map_frame_(map_frame),
        trajectory_options_(trajectory_options),
        parameters_(LoadNodeParameters()),
        desk_(desk),
        node_(node),
        metrics_(metrics) {
    ros::NodeHandle& handle = *node->node_handle();
    Advertise(&handle);
    services_ = {handle.advertiseService("sdf_localize",
                                         &OperatorTopics::HandleLocalize, this),
                 handle.advertiseService("sdf_locate",
                                         &OperatorTopics::HandleLocate, this),
                 handle.advertiseService("sdf_read_metrics",
                                         &OperatorTopics::HandleMetrics, this)};
    timers_ = {handle.createWallTimer(ros::WallDuration(kResultPeriodSeconds),
                                      &OperatorTopics::PublishResults, this),
               handle.createWallTimer(ros::WallDuration(kStatusPeriodSeconds),
                                      &OperatorTopics::PublishStatus, this),
               handle.createWallTimer(ros::WallDuration(kMarkerPeriodSeconds),
                                      &OperatorTopics::PublishMarkers, this)};
  }

 private:
  // What was published last is had by those that subscribe later.
  void Advertise(ros::NodeHandle* const handle) {
    const auto advertise = [handle](auto message, const std::string& topic) {
      return topic.empty() ? ros::Publisher()
                           : handle->advertise<decltype(message)>(
                                 topic, kQueueSize, /*latch=*/true);
    };
    pose_publishers_ = {
        advertise(PoseMessage(), parameters_.pose_topic),
        advertise(PoseMessage(), parameters_.initial_pose_topic)};
    marker_publisher_ =
        advertise(visualization_msgs::MarkerArray(), parameters_.matches_topic);
    if (!parameters_.diagnostics_topic.empty()) {
      diagnostics_publisher_ =
          handle->advertise<diagnostic_msgs::DiagnosticArray>(
              parameters_.diagnostics_topic, kQueueSize);
    }
  }

  void PublishResults(const ros::WallTimerEvent&) {
    for (const LocalizationResult& result : desk_->TakeResults()) {
      if (!result.localized) continue;
      PoseMessage message;
      FillPose(result, map_frame_, &message);
      message.header.stamp = cartographer_ros::ToRos(result.time);
      for (ros::Publisher& publisher : pose_publishers_) {
        if (publisher) publisher.publish(message);
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

  void PublishStatus(const ros::WallTimerEvent&) {
    if (!diagnostics_publisher_) return;
    auto message = MakeDiagnostics<diagnostic_msgs::DiagnosticArray>(
        desk_->DescribeStatus(), ros::this_node::getName());
    message.header.stamp = ros::Time::now();
    diagnostics_publisher_.publish(message);
  }

  void PublishMarkers(const ros::WallTimerEvent&) {
    if (!marker_publisher_ || marker_publisher_.getNumSubscribers() == 0) {
      return;
    }
    marker_publisher_.publish(MakeMarkers<visualization_msgs::MarkerArray>(
        desk_->DrawMatches(), map_frame_, ros::Time::now()));
  }

  bool HandleLocalize(Trigger::Request&, Trigger::Response& response) {
    ServeLocalize(parameters_, MakeActions(), desk_, &response);
    return true;
  }

  bool HandleLocate(Locate::Request& request, Locate::Response& response) {
    const auto time =
        ServeLocate(request, map_frame_, MakeActions(), desk_, &response);
    if (time) response.pose.header.stamp = cartographer_ros::ToRos(*time);
    return true;
  }

  bool HandleMetrics(ReadMetrics::Request&, ReadMetrics::Response& response) {
    response.timestamp = ros::Time::now();
    if (metrics_ == nullptr) {
      response.status.code = cartographer_ros_msgs::StatusCode::UNAVAILABLE;
      response.status.message = "-collect_metrics is not set";
      return true;
    }
    metrics_->ReadMetrics(&response);
    response.status.code = cartographer_ros_msgs::StatusCode::OK;
    return true;
  }

  const std::string map_frame_;
  const cartographer_ros::TrajectoryOptions trajectory_options_;
  const NodeParameters parameters_;
  OperatorDesk* const desk_;
  cartographer_ros::Node* const node_;
  cartographer_ros::metrics::FamilyFactory* const metrics_;  // may be null
  std::vector<ros::Publisher> pose_publishers_;
  ros::Publisher marker_publisher_;
  ros::Publisher diagnostics_publisher_;
  std::vector<ros::ServiceServer> services_;
  std::vector<ros::WallTimer> timers_;
};

void Run() {
  tf2_ros::Buffer tf_buffer{ros::Duration(kTransformCacheSeconds)};
  const tf2_ros::TransformListener tf_listener(tf_buffer);
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
  cartographer_ros::Node node(node_options, std::move(map_builder), &tf_buffer,
                              FLAGS_collect_metrics);
  const OperatorTopics topics(node_options.map_frame, trajectory_options, &desk,
                              &node,
                              FLAGS_collect_metrics ? &metrics : nullptr);
  if (!FLAGS_load_state_filename.empty()) {
    node.LoadState(FLAGS_load_state_filename, FLAGS_load_frozen_state);
  }
  if (FLAGS_start_trajectory_with_default_topics) {
    node.StartTrajectoryWithDefaultTopics(trajectory_options);
  }
  ros::spin();
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
  google::InitGoogleLogging(argv[0]);
  google::ParseCommandLineFlags(&argc, &argv, true);
  CHECK(!FLAGS_configuration_directory.empty())
      << "-configuration_directory is missing.";
  CHECK(!FLAGS_configuration_basename.empty())
      << "-configuration_basename is missing.";
  ros::init(argc, argv, "cartographer_node");
  ros::start();
  cartographer_ros::ScopedRosLogSink ros_log_sink;
  cartographer_sdf::Run();
  ros::shutdown();
}
