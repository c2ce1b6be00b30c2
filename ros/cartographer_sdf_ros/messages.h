// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What both nodes share: fills messages, whose fields have the same names in
// ROS 1 and ROS 2. A message type is deduced or given by the caller.

#ifndef ROS_CARTOGRAPHER_SDF_ROS_MESSAGES_H_
#define ROS_CARTOGRAPHER_SDF_ROS_MESSAGES_H_

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cartographer/common/time.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/live/host_conversion.h"
#include "cartographer_sdf/live/map_builder.h"
#include "cartographer_sdf/live/operator_desk.h"
#include "cartographer_sdf/live/operator_view.h"

namespace cartographer_sdf {

// Parameters of either node.
struct NodeParameters {
  // Empty: not published.
  std::string pose_topic = "sdf_pose";
  // For programs that wait for an initial pose, such as /initialpose.
  std::string initial_pose_topic;
  std::string matches_topic = "sdf_matches";
  std::string diagnostics_topic = "/diagnostics";
  // Whether /sdf_localize ends the trajectory and starts another one, as
  // /sdf_locate does on request.
  bool restart_to_search = false;
};

// `get(name, value)` sets a value where there is such a parameter.
template <typename Get>
NodeParameters LoadParameters(const Get& get) {
  NodeParameters parameters;
  get("pose_topic", &parameters.pose_topic);
  get("initial_pose_topic", &parameters.initial_pose_topic);
  get("matches_topic", &parameters.matches_topic);
  get("diagnostics_topic", &parameters.diagnostics_topic);
  get("restart_to_search", &parameters.restart_to_search);
  return parameters;
}

template <typename Pose>
void FillPose(const cartographer::transform::Rigid3d& host_pose,
              Pose* const pose) {
  pose->position.x = host_pose.translation().x();
  pose->position.y = host_pose.translation().y();
  pose->position.z = host_pose.translation().z();
  pose->orientation.x = host_pose.rotation().x();
  pose->orientation.y = host_pose.rotation().y();
  pose->orientation.z = host_pose.rotation().z();
  pose->orientation.w = host_pose.rotation().w();
}

// A geometry_msgs/PoseWithCovarianceStamped, without its stamp. `found` must
// have a pose.
template <typename PoseMessage>
void FillPose(const LocalizationResult& found, const std::string& map_frame,
              PoseMessage* const message) {
  message->header.frame_id = map_frame;
  FillPose(ToHost(*found.T_map_tracking), &message->pose.pose);
  // Rows and columns of the message are x, y, z and rotations about them.
  constexpr int kAxes[] = {0, 1, 5};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      message->pose.covariance[6 * kAxes[row] + kAxes[column]] =
          found.covariance(row, column);
    }
  }
}

// The answer of cartographer_sdf_msgs/Locate, without the stamp of the pose.
template <typename Response>
void FillLocation(const LocalizationResult& found, const std::string& map_frame,
                  Response* const response) {
  response->success = true;
  response->trajectory_id = found.trajectory_id;
  response->located = found.localized;
  response->verdict = LocalizationVerdictName(found.verdict);
  response->reason = found.reason;
  response->has_pose = found.T_map_tracking.has_value();
  response->distance_driven = found.distance_driven;
  response->num_queries = found.num_queries;
  if (!found.T_map_tracking) return;
  FillPose(found, map_frame, &response->pose);
  response->score = found.score;
  response->probability = ProbabilitiesOf(found).best;
  response->has_runner_up = found.T_map_runner_up.has_value();
  if (!found.T_map_runner_up) return;
  FillPose(ToHost(*found.T_map_runner_up), &response->runner_up);
  response->runner_up_score = found.runner_up_score;
  response->runner_up_probability = ProbabilitiesOf(found).runner_up;
}

