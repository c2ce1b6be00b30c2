// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/pose_graph_codec.h"

#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/pbstream/pose_codec.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Differences of times must not overflow [100 ns].
constexpr int64_t kMaxTime = std::numeric_limits<int64_t>::max() / 2;

absl::Status Problem(const std::string& subject, const absl::Status& status) {
  return absl::DataLossError(
      absl::StrCat("has ", subject, ", which ", status.message()));
}

template <typename IdType>
absl::Status CheckElement(const char* const kind, const IdType& id,
                          const bool has_pose, const proto::Rigid3d& pose,
                          std::set<IdType>* const ids) {
  if (id.trajectory < 0 || id.index < 0) {
    return absl::DataLossError(
        absl::StrCat("has the invalid id of a ", Name(kind, id)));
  }
  if (!ids->insert(id).second) {
    return absl::DataLossError(absl::StrCat("has ", Name(kind, id), " twice"));
  }
  if (!has_pose) {
    return absl::DataLossError(
        absl::StrCat("has ", Name(kind, id), " without a pose"));
  }
  const absl::Status status = FromProto(pose).status();
  return status.ok() ? status : Problem(Name(kind, id), status);
}

SubmapId SubmapOf(const proto::Constraint& constraint) {
  return {constraint.submap_id().trajectory_id(),
          constraint.submap_id().index()};
}

NodeId NodeOf(const proto::Constraint& constraint) {
  return {constraint.node_id().trajectory_id(), constraint.node_id().index()};
}

absl::Status CheckConstraint(const proto::Constraint& constraint,
                             const std::set<SubmapId>& submaps,
                             const std::set<NodeId>& nodes) {
  const SubmapId submap = SubmapOf(constraint);
  const NodeId node = NodeOf(constraint);
  const std::string subject = absl::StrCat(
      "a constraint of ", Name("submap", submap), " and ", Name("node", node));
  if (submaps.count(submap) == 0 || nodes.count(node) == 0) {
    return absl::DataLossError(
        absl::StrCat("has ", subject, ", which are not both in it"));
  }
  if (constraint.tag() != kIntraSubmapTag &&
      constraint.tag() != kInterSubmapTag) {
    return absl::DataLossError(absl::StrCat(
        "has ", subject, " with the unknown tag ", constraint.tag()));
  }
  for (const double weight :
       {constraint.translation_weight(), constraint.rotation_weight()}) {
    if (!std::isfinite(weight) || weight < 0.) {
      return absl::DataLossError(
          absl::StrCat("has ", subject, " with the weight ", weight));
    }
  }
  const absl::Status status = FromProto(constraint.relative_pose()).status();
  return status.ok() ? status : Problem(subject, status);
}

Rigid2 GravityAligned(const Rigid3& T_a_tracking,
                      const Eigen::Quaterniond& gravity) {
  return Project2D(T_a_tracking * Rigid3::Rotation(gravity.conjugate()));
}

// Of a proto that passed the check.
Rigid3 CheckedPose(const proto::Rigid3d& pose) {
  const absl::StatusOr<Rigid3> result = FromProto(pose);
  CHECK(result.ok()) << result.status();
  return *result;
}

absl::Status CheckTrajectory(const proto::Trajectory& trajectory,
                             std::set<SubmapId>* const submaps,
                             std::set<NodeId>* const nodes) {
  const int trajectory_id = trajectory.trajectory_id();
  for (const proto::TrajectorySubmap& submap : trajectory.submap()) {
    if (absl::Status status = CheckElement(
            "submap", SubmapId{trajectory_id, submap.submap_index()},
            submap.has_pose(), submap.pose(), submaps);
        !status.ok()) {
      return status;
    }
  }
  for (const proto::TrajectoryNode& node : trajectory.node()) {
    if (absl::Status status =
            CheckElement("node", NodeId{trajectory_id, node.node_index()},
                         node.has_pose(), node.pose(), nodes);
        !status.ok()) {
      return status;
    }
    if (node.timestamp() < -kMaxTime || node.timestamp() > kMaxTime) {
      return absl::DataLossError(
          absl::StrCat("has a node with time ", node.timestamp()));
    }
  }
  return absl::OkStatus();
}

