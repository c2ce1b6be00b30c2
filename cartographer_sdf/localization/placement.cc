// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/placement.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <tuple>
#include <utility>

#include "cartographer_sdf/geometry/alignment.h"
#include "cartographer_sdf/geometry/distinct_poses.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Checks the cycle of two votes through both maps.
CycleVerdict CheckWay(const ConsistencyOptions& consistency,
                      const MapPair& maps, const PairPose& a, const PairPose& b,
                      const double way_in_query) {
  const std::optional<double> way_in_map =
      maps.map->distances.Between(a.reference, b.reference);
  if (!way_in_map) return CycleVerdict::kUninformative;
  PairPose renamed_a = a, renamed_b = b;
  renamed_a.reference = {0, 0};
  renamed_b.reference = {0, 1};
  renamed_a.query = {1, 0};
  renamed_b.query = {1, 1};
  const auto& map_poses = maps.map->T_map_submap;
  const auto& query_poses = maps.query->T_map_submap;
  return CheckCycle(
      consistency,
      {{renamed_a.reference, {map_poses.at(a.reference), 0.}},
       {renamed_b.reference, {map_poses.at(b.reference), *way_in_map}},
       {renamed_a.query, {query_poses.at(a.query), 0.}},
       {renamed_b.query, {query_poses.at(b.query), way_in_query}}},
      renamed_a, renamed_b);
}

// Relates two votes: consistent ones agree, inconsistent ones exclude each
// other.
CycleVerdict Relate(const PlacementOptions& options,
                    const ConsistencyOptions& consistency, const MapPair& maps,
                    const PairPose& a, const PairPose& b) {
  const std::optional<double> way_in_query =
      maps.query->distances.Between(a.query, b.query);
  if (!way_in_query) return CycleVerdict::kUninformative;
  const bool is_same =
      AreNear(PlaceByVote(maps, a, b.query), PlaceByVote(maps, b, b.query),
              maps.query->centroids.at(b.query),
              {options.same_distance_meters, options.same_rotation});
  const CycleVerdict verdict = CheckWay(consistency, maps, a, b, *way_in_query);
  // Nearly equal poses do not exclude each other; one of the two is imprecise.
  if (verdict == CycleVerdict::kInconsistent && is_same) {
    return CycleVerdict::kUninformative;
  }
  // Otherwise the map may have drifted between the two, but not the query:
  // either the map contains one place twice, or two places look alike. This is
  // decidable only for votes on one place of the query.
  if (verdict != CycleVerdict::kUninformative ||
      *way_in_query > options.independent_distance_meters) {
    return verdict;
  }
  return is_same ? CycleVerdict::kConsistent : CycleVerdict::kInconsistent;
}

// Returns the support of the votes in `a` by those in `b`.
double SupportBetween(const VerdictTable& votes, const std::vector<size_t>& a,
                      const std::vector<size_t>& b) {
  double support = 0.;
  for (const size_t vote : a) support += votes.Support(vote, b);
  return support;
}