// Serves cartographer_sdf_msgs/Locate, but for the stamp of the pose: returns
// the time of the pose, none if there is none.
template <typename Request, typename Response>
std::optional<cartographer::common::Time> ServeLocate(
    const Request& request, const std::string& map_frame,
    const TrajectoryActions& actions, OperatorDesk* const desk,
    Response* const response) {
  std::optional<int> trajectory_id =
      request.trajectory_id >= 0 ? std::optional<int>(request.trajectory_id)
                                 : desk->NewestTrajectory();
  if (trajectory_id && request.search) {
    trajectory_id = desk->SearchAgain(
        *trajectory_id,
        request.restart ? std::make_optional(actions) : std::nullopt);
  }
  response->trajectory_id = trajectory_id.value_or(-1);
  if (!trajectory_id) {
    response->message = desk->IsEnabled() ? "the trajectory is not active"
                                          : "the searcher is not enabled";
    return std::nullopt;
  }
  const std::optional<LocalizationResult> found =
      desk->GetLocalization(*trajectory_id);
  if (!found) {
    response->message = "the trajectory was never searched for";
    return std::nullopt;
  }
  FillLocation(*found, map_frame, response);
  if (const std::optional<StartPose> start =
          desk->GetStartPose(*trajectory_id)) {
    response->has_start_pose = true;
    response->relative_to_trajectory_id = start->to_trajectory_id;
    FillPose(start->relative_pose, &response->start_pose);
  }
  if (!found->T_map_tracking) return std::nullopt;
  return found->time;
}

// Serves std_srvs/Trigger.
template <typename Response>
void ServeLocalize(const NodeParameters& parameters,
                   const TrajectoryActions& actions, OperatorDesk* const desk,
                   Response* const response) {
  const int count = desk->SearchForAll(parameters.restart_to_search
                                           ? std::make_optional(actions)
                                           : std::nullopt);
  response->success = count > 0;
  response->message = desk->IsEnabled()
                          ? std::to_string(count) + " active trajectories"
                          : "the searcher is not enabled";
}

// A visualization_msgs/MarkerArray with one marker for each group, whose
// namespace is the group's name. `stamp` is that of their headers.
template <typename MarkerArray, typename Stamp>
MarkerArray MakeMarkers(const std::vector<SegmentGroup>& groups,
                        const std::string& map_frame, const Stamp& stamp) {
  MarkerArray array;
  array.markers.resize(groups.size());
  for (size_t k = 0; k < groups.size(); ++k) {
    const SegmentGroup& group = groups[k];
    auto& marker = array.markers[k];
    using Marker = typename decltype(array.markers)::value_type;
    marker.header.frame_id = map_frame;
    marker.header.stamp = stamp;
    marker.ns = group.name;
    marker.id = 0;
    marker.type = Marker::LINE_LIST;
    // RViz complains about a list without points.
    marker.action = group.segments.empty() ? Marker::DELETE : Marker::ADD;
    marker.pose.orientation.w = 1.;
    marker.scale.x = group.width;
    marker.color.r = group.color.red;
    marker.color.g = group.color.green;
    marker.color.b = group.color.blue;
    marker.color.a = group.color.alpha;
    for (const Segment& segment : group.segments) {
      for (const Eigen::Vector2d& end : {segment.begin, segment.end}) {
        marker.points.emplace_back();
        marker.points.back().x = end.x();
        marker.points.back().y = end.y();
      }
    }
  }
  return array;
}

// A diagnostic_msgs/DiagnosticArray with one status, without its stamp.
template <typename DiagnosticArray>
DiagnosticArray MakeDiagnostics(const NodeStatus& status,
                                const std::string& node_name) {
  DiagnosticArray array;
  array.status.resize(1);
  auto& message = array.status.front();
  using Status = typename decltype(array.status)::value_type;
  message.level = status.is_fine ? Status::OK : Status::WARN;
  message.name = node_name + ": searcher";
  message.hardware_id = "cartographer_sdf";
  message.message = status.message;
  for (const auto& [key, value] : status.values) {
    message.values.emplace_back();
    message.values.back().key = key;
    message.values.back().value = value;
  }
  return array;
}

}  // namespace cartographer_sdf

#endif  // ROS_CARTOGRAPHER_SDF_ROS_MESSAGES_H_
