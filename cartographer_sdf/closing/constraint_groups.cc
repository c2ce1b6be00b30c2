// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/constraint_groups.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "cartographer_sdf/closing/constraint_generation.h"
#include "cartographer_sdf/geometry/distinct_poses.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// A submap into which a node was inserted.
struct Insertion {
  SubmapId submap;
  Rigid2 T_submap_node;
  // Twice the distance from the middle of the submap's scans, in scans.
  int distance_to_middle = 0;
};

std::map<NodeId, std::vector<Insertion>> Insertions(
    const PoseGraph& pose_graph) {
  std::map<NodeId, std::vector<Insertion>> insertions;
  for (const auto& [submap, nodes] : FindInsertedNodes(pose_graph)) {
    int rank = 0;
    for (const auto& [node, T_submap_node] : nodes) {
      insertions[node].push_back(
          {submap, T_submap_node,
           std::abs(2 * rank + 1 - static_cast<int>(nodes.size()))});
      ++rank;
    }
  }
  return insertions;
}

// A constraint as a relation of two submaps, the lower id as the reference.
struct GroupedRelation {
  size_t constraint = 0;
  Rigid2 T_reference_query;
};
using PairOfSubmaps = std::pair<SubmapId, SubmapId>;

const Insertion* BestInsertion(
    const std::vector<Insertion>& insertions, const SubmapId& other,
    const std::map<SubmapId, Eigen::Vector2d>& centroids) {
  const Insertion* best = nullptr;
  for (const Insertion& insertion : insertions) {
    if (insertion.submap == other || centroids.count(insertion.submap) == 0) {
      continue;
    }
    if (best == nullptr ||
        insertion.distance_to_middle < best->distance_to_middle) {
      best = &insertion;
    }
  }
  return best;
}

// Removes the largest set around one relation from `relations`, and returns it.
ConstraintGroup TakeLargestGroup(
    const GroupingOptions& options, const PairOfSubmaps& pair,
    const Eigen::Vector2d& query_centroid,
    std::vector<GroupedRelation>* const relations) {
  const auto are_near = [&](const GroupedRelation& a,
                            const GroupedRelation& b) {
    return AreNear(a.T_reference_query, b.T_reference_query, query_centroid,
                   {options.max_distance_meters, options.max_rotation});
  };
  const GroupedRelation* centre = nullptr;
  size_t most = 0;
  for (const GroupedRelation& candidate : *relations) {
    const size_t count =
        static_cast<size_t>(std::count_if(relations->begin(), relations->end(),
                                          [&](const GroupedRelation& other) {
                                            return are_near(candidate, other);
                                          }));
    if (count > most) {
      most = count;
      centre = &candidate;
    }
  }
  // Only non-finite poses are near to nothing; readers reject them.
  CHECK(centre != nullptr);
  ConstraintGroup group{pair.first, pair.second, centre->T_reference_query, {}};
  std::vector<GroupedRelation> rest;
  for (const GroupedRelation& relation : *relations) {
    if (are_near(*centre, relation)) {
      group.constraints.push_back(relation.constraint);
    } else {
      rest.push_back(relation);
    }
  }
  *relations = std::move(rest);
  return group;
}

// Returns the poses of pairs of submaps that inter-submap constraints imply.
// Constraints that relate no two submaps with centroids go to `unrelated`.
std::map<PairOfSubmaps, std::vector<GroupedRelation>> RelateSubmaps(
    const PoseGraph& pose_graph,
    const std::map<SubmapId, Eigen::Vector2d>& centroids,
    std::vector<size_t>* const unrelated) {
  const std::map<NodeId, std::vector<Insertion>> insertions =
      Insertions(pose_graph);
  std::map<PairOfSubmaps, std::vector<GroupedRelation>> relations;
  for (size_t k = 0; k < pose_graph.constraints.size(); ++k) {
    const Constraint& constraint = pose_graph.constraints[k];
    if (constraint.tag != Constraint::Tag::kInterSubmap) continue;
    const auto inserted = insertions.find(constraint.node);
    const Insertion* const insertion =
        inserted == insertions.end()
            ? nullptr
            : BestInsertion(inserted->second, constraint.submap, centroids);
    if (insertion == nullptr || centroids.count(constraint.submap) == 0) {
      unrelated->push_back(k);
      continue;
    }
    const Rigid2 T_submap_other =
        constraint.T_submap_node * insertion->T_submap_node.Inverse();
    if (constraint.submap < insertion->submap) {
      relations[{constraint.submap, insertion->submap}].push_back(
          {k, T_submap_other});
    } else {
      relations[{insertion->submap, constraint.submap}].push_back(
          {k, T_submap_other.Inverse()});
    }
  }
  return relations;
}

}  // namespace

std::string Validate(const GroupingOptions& options) {
  if (!(options.max_distance_meters > 0. && options.max_rotation > 0.)) {
    return "max_distance_meters and max_rotation must be positive";
  }
  return "";
}

GroupedConstraints GroupConstraints(
    const GroupingOptions& options, const PoseGraph& pose_graph,
    const std::map<SubmapId, Eigen::Vector2d>& centroids) {
  CHECK_EQ(Validate(options), "");
  GroupedConstraints result;
  std::map<PairOfSubmaps, std::vector<GroupedRelation>> relations =
      RelateSubmaps(pose_graph, centroids, &result.unrelated);
  for (auto& [pair, members] : relations) {
    const size_t first = result.groups.size();
    while (!members.empty()) {
      result.groups.push_back(
          TakeLargestGroup(options, pair, centroids.at(pair.second), &members));
    }
    std::sort(result.groups.begin() + static_cast<std::ptrdiff_t>(first),
              result.groups.end(),
              [](const ConstraintGroup& a, const ConstraintGroup& b) {
                return a.constraints.front() < b.constraints.front();
              });
  }
  return result;
}

}  // namespace cartographer_sdf
