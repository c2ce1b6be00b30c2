// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/placement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

#include "cartographer_sdf/geometry/alignment.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// What two votes say of each other.
enum class Relation { kAgree, kSilent, kExclude };

class Votes {
 public:
  Votes(const PlacementOptions& options, const ConsistencyOptions& consistency,
        const MapPair& maps, const std::vector<PairPose>& closures)
      : options_(options),
        consistency_(consistency),
        maps_(maps),
        closures_(closures),
        relations_(closures.size() * closures.size(), Relation::kAgree) {
    for (size_t a = 0; a < closures.size(); ++a) {
      for (size_t b = a + 1; b < closures.size(); ++b) {
        relations_[a * closures.size() + b] =
            relations_[b * closures.size() + a] =
                Relate(closures[a], closures[b]);
      }
    }
  }

  [[nodiscard]] Relation Between(const size_t a, const size_t b) const {
    return relations_[a * closures_.size() + b];
  }

  // Scores that agree less those that exclude, over the votes of a placement.
  [[nodiscard]] double Support(const size_t vote,
                               const std::vector<size_t>& others) const {
    double support = 0.;
    for (const size_t other : others) {
      if (other == vote) continue;
      const double score = std::max(closures_[other].score, 0.);
      const Relation relation = Between(vote, other);
      if (relation == Relation::kAgree) support += score;
      if (relation == Relation::kExclude) support -= score;
    }
    return support;
  }

 private:
  [[nodiscard]] Relation Relate(const PairPose& a, const PairPose& b) const {
    const std::optional<double> way_in_query =
        maps_.query->distances.Between(a.query, b.query);
    if (!way_in_query) return Relation::kSilent;
    const bool is_same =
        AreNear(PlaceByVote(maps_, a, b.query), PlaceByVote(maps_, b, b.query),
                maps_.query->centroids.at(b.query),
                {options_.same_distance_meters, options_.same_rotation});
    switch (CheckWay(a, b, *way_in_query)) {
      case CycleVerdict::kConsistent:
        return Relation::kAgree;
      case CycleVerdict::kInconsistent:
        // Nearly the same place is no other one; one of the two is imprecise.
        return is_same ? Relation::kSilent : Relation::kExclude;
      case CycleVerdict::kUninformative:
        break;
    }
    // The map may have drifted between the two, but not the query: either the
    // map shows one place twice, or two places are alike. Nobody can tell.
    if (*way_in_query > options_.independent_distance_meters) {
      return Relation::kSilent;
    }
    return is_same ? Relation::kAgree : Relation::kExclude;
  }

  // Of the cycle through both maps.
  [[nodiscard]] CycleVerdict CheckWay(const PairPose& a, const PairPose& b,
                                      const double way_in_query) const {
    const std::optional<double> way_in_map =
        maps_.map->distances.Between(a.reference, b.reference);
    if (!way_in_map) return CycleVerdict::kUninformative;
    const SubmapId reference_a{0, 0}, reference_b{0, 1};
    const SubmapId query_a{1, 0}, query_b{1, 1};
    const auto& map_poses = maps_.map->T_map_submap;
    const auto& query_poses = maps_.query->T_map_submap;
    const std::map<SubmapId, OdometryPose> ways = {
        {reference_a, {map_poses.at(a.reference), 0.}},
        {reference_b, {map_poses.at(b.reference), *way_in_map}},
        {query_a, {query_poses.at(a.query), 0.}},
        {query_b, {query_poses.at(b.query), way_in_query}}};
    PairPose renamed_a = a, renamed_b = b;
    renamed_a.reference = reference_a;
    renamed_a.query = query_a;
    renamed_b.reference = reference_b;
    renamed_b.query = query_b;
    return CheckCycle(consistency_, ways, renamed_a, renamed_b);
  }

  const PlacementOptions& options_;
  const ConsistencyOptions& consistency_;
  const MapPair& maps_;
  const std::vector<PairPose>& closures_;
  std::vector<Relation> relations_;
};