// Merges groups that support each other: those that began far apart may have
// met.
void MergeGroups(const VerdictTable& votes,
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

std::vector<std::vector<size_t>> GroupVotes(const VerdictTable& votes) {
  std::vector<std::vector<size_t>> groups;
  for (const size_t vote : votes.InOrderOfWeight()) {
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

// Ground that places show, as tiles of a square metre: each shows a disc.
class ShownGround {
 public:
  // Adds a disc; returns the fraction of it that was not shown before. A disc
  // that holds the middle of no tile counts as new.
  double Add(const Eigen::Vector2d& centre, const double diameter) {
    const double radius = 0.5 * diameter;
    const auto size = static_cast<int64_t>(std::ceil(diameter)) + 1;
    const auto first_x = static_cast<int64_t>(std::floor(centre.x() - radius));
    const auto first_y = static_cast<int64_t>(std::floor(centre.y() - radius));
    int num_tiles = 0, num_new = 0;
    for (int64_t x = first_x; x < first_x + size; ++x) {
      for (int64_t y = first_y; y < first_y + size; ++y) {
        const Eigen::Vector2d tile(static_cast<double>(x) + 0.5,
                                   static_cast<double>(y) + 0.5);
        if ((tile - centre).norm() > radius) continue;
        ++num_tiles;
        num_new += tiles_.emplace(x, y).second;
      }
    }
    return num_tiles == 0 ? 1. : static_cast<double>(num_new) / num_tiles;
  }

 private:
  std::set<std::pair<int64_t, int64_t>> tiles_;
};

// Sums the evidence of distinct places: each place of the query counts by its
// votes, as far as better ones do not show the same ground.
double ScoreOf(const PlacementOptions& options, const MapPair& maps,
               const std::vector<PairPose>& closures,
               const std::vector<size_t>& votes) {
  std::map<SubmapId, double> best, sums;
  for (const size_t vote : votes) {
    const SubmapId& query = closures[vote].query;
    const double score =
        std::clamp(closures[vote].score, 0., options.max_place_score);
    best[query] = std::max(best[query], score);
    sums[query] += score;
  }
  std::map<SubmapId, double> scores;
  for (const auto& [id, score] : best) {
    scores[id] = score + options.further_match_weight * (sums[id] - score);
  }
  std::vector<std::pair<double, SubmapId>> order;
  for (const auto& [id, score] : scores) order.emplace_back(-score, id);
  std::sort(order.begin(), order.end());
  ShownGround ground;
  double sum = 0.;
  for (const auto& [negative_score, id] : order) {
    const double diameter = std::max(options.independent_distance_meters,
                                     maps.query->diameters.at(id));
    sum += -negative_score * ground.Add(maps.query->T_map_submap.at(id) *
                                            maps.query->centroids.at(id),
                                        diameter);
  }
  return sum;
}

// Fits the pose to the votes: four points around the centroid of each place, so
// that its rotation counts too.
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
  // The votes cancel out, such as half turns of each other.
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
  if (!(options.further_match_weight >= 0. &&
        options.further_match_weight <= 1.)) {
    return "further_match_weight must lie between 0 and 1";
  }
  if (!(options.min_lead >= 0.)) return "min_lead must not be negative";
  if (!(options.max_contradiction_ratio >= 0.)) {
    return "max_contradiction_ratio must not be negative";
  }
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
                                      const std::vector<PairPose>& votes) {
  CHECK_EQ(Validate(options), "");
  const VerdictTable verdicts(votes, [&](const PairPose& a, const PairPose& b) {
    return Relate(options, consistency, maps, a, b);
  });
  std::vector<Placement> placements;
  for (std::vector<size_t>& group : GroupVotes(verdicts)) {
    // In the order of ids, so that sums round the same whatever the input
    // order.
    std::sort(group.begin(), group.end(), [&](const size_t a, const size_t b) {
      return IsBeforeByIds(votes[a], votes[b]);
    });
    Placement placement;
    placement.T_map_query = FitVotes(maps, votes, group);
    placement.score = ScoreOf(options, maps, votes, group);
    placement.votes = std::move(group);
    placements.push_back(std::move(placement));
  }
  std::stable_sort(
      placements.begin(), placements.end(),
      [](const Placement& a, const Placement& b) { return a.score > b.score; });
  for (size_t k = 1; k < placements.size(); ++k) {
    placements[k].is_rival =
        SupportBetween(verdicts, placements[k].votes, placements[0].votes) < 0.;
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
      pose_graph.submap_poses, {}, {}, DrivenDistances(pose_graph, odometry)};
  for (const auto& [id, place] : places) {
    layout.centroids.emplace(id, ObservedCentroid(place.surface));
    layout.diameters.emplace(
        id, 2. * std::sqrt(ObservedArea(place.surface) / M_PI));
  }
  return layout;
}

}  // namespace cartographer_sdf
