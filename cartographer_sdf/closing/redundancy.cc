// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/redundancy.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// A submap and one of which nodes are constrained to it.
using TiedSubmaps = std::pair<SubmapId, SubmapId>;

// The pose that pairs give to the nodes of a submap.
struct PairSide {
  size_t pair;
  Rigid2 T_submap_other;
};

std::map<TiedSubmaps, std::vector<PairSide>> SidesOf(
    const std::vector<PairPose>& pairs) {
  std::map<TiedSubmaps, std::vector<PairSide>> sides;
  for (size_t k = 0; k < pairs.size(); ++k) {
    const PairPose& pair = pairs[k];
    sides[{pair.reference, pair.query}].push_back({k, pair.T_reference_query});
    sides[{pair.query, pair.reference}].push_back(
        {k, pair.T_reference_query.Inverse()});
  }
  return sides;
}

// Into which submaps each node was inserted, and its pose there.
std::map<NodeId, std::vector<std::pair<SubmapId, Rigid2>>> SubmapsOf(
    const std::map<SubmapId, InsertedNodes>& nodes) {
  std::map<NodeId, std::vector<std::pair<SubmapId, Rigid2>>> submaps;
  for (const auto& [submap, inserted] : nodes) {
    for (const auto& [node, T_submap_node] : inserted) {
      submaps[node].emplace_back(submap, T_submap_node);
    }
  }
  return submaps;
}

bool AgreesWith(const ConstraintOptions& options, const Rigid2& T_submap_node,
                const Rigid2& expected) {
  return (T_submap_node.translation() - expected.translation()).norm() <=
             options.max_num_sigmas * options.translation_sigma_meters &&
         std::abs(
             NormalizeAngle(T_submap_node.rotation() - expected.rotation())) <=
             options.max_num_sigmas * options.rotation_sigma;
}

// Submaps, joined to trees.
class Forest {
 public:
  explicit Forest(const size_t num_submaps) : parents_(num_submaps) {
    std::iota(parents_.begin(), parents_.end(), size_t{0});
  }
  // Returns false if the two are joined already.
  bool Join(const size_t a, const size_t b) {
    const size_t root_a = Root(a), root_b = Root(b);
    if (root_a == root_b) return false;
    parents_[root_a] = root_b;
    return true;
  }

 private:
  size_t Root(size_t index) {
    while (parents_[index] != index) {
      parents_[index] = parents_[parents_[index]];
      index = parents_[index];
    }
    return index;
  }

  std::vector<size_t> parents_;
};

std::map<SubmapId, size_t> NumberSubmaps(const std::vector<PairPose>& pairs) {
  std::map<SubmapId, size_t> numbers;
  for (const PairPose& pair : pairs) {
    numbers.emplace(pair.reference, numbers.size());
    numbers.emplace(pair.query, numbers.size());
  }
  return numbers;
}

std::vector<size_t> OrderByScore(const std::vector<PairPose>& pairs) {
  std::vector<size_t> order(pairs.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](const size_t a, const size_t b) {
    return IsBeforeByScore(pairs[a], pairs[b]);
  });
  return order;
}

}  // namespace

std::string Validate(const RedundancyOptions& options) {
  if (options.min_num_ties < 1 || options.min_num_ties > 1000) {
    return "min_num_ties must lie between 1 and 1000";
  }
  return "";
}

std::vector<bool> AreInGraph(const ConstraintOptions& options,
                             const std::map<SubmapId, InsertedNodes>& nodes,
                             const PoseGraph& pose_graph,
                             const std::vector<PairPose>& pairs) {
  CHECK_EQ(Validate(options), "");
  const auto sides = SidesOf(pairs);
  const auto submaps = SubmapsOf(nodes);
  std::vector<int> num_constraints(pairs.size(), 0);
  for (const Constraint& constraint : pose_graph.constraints) {
    if (constraint.tag != Constraint::Tag::kInterSubmap) continue;
    const auto inserted = submaps.find(constraint.node);
    if (inserted == submaps.end()) continue;
    for (const auto& [submap, T_other_node] : inserted->second) {
      const auto tied = sides.find({constraint.submap, submap});
      if (tied == sides.end()) continue;
      for (const PairSide& side : tied->second) {
        num_constraints[side.pair] +=
            AgreesWith(options, constraint.T_submap_node,
                       side.T_submap_other * T_other_node);
      }
    }
  }
  std::vector<bool> are_in_graph;
  for (const int count : num_constraints) {
    are_in_graph.push_back(count >= options.min_num_constraints);
  }
  return are_in_graph;
}

std::vector<bool> KeepTies(const RedundancyOptions& options,
                           const std::vector<PairPose>& pairs) {
  CHECK_EQ(Validate(options), "");
  const std::map<SubmapId, size_t> numbers = NumberSubmaps(pairs);
  std::vector<Forest> forests(static_cast<size_t>(options.min_num_ties),
                              Forest(numbers.size()));
  std::vector<bool> keep(pairs.size(), false);
  for (const size_t k : OrderByScore(pairs)) {
    const size_t reference = numbers.at(pairs[k].reference);
    const size_t query = numbers.at(pairs[k].query);
    keep[k] = std::any_of(forests.begin(), forests.end(), [&](Forest& forest) {
      return forest.Join(reference, query);
    });
  }
  return keep;
}

}  // namespace cartographer_sdf