// Votes in an order that does not depend on theirs: weightiest first.
std::vector<size_t> InOrderOfWeight(const Votes& votes,
                                    const std::vector<PairPose>& closures) {
  std::vector<size_t> order(closures.size());
  for (size_t k = 0; k < order.size(); ++k) order[k] = k;
  // Sums in the order of ids, so that they round the same.
  std::sort(order.begin(), order.end(), [&](const size_t a, const size_t b) {
    return IsBeforeByIds(closures[a], closures[b]);
  });
  std::vector<double> weights(closures.size());
  for (size_t k = 0; k < closures.size(); ++k) {
    weights[k] = closures[k].score + votes.Support(k, order);
  }
  std::stable_sort(
      order.begin(), order.end(),
      [&](const size_t a, const size_t b) { return weights[a] > weights[b]; });
  return order;
}

// What two groups of votes say of each other.
double SupportBetween(const Votes& votes, const std::vector<size_t>& a,
                      const std::vector<size_t>& b) {
  double support = 0.;
  for (const size_t vote : a) support += votes.Support(vote, b);
  return support;
}

// Groups that began far apart may have met.
void MergeGroups(const Votes& votes,
                 std::vector<std::vector<size_t>>* const all_groups) {
  std::vector<std::vector<size_t>>& groups = *all_groups;
  while (true) {
    double best_support = 0.;
    size_t best_a = 0, best_b = 0;
    for (size_t a = 0; a < groups.size(); ++a) {
      for (size_t b = a + 1; b < groups.size(); ++b) {
        const double support = SupportBetween(votes, groups[a], groups[b]) +
                               SupportBetween(votes, groups[b], groups[a]);
        if (support > best_support) {
          std::tie(best_support, best_a, best_b) = std::tuple(support, a, b);
        }
      }
    }
    if (!(best_support > 0.)) return;
    groups[best_a].insert(groups[best_a].end(), groups[best_b].begin(),
                          groups[best_b].end());
    groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(best_b));
  }
}

std::vector<std::vector<size_t>> GroupVotes(
    const Votes& votes, const std::vector<PairPose>& closures) {
  std::vector<std::vector<size_t>> groups;
  for (const size_t vote : InOrderOfWeight(votes, closures)) {
    std::vector<size_t>* best = nullptr;
    double best_support = 0.;
    for (std::vector<size_t>& group : groups) {
      const double support = votes.Support(vote, group);
      if (support > best_support) {
        best = &group;
        best_support = support;
      }
    }
    if (best == nullptr) {
      groups.push_back({vote});
    } else {
      best->push_back(vote);
    }
  }
  MergeGroups(votes, &groups);
  return groups;
}

// Evidence of different places: each place of the query by its best vote, less
// where a better one is near.
double ScoreOf(const PlacementOptions& options, const MapPair& maps,
               const std::vector<PairPose>& closures,
               const std::vector<size_t>& votes) {
  std::map<SubmapId, double> scores;
  for (const size_t vote : votes) {
    double& score = scores.emplace(closures[vote].query, 0.).first->second;
    score = std::max(score,
                     std::min(closures[vote].score, options.max_place_score));
  }
  std::vector<std::pair<double, SubmapId>> order;
  for (const auto& [id, score] : scores) order.emplace_back(-score, id);
  std::sort(order.begin(), order.end());
  std::vector<Eigen::Vector2d> counted;
  double sum = 0.;
  for (const auto& [negative_score, id] : order) {
    const Eigen::Vector2d position =
        maps.query->T_map_submap.at(id) * maps.query->centroids.at(id);
    double distance = options.independent_distance_meters;
    for (const Eigen::Vector2d& other : counted) {
      distance = std::min(distance, (position - other).norm());
    }
    counted.push_back(position);
    sum += -negative_score * distance / options.independent_distance_meters;
  }
  return sum;
}