absl::Status CheckLandmarks(const proto::PoseGraph& stored) {
  std::set<std::string> ids;
  for (const proto::LandmarkPose& landmark : stored.landmark_poses()) {
    if (!ids.insert(landmark.landmark_id()).second) {
      return absl::DataLossError("has a landmark twice");
    }
    const absl::Status status = FromProto(landmark.global_pose()).status();
    if (!status.ok()) return Problem("a landmark", status);
  }
  return absl::OkStatus();
}

Node MakeNode(const proto::TrajectoryNode& stored,
              const NodeAttitude& attitude) {
  Node node;
  node.time = stored.timestamp();
  node.gravity_alignment = attitude.gravity_alignment;
  node.T_map_node =
      GravityAligned(CheckedPose(stored.pose()), node.gravity_alignment);
  if (attitude.local_pose.has_value()) {
    node.T_local_node =
        GravityAligned(*attitude.local_pose, node.gravity_alignment);
  }
  return node;
}

Constraint MakeConstraint(const proto::Constraint& stored,
                          const Eigen::Quaterniond& gravity) {
  Constraint constraint;
  constraint.submap = SubmapOf(stored);
  constraint.node = NodeOf(stored);
  constraint.T_submap_node =
      GravityAligned(CheckedPose(stored.relative_pose()), gravity);
  constraint.translation_weight = stored.translation_weight();
  constraint.rotation_weight = stored.rotation_weight();
  constraint.tag = stored.tag() == kInterSubmapTag
                       ? Constraint::Tag::kInterSubmap
                       : Constraint::Tag::kIntraSubmap;
  return constraint;
}

}  // namespace

absl::StatusOr<NodeAttitude> ReadNodeAttitude(const proto::NodeData& data) {
  NodeAttitude attitude;
  if (data.has_gravity_alignment()) {
    const absl::StatusOr<Eigen::Quaterniond> gravity_alignment =
        FromProto(data.gravity_alignment());
    if (!gravity_alignment.ok()) return gravity_alignment.status();
    attitude.gravity_alignment = *gravity_alignment;
  }
  if (data.has_local_pose()) {
    const absl::StatusOr<Rigid3> local_pose = FromProto(data.local_pose());
    if (!local_pose.ok()) return local_pose.status();
    attitude.local_pose = *local_pose;
  }
  return attitude;
}

absl::Status CheckPoseGraph(const proto::PoseGraph& stored) {
  std::set<int> trajectories;
  std::set<SubmapId> submaps;
  std::set<NodeId> nodes;
  for (const proto::Trajectory& trajectory : stored.trajectory()) {
    if (!trajectories.insert(trajectory.trajectory_id()).second) {
      return absl::DataLossError(absl::StrCat(
          "has trajectory ", trajectory.trajectory_id(), " twice"));
    }
    if (absl::Status status = CheckTrajectory(trajectory, &submaps, &nodes);
        !status.ok()) {
      return status;
    }
  }
  for (const proto::Constraint& constraint : stored.constraint()) {
    if (absl::Status status = CheckConstraint(constraint, submaps, nodes);
        !status.ok()) {
      return status;
    }
  }
  return CheckLandmarks(stored);
}

PoseGraph ToPoseGraph(const proto::PoseGraph& stored,
                      const Attitudes& attitudes) {
  PoseGraph graph;
  for (const proto::Trajectory& trajectory : stored.trajectory()) {
    const int trajectory_id = trajectory.trajectory_id();
    for (const proto::TrajectorySubmap& submap : trajectory.submap()) {
      graph.submap_poses.emplace(SubmapId{trajectory_id, submap.submap_index()},
                                 Project2D(CheckedPose(submap.pose())));
    }
    for (const proto::TrajectoryNode& node : trajectory.node()) {
      const NodeId id{trajectory_id, node.node_index()};
      const auto attitude = attitudes.find(id);
      graph.nodes.emplace(
          id, MakeNode(node, attitude == attitudes.end() ? NodeAttitude{}
                                                         : attitude->second));
    }
  }
  for (const proto::Constraint& constraint : stored.constraint()) {
    graph.constraints.push_back(MakeConstraint(
        constraint, graph.nodes.at(NodeOf(constraint)).gravity_alignment));
  }
  for (const proto::LandmarkPose& landmark : stored.landmark_poses()) {
    graph.landmark_poses.emplace(landmark.landmark_id(),
                                 CheckedPose(landmark.global_pose()));
  }
  return graph;
}

}  // namespace cartographer_sdf
