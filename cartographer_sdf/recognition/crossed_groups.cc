// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/crossed_groups.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "cartographer_sdf/geometry/distinct_poses.h"
#include "cartographer_sdf/geometry/evenly_spaced.h"
#include "cartographer_sdf/verification/agreement.h"
#include "cartographer_sdf/verification/crossing_wall.h"
#include "cartographer_sdf/verification/registration.h"

namespace cartographer_sdf {
namespace {

// A pair of submaps where a group puts it.
struct GroupedPair {
  PairPose pair;
  bool is_match;  // otherwise predicted by one
};

class CrossingFinder {
 public:
  CrossingFinder(const VerificationOptions& verification,
                 const NeighbourhoodOptions& neighbourhood,
                 const NeighbourhoodMaps& maps)
      : verification_(verification),
        neighbourhood_(neighbourhood),
        maps_(maps) {}

  // Returns the matched pairs, and those around them that overlap where the
  // most likely match puts them, in the order of their ids.
  [[nodiscard]] std::vector<GroupedPair> PairsOf(
      const std::vector<Match>& matches, std::vector<size_t> group) const {
    std::sort(group.begin(), group.end(),
              [&matches](const size_t a, const size_t b) {
                return IsBeforeByScore(matches[a].pair, matches[b].pair);
              });
    std::map<IdPair, GroupedPair> pairs;
    for (const size_t k : group) {
      const PairPose& pair = matches[k].pair;
      pairs.insert({{pair.reference, pair.query}, {pair, true}});
    }
    for (const size_t k : group) AddAround(matches[k].pair, &pairs);
    std::vector<GroupedPair> result;
    for (const auto& entry : pairs) {
      const PairPose& pair = entry.second.pair;
      if (entry.second.is_match ||
          OverlapsEnough(Reference(pair.reference), Query(pair.query),
                         pair.T_reference_query)) {
        result.push_back(entry.second);
      }
    }
    return result;
  }

  // Returns the length of the longest crossing wall, where the walls of a
  // predicted pair register; nullopt if they do not, near the prediction.
  [[nodiscard]] std::optional<double> CrossingLength(
      const GroupedPair& grouped) const {
    PairPose pair = grouped.pair;
    const SurfaceModel& reference = Reference(pair.reference);
    const SurfaceModel& query = Query(pair.query);
    if (!grouped.is_match) {
      const std::optional<Rigid2> registered = RegisterSubmaps(
          verification_.registration, reference, query, pair.T_reference_query);
      if (!registered ||
          !AreNear(*registered, pair.T_reference_query, ObservedCentroid(query),
                   {neighbourhood_.max_prediction_error_meters,
                    neighbourhood_.max_prediction_rotation_error})) {
        return std::nullopt;
      }
      pair.T_reference_query = *registered;
    }
    return LongestCrossingWall(reference, query, pair.T_reference_query);
  }

 private:
  [[nodiscard]] const SurfaceModel& Reference(const SubmapId& id) const {
    return maps_.references.places->at(id).surface;
  }
  [[nodiscard]] const SurfaceModel& Query(const SubmapId& id) const {
    return maps_.queries.places->at(id).surface;
  }

  void AddAround(const PairPose& match,
                 std::map<IdPair, GroupedPair>* const pairs) const {
    const std::vector<SubmapId> queries =
        SubmapsAround(maps_.queries, maps_.query_links, match.query,
                      neighbourhood_.num_steps, neighbourhood_.index_step);
    for (const SubmapId& i :
         SubmapsAround(maps_.references, maps_.reference_links, match.reference,
                       neighbourhood_.num_steps, neighbourhood_.index_step)) {
      const Rigid2 T_i_query =
          RelativePose(maps_.references, i, match.reference) *
          match.T_reference_query;
      for (const SubmapId& j : queries) {
        pairs->insert(
            {{i, j},
             {{i, j, T_i_query * RelativePose(maps_.queries, match.query, j),
               0.},
              false}});
      }
    }
  }

  const VerificationOptions& verification_;
  const NeighbourhoodOptions& neighbourhood_;
  const NeighbourhoodMaps& maps_;
};

bool IsGroupCrossed(const CrossingOptions& options,
                    const CrossingFinder& finder,
                    const std::vector<GroupedPair>& pairs,
                    const Executor& executor) {
  const std::vector<size_t> indices = EvenlySpacedIndices(
      pairs.size(), std::min(pairs.size(), kMaxNumCrossingPairs));
  std::vector<std::optional<double>> lengths(indices.size());
  executor(indices.size(), [&](const size_t k) {
    lengths[k] = finder.CrossingLength(pairs[indices[k]]);
  });
  size_t num_compared = 0, num_crossed = 0;
  for (const std::optional<double>& length : lengths) {
    num_compared += length.has_value();
    num_crossed += length && *length > options.max_wall_meters;
  }
  return IsCrossed(options, num_crossed, num_compared);
}

bool IsBetweenTrajectories(const NeighbourhoodMaps& maps,
                           const PairPose& pair) {
  return !maps.min_index_gap ||
         pair.reference.trajectory != pair.query.trajectory;
}

}  // namespace

void RefuseCrossedGroups(const VerificationOptions& verification,
                         const NeighbourhoodOptions& neighbourhood,
                         const MatchSupportOptions& support,
                         const NeighbourhoodMaps& maps,
                         const Executor& executor,
                         std::vector<Match>* const matches) {
  const CrossingFinder finder(verification, neighbourhood, maps);
  for (const std::vector<size_t>& group : FindSupportingGroups(
           support, maps, *matches, [&maps](const Match& match) {
             return match.verdict == Verdict::kAccepted &&
                    IsBetweenTrajectories(maps, match.pair);
           })) {
    if (!IsGroupCrossed(verification.crossing, finder,
                        finder.PairsOf(*matches, group), executor)) {
      continue;
    }
    for (const size_t k : group) {
      (*matches)[k].verdict = Verdict::kContradicted;
    }
  }
}

}  // namespace cartographer_sdf
