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
#include "cartographer_ros/node.h"
#include "cartographer_ros/node_options.h"
#include "cartographer_ros/ros_log_sink.h"
#include "cartographer_sdf/live/live_options.h"
#include "cartographer_sdf/live/map_builder.h"
#include "gflags/gflags.h"
#include "glog/logging.h"
#include "ros/ros.h"
#include "std_srvs/Trigger.h"
#include "tf2_ros/buffer.h"
#include "tf2_ros/transform_listener.h"

DEFINE_bool(collect_metrics, false, "Collect metrics, to be had by a service.");
DEFINE_string(configuration_directory, "",
              "First directory to look for configuration files in.");
DEFINE_string(configuration_basename, "", "Cartographer's configuration file.");
DEFINE_string(sdf_configuration_basename, "sdf_live.lua",
              "The searcher's configuration file.");
DEFINE_string(load_state_filename, "", "A .pbstream to load; none if empty.");
DEFINE_bool(load_frozen_state, true, "Whether what is loaded stays as it is.");
DEFINE_bool(start_trajectory_with_default_topics, true,
            "Start the first trajectory at once.");
DEFINE_string(save_state_filename, "",
              "Where the map goes before the node ends; nowhere if empty.");

namespace cartographer_sdf {
namespace {

namespace mapping = cartographer::mapping;

constexpr double kTransformCacheSeconds = 10.;

LiveOptions LoadOptionsOrDie() {
  const absl::StatusOr<LiveOptions> options = LoadLiveOptions(
      {FLAGS_configuration_directory, CARTOGRAPHER_SDF_CONFIGURATION_DIRECTORY},
      FLAGS_sdf_configuration_basename);
  CHECK(options.ok()) << options.status().message();
  return *options;
}

void LogLocalization(const LocalizationResult& result) {
  LOG(INFO) << "Trajectory " << result.trajectory_id << ": "
            << LocalizationVerdictName(result.verdict) << ", score "
            << result.score << ", runner-up " << result.runner_up_score
            << ", after " << result.distance_driven << " m";
}

// Has all active trajectories searched for again.
bool LocalizeAgain(mapping::MapBuilderInterface* const map_builder,
                   std_srvs::Trigger::Response* const response) {
  LiveMapBuilder* const live = AsLiveMapBuilder(map_builder);
  int count = 0;
  if (live != nullptr) {
    for (const auto& [trajectory_id, state] :
         live->pose_graph()->GetTrajectoryStates()) {
      if (state != mapping::PoseGraphInterface::TrajectoryState::ACTIVE) {
        continue;
      }
      live->Localize(trajectory_id);
      ++count;
    }
  }
  response->success = count > 0;
  response->message = live == nullptr
                          ? "the searcher is not enabled"
                          : std::to_string(count) + " active trajectories";
  return true;
}

void Run() {
  tf2_ros::Buffer tf_buffer{ros::Duration(kTransformCacheSeconds)};
  const tf2_ros::TransformListener tf_listener(tf_buffer);
  cartographer_ros::NodeOptions node_options;
  cartographer_ros::TrajectoryOptions trajectory_options;
  std::tie(node_options, trajectory_options) = cartographer_ros::LoadOptions(
      FLAGS_configuration_directory, FLAGS_configuration_basename);
  // Without `cartographer_sdf::`, the compiler could not tell it from
  // Cartographer's function of that name.
  std::unique_ptr<mapping::MapBuilderInterface> map_builder =
      cartographer_sdf::CreateMapBuilder(
          mapping::CreateMapBuilder(node_options.map_builder_options),
          LoadOptionsOrDie(), LogLocalization);
  // Lives as long as the node, which owns it.
  mapping::MapBuilderInterface* const searcher = map_builder.get();
  cartographer_ros::Node node(node_options, std::move(map_builder), &tf_buffer,
                              FLAGS_collect_metrics);
  const boost::function<bool(std_srvs::Trigger::Request&,
                             std_srvs::Trigger::Response&)>
      on_localize = [searcher](std_srvs::Trigger::Request&,
                               std_srvs::Trigger::Response& response) {
        return LocalizeAgain(searcher, &response);
      };
  const ros::ServiceServer service =
      node.node_handle()->advertiseService("sdf_localize", on_localize);
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
