// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/pose_graph_update.h"

#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "cartographer_sdf/pbstream/pose_codec.h"
#include "cartographer_sdf/pbstream/pose_graph_codec.h"

namespace cartographer_sdf {
namespace {

Rigid3 Tracking(const Rigid2& T_a_node, const Eigen::Quaterniond& gravity) {
  return Embed3D(T_a_node) * Rigid3::Rotation(gravity);
}

bool IsFinite(const Rigid3& pose) {
  return (pose.translation.array().abs() <= kMaxCoordinate).all() &&
         std::abs(pose.rotation.norm() - 1.) < 0.5;
}

// Of a weight, which is not negative either.
bool IsFinite(const double weight) {
  return std::isfinite(weight) && weight >= 0.;
}

bool IsFinite(const Rigid2& pose) {
  return (pose.translation().array().abs() <= kMaxCoordinate).all() &&
         std::isfinite(pose.rotation());
}

bool IsSame(const Rigid2& a, const Rigid2& b) {
  return a.translation() == b.translation() && a.rotation() == b.rotation();
}

bool IsSame(const Rigid3& a, const Rigid3& b) {
  return a.translation == b.translation &&
         a.rotation.coeffs() == b.rotation.coeffs();
}

// Constraints of the same kind between the same submap and node.
using ConstraintKey = std::tuple<SubmapId, NodeId, Constraint::Tag>;

ConstraintKey KeyOf(const Constraint& constraint) {
  return {constraint.submap, constraint.node, constraint.tag};
}

absl::Status CheckWantedConstraint(const PoseGraph& graph,
                                   const Constraint& constraint) {
  const std::string subject =
      absl::StrCat("the constraint of ", Name("submap", constraint.submap),
                   " and ", Name("node", constraint.node));
  if (graph.submap_poses.count(constraint.submap) == 0 ||
      graph.nodes.count(constraint.node) == 0) {
    return absl::InvalidArgumentError(
        absl::StrCat("does not have both ends of ", subject));
  }
  if (!IsFinite(constraint.T_submap_node) ||
      !IsFinite(constraint.translation_weight) ||
      !IsFinite(constraint.rotation_weight)) {
    return absl::InvalidArgumentError(
        absl::StrCat("would have numbers that are not finite in ", subject));
  }
  return absl::OkStatus();
}

// Writes what differs from `before`; returns whether anything did.
bool UpdateConstraint(const Constraint& before, const Constraint& after,
                      const Eigen::Quaterniond& gravity,
                      proto::Constraint* const stored) {
  const bool same_pose = IsSame(before.T_submap_node, after.T_submap_node);
  const bool same_weights =
      before.translation_weight == after.translation_weight &&
      before.rotation_weight == after.rotation_weight;
  if (!same_pose) {
    *stored->mutable_relative_pose() =
        ToProto(Tracking(after.T_submap_node, gravity));
  }
  stored->set_translation_weight(after.translation_weight);
  stored->set_rotation_weight(after.rotation_weight);
  return !same_pose || !same_weights;
}

proto::Constraint NewConstraint(const Constraint& constraint,
                                const Eigen::Quaterniond& gravity) {
  proto::Constraint stored;
  stored.mutable_submap_id()->set_trajectory_id(constraint.submap.trajectory);
  stored.mutable_submap_id()->set_index(constraint.submap.index);
  stored.mutable_node_id()->set_trajectory_id(constraint.node.trajectory);
  stored.mutable_node_id()->set_index(constraint.node.index);
  *stored.mutable_relative_pose() =
      ToProto(Tracking(constraint.T_submap_node, gravity));
  stored.set_tag(constraint.tag == Constraint::Tag::kInterSubmap
                     ? kInterSubmapTag
                     : kIntraSubmapTag);
  stored.set_translation_weight(constraint.translation_weight);
  stored.set_rotation_weight(constraint.rotation_weight);
  return stored;
}

absl::StatusOr<bool> UpdateConstraints(const PoseGraph& before,
                                       const PoseGraph& after,
                                       proto::PoseGraph* const stored) {
  std::map<ConstraintKey, std::deque<int>> remaining;
  for (size_t i = 0; i < before.constraints.size(); ++i) {
    remaining[KeyOf(before.constraints[i])].push_back(static_cast<int>(i));
  }
  bool changed = after.constraints.size() != before.constraints.size();
  google::protobuf::RepeatedPtrField<proto::Constraint> updated;
  for (const Constraint& constraint : after.constraints) {
    if (absl::Status status = CheckWantedConstraint(before, constraint);
        !status.ok()) {
      return status;
    }
    const Eigen::Quaterniond& gravity =
        before.nodes.at(constraint.node).gravity_alignment;
    std::deque<int>& known = remaining[KeyOf(constraint)];
    if (known.empty()) {
      *updated.Add() = NewConstraint(constraint, gravity);
      changed = true;
      continue;
    }
    const int index = known.front();
    known.pop_front();
    changed |= index != updated.size();
    proto::Constraint& target = *updated.Add();
    target = stored->constraint(index);
    changed |= UpdateConstraint(before.constraints[index], constraint, gravity,
                                &target);
  }
  stored->mutable_constraint()->Swap(&updated);
  return changed;
}

// The pose of `after`, where it has one that differs.
template <typename IdType>
std::optional<Rigid2> NewPose(const std::map<IdType, Rigid2>& before,
                              const std::map<IdType, Rigid2>& after,
                              const IdType& id) {
  const auto it = after.find(id);
  if (it == after.end() || IsSame(it->second, before.at(id))) return {};
  return it->second;
}

template <typename IdType>
absl::Status CheckNewPoses(const char* const kind,
                           const std::map<IdType, Rigid2>& before,
                           const std::map<IdType, Rigid2>& after) {
  for (const auto& [id, pose] : after) {
    if (before.count(id) == 0) {
      return absl::InvalidArgumentError(
          absl::StrCat("does not have ", Name(kind, id)));
    }
    if (!IsFinite(pose)) {
      return absl::InvalidArgumentError(absl::StrCat(
          "would have a pose that is not finite of ", Name(kind, id)));
    }
  }
  return absl::OkStatus();
}

std::map<NodeId, Rigid2> NodePoses(const PoseGraph& graph) {
  std::map<NodeId, Rigid2> poses;
  for (const auto& [id, node] : graph.nodes) poses.emplace(id, node.T_map_node);
  return poses;
}

absl::StatusOr<bool> UpdateTrajectories(const PoseGraph& before,
                                        const PoseGraph& after,
                                        proto::PoseGraph* const stored) {
  const std::map<NodeId, Rigid2> nodes_before = NodePoses(before);
  const std::map<NodeId, Rigid2> nodes_after = NodePoses(after);
  absl::Status status =
      CheckNewPoses("submap", before.submap_poses, after.submap_poses);
  if (status.ok()) status = CheckNewPoses("node", nodes_before, nodes_after);
  if (!status.ok()) return status;
  bool changed = false;
  for (proto::Trajectory& trajectory : *stored->mutable_trajectory()) {
    for (proto::TrajectorySubmap& submap : *trajectory.mutable_submap()) {
      const SubmapId id{trajectory.trajectory_id(), submap.submap_index()};
      const std::optional<Rigid2> T_map_submap =
          NewPose(before.submap_poses, after.submap_poses, id);
      if (!T_map_submap.has_value()) continue;
      *submap.mutable_pose() = ToProto(Embed3D(*T_map_submap));
      changed = true;
    }
    for (proto::TrajectoryNode& node : *trajectory.mutable_node()) {
      const NodeId id{trajectory.trajectory_id(), node.node_index()};
      const std::optional<Rigid2> T_map_node =
          NewPose(nodes_before, nodes_after, id);
      if (!T_map_node.has_value()) continue;
      *node.mutable_pose() =
          ToProto(Tracking(*T_map_node, before.nodes.at(id).gravity_alignment));
      changed = true;
    }
  }
  return changed;
}

absl::StatusOr<bool> UpdateLandmarks(const PoseGraph& before,
                                     const PoseGraph& after,
                                     proto::PoseGraph* const stored) {
  for (const auto& [id, pose] : after.landmark_poses) {
    if (before.landmark_poses.count(id) == 0) {
      return absl::InvalidArgumentError(
          absl::StrCat("does not have landmark ", id));
    }
    if (!IsFinite(pose)) {
      return absl::InvalidArgumentError(absl::StrCat(
          "would have a pose that is not finite of landmark ", id));
    }
  }
  bool changed = false;
  for (proto::LandmarkPose& landmark : *stored->mutable_landmark_poses()) {
    const auto it = after.landmark_poses.find(landmark.landmark_id());
    if (it == after.landmark_poses.end() ||
        IsSame(it->second, before.landmark_poses.at(it->first))) {
      continue;
    }
    *landmark.mutable_global_pose() = ToProto(it->second);
    changed = true;
  }
  return changed;
}

}  // namespace

absl::StatusOr<bool> UpdatePoseGraph(const PoseGraph& before,
                                     const PoseGraph& after,
                                     proto::PoseGraph* const stored) {
  const absl::StatusOr<bool> trajectories =
      UpdateTrajectories(before, after, stored);
  if (!trajectories.ok()) return trajectories;
  const absl::StatusOr<bool> constraints =
      UpdateConstraints(before, after, stored);
  if (!constraints.ok()) return constraints;
  const absl::StatusOr<bool> landmarks = UpdateLandmarks(before, after, stored);
  if (!landmarks.ok()) return landmarks;
  return *trajectories || *constraints || *landmarks;
}

}  // namespace cartographer_sdf