// Fits the places that meet: the middle of each, and a point beside it that
// holds its rotation.
Rigid2 FitVotes(const MapPair& maps, const std::vector<PairPose>& closures,
                const std::vector<size_t>& votes) {
  constexpr double kLever = 5.;  // [m], about the size of what is matched
  std::vector<Eigen::Vector2d> p_map, p_query;
  std::vector<double> weights;
  for (const size_t vote : votes) {
    const PairPose& closure = closures[vote];
    const Eigen::Vector2d& centroid = maps.query->centroids.at(closure.query);
    const Rigid2& T_query_submap = maps.query->T_map_submap.at(closure.query);
    const Rigid2 T_map_submap = PlaceByVote(maps, closure, closure.query);
    for (const Eigen::Vector2d& offset :
         {Eigen::Vector2d(kLever, 0.), Eigen::Vector2d(-kLever, 0.),
          Eigen::Vector2d(0., kLever), Eigen::Vector2d(0., -kLever)}) {
      p_map.push_back(T_map_submap * Eigen::Vector2d(centroid + offset));
      p_query.push_back(T_query_submap * Eigen::Vector2d(centroid + offset));
      weights.push_back(std::max(closure.score, 1e-3));
    }
  }
  const std::optional<Rigid2> fitted = AlignPointPairs(p_map, p_query, weights);
  if (fitted) return *fitted;
  // Votes that cancel out, such as half turns of each other.
  const PairPose& first = closures[votes.front()];
  return PlaceByVote(maps, first, first.query) *
         maps.query->T_map_submap.at(first.query).Inverse();
}

}  // namespace

std::string Validate(const PlacementOptions& options) {
  if (!(options.independent_distance_meters > 0.)) {
    return "independent_distance_meters must be positive";
  }
  if (!(options.max_place_score > 0. && options.min_score > 0.)) {
    return "max_place_score and min_score must be positive";
  }
  if (!(options.min_lead >= 0.)) return "min_lead must not be negative";
  if (!(options.max_contradicting_fraction >= 0. &&
        options.max_contradicting_fraction <= 1.)) {
    return "max_contradicting_fraction must lie between 0 and 1";
  }
  if (!(options.same_distance_meters > 0. && options.same_rotation > 0.)) {
    return "same_distance_meters and same_rotation must be positive";
  }
  if (!(options.min_observed_area >= 0.)) {
    return "min_observed_area must not be negative";
  }
  return "";
}

std::vector<Placement> FindPlacements(const PlacementOptions& options,
                                      const ConsistencyOptions& consistency,
                                      const MapPair& maps,
                                      const std::vector<PairPose>& closures) {
  CHECK_EQ(Validate(options), "");
  const Votes votes(options, consistency, maps, closures);
  std::vector<Placement> placements;
  for (std::vector<size_t>& group : GroupVotes(votes, closures)) {
    // In the order of ids: sums round the same whatever the order was.
    std::sort(group.begin(), group.end(), [&](const size_t a, const size_t b) {
      return IsBeforeByIds(closures[a], closures[b]);
    });
    Placement placement;
    placement.T_map_query = FitVotes(maps, closures, group);
    placement.score = ScoreOf(options, maps, closures, group);
    placement.votes = std::move(group);
    placements.push_back(std::move(placement));
  }
  std::stable_sort(
      placements.begin(), placements.end(),
      [](const Placement& a, const Placement& b) { return a.score > b.score; });
  for (size_t k = 1; k < placements.size(); ++k) {
    placements[k].is_rival =
        SupportBetween(votes, placements[k].votes, placements[0].votes) < 0.;
  }
  return placements;
}

Rigid2 PlaceByVote(const MapPair& maps, const PairPose& vote,
                   const SubmapId& query) {
  const std::map<SubmapId, Rigid2>& query_poses = maps.query->T_map_submap;
  return maps.map->T_map_submap.at(vote.reference) * vote.T_reference_query *
         query_poses.at(vote.query).Inverse() * query_poses.at(query);
}

MapLayout MakeMapLayout(const PoseGraph& pose_graph,
                        const std::map<SubmapId, OdometryPose>& odometry,
                        const std::map<SubmapId, Place>& places) {
  MapLayout layout{
      pose_graph.submap_poses, {}, DrivenDistances(pose_graph, odometry)};
  for (const auto& [id, place] : places) {
    layout.centroids.emplace(id, ObservedCentroid(place.surface));
  }
  return layout;
}

}  // namespace cartographer_sdf
