// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/pose_graph_codec.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/pbstream/pose_codec.h"

namespace cartographer_sdf {
namespace {

// Values of Constraint.tag in the file.
constexpr int kIntraSubmapTag = 0;
constexpr int kInterSubmapTag = 1;

// Time differences must not overflow [100 ns].
constexpr int64_t kMaxTime = std::numeric_limits<int64_t>::max() / 2;

absl::Status Problem(const std::string& subject, const absl::Status& status) {
  return absl::DataLossError(
      absl::StrCat("has ", subject, ", which ", status.message()));
}

// Returns the pose of a submap or node that is not known so far.
template <typename IdType, typename Element, typename Stored>
absl::StatusOr<Rigid3> PoseOfNew(const char* const kind, const IdType& id,
                                 const std::map<IdType, Element>& known,
                                 const Stored& stored) {
  if (id.trajectory < 0 || id.index < 0) {
    return absl::DataLossError(
        absl::StrCat("has the invalid id of a ", Name(kind, id)));
  }
  if (known.count(id) > 0) {
    return absl::DataLossError(absl::StrCat("has ", Name(kind, id), " twice"));
  }
  if (!stored.has_pose()) {
    return absl::DataLossError(
        absl::StrCat("has ", Name(kind, id), " without a pose"));
  }
  const absl::StatusOr<Rigid3> pose = FromProto(stored.pose());
  if (!pose.ok()) return Problem(Name(kind, id), pose.status());
  return pose;
}

Rigid2 GravityAligned(const Rigid3& T_a_tracking,
                      const Eigen::Quaterniond& gravity) {
  return Project2D(T_a_tracking * Rigid3::Rotation(gravity.conjugate()));
}

absl::Status AddTrajectory(const proto::Trajectory& trajectory,
                           const Attitudes& attitudes, PoseGraph* const graph) {
  for (const proto::TrajectorySubmap& stored : trajectory.submap()) {
    const SubmapId id{trajectory.trajectory_id(), stored.submap_index()};
    const absl::StatusOr<Rigid3> pose =
        PoseOfNew("submap", id, graph->submap_poses, stored);
    if (!pose.ok()) return pose.status();
    graph->submap_poses.emplace(id, Project2D(*pose));
  }
  for (const proto::TrajectoryNode& stored : trajectory.node()) {
    const NodeId id{trajectory.trajectory_id(), stored.node_index()};
    const absl::StatusOr<Rigid3> pose =
        PoseOfNew("node", id, graph->nodes, stored);
    if (!pose.ok()) return pose.status();
    if (stored.timestamp() < -kMaxTime || stored.timestamp() > kMaxTime) {
      return absl::DataLossError(
          absl::StrCat("has a node with time ", stored.timestamp()));
    }
    Node& node = graph->nodes[id];
    node.time = stored.timestamp();
    if (const auto it = attitudes.find(id); it != attitudes.end()) {
      const auto& [gravity_alignment, local_pose] = it->second;
      node.gravity_alignment = gravity_alignment;
      if (local_pose) {
        node.T_local_node = GravityAligned(*local_pose, gravity_alignment);
      }
    }
    node.T_map_node = GravityAligned(*pose, node.gravity_alignment);
  }
  return absl::OkStatus();
}

absl::Status AddConstraint(const proto::Constraint& stored,
                           PoseGraph* const graph) {
  const SubmapId submap{stored.submap_id().trajectory_id(),
                        stored.submap_id().index()};
  const NodeId id{stored.node_id().trajectory_id(), stored.node_id().index()};
  const auto subject = [&] {
    return absl::StrCat("a constraint of ", Name("submap", submap), " and ",
                        Name("node", id));
  };
  const auto node = graph->nodes.find(id);
  if (graph->submap_poses.count(submap) == 0 || node == graph->nodes.end()) {
    return absl::DataLossError(
        absl::StrCat("has ", subject(), ", which are not both in it"));
  }
  if (stored.tag() != kIntraSubmapTag && stored.tag() != kInterSubmapTag) {
    return absl::DataLossError(absl::StrCat(
        "has ", subject(), " with the unknown tag ", stored.tag()));
  }
  for (const double weight :
       {stored.translation_weight(), stored.rotation_weight()}) {
    if (!std::isfinite(weight) || weight < 0.) {
      return absl::DataLossError(
          absl::StrCat("has ", subject(), " with the weight ", weight));
    }
  }
  const absl::StatusOr<Rigid3> pose = FromProto(stored.relative_pose());
  if (!pose.ok()) return Problem(subject(), pose.status());
  graph->constraints.push_back(
      {submap, id, GravityAligned(*pose, node->second.gravity_alignment),
       stored.translation_weight(), stored.rotation_weight(),
       stored.tag() == kInterSubmapTag ? Constraint::Tag::kInterSubmap
                                       : Constraint::Tag::kIntraSubmap});
  return absl::OkStatus();
}

Rigid3 Tracking(const Rigid2& T_a_node, const Eigen::Quaterniond& gravity) {
  return Embed3D(T_a_node) * Rigid3::Rotation(gravity);
}

bool IsFinite(const Rigid3& pose) {
  return (pose.translation.array().abs() <= kMaxCoordinate).all() &&
         std::abs(pose.rotation.norm() - 1.) < 0.5;
}

// Also checks that the weight is not negative.
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

// The host inserts each node only once into a submap.
absl::Status CheckIntraConstraintsOnce(const PoseGraph& graph) {
  std::vector<std::pair<SubmapId, NodeId>> pairs;
  for (const Constraint& constraint : graph.constraints) {
    if (constraint.tag != Constraint::Tag::kIntraSubmap) continue;
    pairs.emplace_back(constraint.submap, constraint.node);
  }
  std::sort(pairs.begin(), pairs.end());
  const auto twice = std::adjacent_find(pairs.begin(), pairs.end());
  if (twice == pairs.end()) return absl::OkStatus();
  return absl::DataLossError(absl::StrCat(
      "has the intra-submap constraint of ", Name("submap", twice->first),
      " and ", Name("node", twice->second), " twice"));
}

bool IsRecorded(const RecordedElements& recorded, const SubmapId& submap) {
  return recorded.submaps.count(submap) > 0;
}

bool IsRecorded(const RecordedElements& recorded, const NodeId& node) {
  return recorded.attitudes.count(node) > 0;
}

// Removes the elements of a list or vector that the predicate is true for;
// returns whether there were any.
template <typename List, typename Predicate>
bool RemoveIf(List* const list, const Predicate& predicate) {
  const auto end = std::remove_if(list->begin(), list->end(), predicate);
  if (end == list->end()) return false;
  list->erase(end, list->end());
  return true;
}

template <typename IdType, typename Element>
bool RemoveUnrecorded(const RecordedElements& recorded,
                      std::map<IdType, Element>* const elements) {
  const size_t size_before = elements->size();
  for (auto it = elements->begin(); it != elements->end();) {
    it = IsRecorded(recorded, it->first) ? std::next(it) : elements->erase(it);
  }
  return elements->size() < size_before;
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

// Writes the differences from `before`, which is null for a new constraint;
// returns whether there were any.
bool UpdateConstraint(const Constraint* const before, const Constraint& after,
                      const Eigen::Quaterniond& gravity,
                      proto::Constraint* const stored) {
  const bool same_pose =
      before != nullptr && IsSame(before->T_submap_node, after.T_submap_node);
  if (!same_pose) {
    *stored->mutable_relative_pose() =
        ToProto(Tracking(after.T_submap_node, gravity));
  }
  stored->set_translation_weight(after.translation_weight);
  stored->set_rotation_weight(after.rotation_weight);
  return !same_pose || before->translation_weight != after.translation_weight ||
         before->rotation_weight != after.rotation_weight;
}

// Sets the fields that updates do not change.
proto::Constraint NewConstraint(const Constraint& constraint) {
  proto::Constraint stored;
  stored.mutable_submap_id()->set_trajectory_id(constraint.submap.trajectory);
  stored.mutable_submap_id()->set_index(constraint.submap.index);
  stored.mutable_node_id()->set_trajectory_id(constraint.node.trajectory);
  stored.mutable_node_id()->set_index(constraint.node.index);
  stored.set_tag(constraint.tag == Constraint::Tag::kInterSubmap
                     ? kInterSubmapTag
                     : kIntraSubmapTag);
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
    const absl::Status status = CheckWantedConstraint(before, constraint);
    if (!status.ok()) return status;
    const Constraint* known = nullptr;
    proto::Constraint target;
    std::deque<int>& indices = remaining[KeyOf(constraint)];
    if (indices.empty()) {
      target = NewConstraint(constraint);
    } else {
      known = &before.constraints[indices.front()];
      target = stored->constraint(indices.front());
      changed |= indices.front() != updated.size();
      indices.pop_front();
    }
    changed |= UpdateConstraint(
        known, constraint, before.nodes.at(constraint.node).gravity_alignment,
        &target);
    *updated.Add() = std::move(target);
  }
  stored->mutable_constraint()->Swap(&updated);
  return changed;
}

const Rigid2& PoseOf(const Rigid2& submap) { return submap; }
const Rigid2& PoseOf(const Node& node) { return node.T_map_node; }
const Rigid3& PoseOf(const Rigid3& landmark) { return landmark; }

template <typename IdType, typename Element>
absl::Status CheckPoses(const char* const kind,
                        const std::map<IdType, Element>& before,
                        const std::map<IdType, Element>& after) {
  for (const auto& [id, element] : after) {
    if (before.count(id) == 0) {
      return absl::InvalidArgumentError(
          absl::StrCat("does not have ", Name(kind, id)));
    }
    if (!IsFinite(PoseOf(element))) {
      return absl::InvalidArgumentError(absl::StrCat(
          "would have a pose that is not finite of ", Name(kind, id)));
    }
  }
  return absl::OkStatus();
}

// Returns the pose of `after` if it exists and differs, else null.
template <typename IdType, typename Element>
auto NewPose(const std::map<IdType, Element>& before,
             const std::map<IdType, Element>& after, const IdType& id) {
  const auto it = after.find(id);
  return it == after.end() || IsSame(PoseOf(it->second), PoseOf(before.at(id)))
             ? nullptr
             : &PoseOf(it->second);
}

// Returns whether any differed.
bool UpdatePoses(const PoseGraph& before, const PoseGraph& after,
                 proto::PoseGraph* const stored) {
  bool changed = false;
  const auto set = [&changed](const Rigid3& pose, proto::Rigid3d* const field) {
    *field = ToProto(pose);
    changed = true;
  };
  for (proto::Trajectory& trajectory : *stored->mutable_trajectory()) {
    for (proto::TrajectorySubmap& submap : *trajectory.mutable_submap()) {
      const SubmapId id{trajectory.trajectory_id(), submap.submap_index()};
      if (const Rigid2* const T_map_submap =
              NewPose(before.submap_poses, after.submap_poses, id)) {
        set(Embed3D(*T_map_submap), submap.mutable_pose());
      }
    }
    for (proto::TrajectoryNode& node : *trajectory.mutable_node()) {
      const NodeId id{trajectory.trajectory_id(), node.node_index()};
      if (const Rigid2* const T_map_node =
              NewPose(before.nodes, after.nodes, id)) {
        set(Tracking(*T_map_node, before.nodes.at(id).gravity_alignment),
            node.mutable_pose());
      }
    }
  }
  for (proto::LandmarkPose& landmark : *stored->mutable_landmark_poses()) {
    if (const Rigid3* const T_map_landmark =
            NewPose(before.landmark_poses, after.landmark_poses,
                    landmark.landmark_id())) {
      set(*T_map_landmark, landmark.mutable_global_pose());
    }
  }
  return changed;
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

bool DropUnrecorded(const RecordedElements& recorded,
                    proto::PoseGraph* const stored) {
  bool dropped = false;
  for (proto::Trajectory& trajectory : *stored->mutable_trajectory()) {
    const int number = trajectory.trajectory_id();
    dropped |= RemoveIf(
        trajectory.mutable_submap(), [&](const proto::TrajectorySubmap& it) {
          return !IsRecorded(recorded, SubmapId{number, it.submap_index()});
        });
    dropped |= RemoveIf(
        trajectory.mutable_node(), [&](const proto::TrajectoryNode& it) {
          return !IsRecorded(recorded, NodeId{number, it.node_index()});
        });
  }
  if (!dropped) return false;
  RemoveIf(stored->mutable_constraint(), [&](const proto::Constraint& it) {
    const proto::Id& submap = it.submap_id();
    const proto::Id& node = it.node_id();
    return !IsRecorded(recorded,
                       SubmapId{submap.trajectory_id(), submap.index()}) ||
           !IsRecorded(recorded, NodeId{node.trajectory_id(), node.index()});
  });
  return true;
}

bool DropUnrecorded(const RecordedElements& recorded, PoseGraph* const graph) {
  const bool dropped_submaps = RemoveUnrecorded(recorded, &graph->submap_poses);
  const bool dropped_nodes = RemoveUnrecorded(recorded, &graph->nodes);
  // Also of what the graph does not have.
  const bool dropped_constraints =
      RemoveIf(&graph->constraints, [&](const Constraint& constraint) {
        return !IsRecorded(recorded, constraint.submap) ||
               !IsRecorded(recorded, constraint.node);
      });
  return dropped_submaps || dropped_nodes || dropped_constraints;
}

absl::StatusOr<PoseGraph> ToPoseGraph(const proto::PoseGraph& stored,
                                      const Attitudes& attitudes) {
  PoseGraph graph;
  absl::Status status;
  std::set<int> trajectories;
  for (const proto::Trajectory& trajectory : stored.trajectory()) {
    if (!trajectories.insert(trajectory.trajectory_id()).second) {
      return absl::DataLossError(absl::StrCat(
          "has trajectory ", trajectory.trajectory_id(), " twice"));
    }
    status = AddTrajectory(trajectory, attitudes, &graph);
    if (!status.ok()) return status;
  }
  for (const proto::Constraint& constraint : stored.constraint()) {
    status = AddConstraint(constraint, &graph);
    if (!status.ok()) return status;
  }
  status = CheckIntraConstraintsOnce(graph);
  if (!status.ok()) return status;
  for (const proto::LandmarkPose& landmark : stored.landmark_poses()) {
    const absl::StatusOr<Rigid3> pose = FromProto(landmark.global_pose());
    if (graph.landmark_poses.count(landmark.landmark_id()) > 0) {
      return absl::DataLossError("has a landmark twice");
    }
    if (!pose.ok()) return Problem("a landmark", pose.status());
    graph.landmark_poses.emplace(landmark.landmark_id(), *pose);
  }
  return graph;
}

absl::StatusOr<bool> UpdatePoseGraph(const PoseGraph& before,
                                     const PoseGraph& after,
                                     proto::PoseGraph* const stored) {
  absl::Status status =
      CheckPoses("submap", before.submap_poses, after.submap_poses);
  status.Update(CheckPoses("node", before.nodes, after.nodes));
  status.Update(
      CheckPoses("landmark", before.landmark_poses, after.landmark_poses));
  if (!status.ok()) return status;
  const bool poses = UpdatePoses(before, after, stored);
  const absl::StatusOr<bool> constraints =
      UpdateConstraints(before, after, stored);
  if (!constraints.ok()) return constraints;
  return poses || *constraints;
}

}  // namespace cartographer_sdf
