// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/match_support.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// A match opposes those that lie this far, in units of what support allows,
// from where it puts them, and what local SLAM may have drifted on the way, as
// a fraction of it and in rotation [rad / sqrt(m)].
constexpr double kOpposingDistance = 1.5;
constexpr double kDriftPerMeter = 0.01;
constexpr double kRotationDriftPerSqrtMeter = 0.01;
// So many times as many as support a match must oppose it to refuse it: what
// opposes may be wrong as well, or a submap between bent.
constexpr int kOutvotingRatio = 2;
// What matches that are certain together add up to, beyond a certain one: the
// score of each holds what its neighbours, which count as well, say of it.
constexpr double kGroupSurplus = 2.;
// Submaps so many indices apart share no scans.
constexpr int kMinIndexDistance = 2;

// Where the matches are, by the ids of their pairs.
using MatchIndices = std::map<IdPair, size_t>;

bool IsCertain(const MatchSupportOptions& options, const Match& match) {
  return match.verdict == Verdict::kAccepted &&
         match.pair.score >= options.min_unsupported_score;
}

Verdict JudgeWithSupport(const MatchSupportOptions& options,
                         const Match& match) {
  const bool is_supported = *match.num_supporting > 0;
  const bool is_outvoted =
      *match.num_opposing > kOutvotingRatio * *match.num_supporting;
  if (match.verdict == Verdict::kAccepted &&
      (is_outvoted || (!is_supported && !IsCertain(options, match)))) {
    return Verdict::kUncertain;
  }
  if (match.verdict == Verdict::kUnlikely && is_supported && !is_outvoted &&
      !match.has_rival && match.pair.score >= options.min_supported_score) {
    return Verdict::kAccepted;
  }
  return match.verdict;
}

// Where a match puts a pair of submaps around its own.
struct Prediction {
  Rigid2 T_reference_query;
  double way;  // driven between, on both sides [m]
};

double WayBetween(const TrajectoryPlaces& map, const SubmapId& a,
                  const SubmapId& b) {
  return std::abs(map.odometry->at(a).distance_driven -
                  map.odometry->at(b).distance_driven);
}

// Calls visit(index, prediction) for each match of submaps around those of
// `pair`, with where `pair` puts it.
template <typename Visitor>
void VisitMatchesAround(const MatchSupportOptions& options,
                        const NeighbourhoodMaps& maps,
                        const MatchIndices& indices, const PairPose& pair,
                        const Visitor& visit) {
  const std::vector<SubmapId> queries =
      SubmapsAround(maps.queries, maps.query_links, pair.query,
                    options.max_index_distance, 1);
  for (const SubmapId& i :
       SubmapsAround(maps.references, maps.reference_links, pair.reference,
                     options.max_index_distance, 1)) {
    const Rigid2 T_i_query = RelativePose(maps.references, i, pair.reference) *
                             pair.T_reference_query;
    for (const SubmapId& j : queries) {
      if (i == pair.reference && j == pair.query) continue;
      const Rigid2 T_i_j =
          T_i_query * RelativePose(maps.queries, pair.query, j);
      const double way = WayBetween(maps.references, pair.reference, i) +
                         WayBetween(maps.queries, pair.query, j);
      const auto match = indices.find({i, j});
      if (match != indices.end()) visit(match->second, Prediction{T_i_j, way});
      // Within one map, which of the two is the reference means nothing.
      if (!maps.min_index_gap || (i == pair.query && j == pair.reference)) {
        continue;
      }
      const auto swapped = indices.find({j, i});
      if (swapped != indices.end()) {
        visit(swapped->second, Prediction{T_i_j.Inverse(), way});
      }
    }
  }
}

// How a match judges another by where it puts it.
enum class Vote { kSupports, kNeither, kOpposes };

Vote VoteFor(const MatchSupportOptions& options, const Prediction& prediction,
             const Rigid2& T_reference_query) {
  const Rigid2 T_predicted_query =
      prediction.T_reference_query.Inverse() * T_reference_query;
  const double distance = T_predicted_query.translation().norm();
  const double rotation = std::abs(T_predicted_query.rotation());
  if (distance < options.max_distance_meters &&
      rotation < options.max_rotation) {
    return Vote::kSupports;
  }
  const bool opposes =
      distance > kOpposingDistance * options.max_distance_meters +
                     kDriftPerMeter * prediction.way ||
      rotation > kOpposingDistance * options.max_rotation +
                     kRotationDriftPerSqrtMeter * std::sqrt(prediction.way);
  return opposes ? Vote::kOpposes : Vote::kNeither;
}

// The match, and all that it supports and those support, among those in
// `indices`; adds them to `seen`.
std::vector<size_t> GroupOf(const MatchSupportOptions& options,
                            const NeighbourhoodMaps& maps,
                            const std::vector<Match>& matches,
                            const MatchIndices& indices, const size_t first,
                            std::set<size_t>* const seen) {
  std::vector<size_t> group = {first};
  seen->insert(first);
  for (size_t next = 0; next < group.size(); ++next) {
    VisitMatchesAround(
        options, maps, indices, matches[group[next]].pair,
        [&](const size_t k, const Prediction& prediction) {
          if (VoteFor(options, prediction, matches[k].pair.T_reference_query) ==
                  Vote::kSupports &&
              seen->insert(k).second) {
            group.push_back(k);
          }
        });
  }
  return group;
}

// Whether it is likely, and suits no other pose and no other place.
bool IsLikelyWithoutRival(const MatchSupportOptions& options,
                          const Match& match) {
  return (match.verdict == Verdict::kAccepted ||
          match.verdict == Verdict::kUnlikely) &&
         match.pair.score >= options.min_supported_score && !match.has_rival &&
         match.margin >= kMaxMargin;
}

// Whether the two pairs of submaps have scans in common.
bool PairsShareScans(const NeighbourhoodMaps& maps, const PairPose& a,
                     const PairPose& b) {
  const auto share = [](const SubmapId& one, const SubmapId& other) {
    return one.trajectory == other.trajectory &&
           std::abs(one.index - other.index) < kMinIndexDistance;
  };
  return share(a.reference, b.reference) || share(a.query, b.query) ||
         (maps.min_index_gap &&
          (share(a.reference, b.query) || share(a.query, b.reference)));
}

// Whether one of the group is accepted, and its best that share no scans are
// worth more than a certain one. One with a certain match needs no other: that
// supports it.
bool IsCertainTogether(const MatchSupportOptions& options,
                       const NeighbourhoodMaps& maps,
                       const std::vector<Match>& matches,
                       const std::vector<size_t>& group) {
  bool has_accepted = false;
  std::vector<const PairPose*> pairs;
  for (const size_t k : group) {
    if (IsCertain(options, matches[k])) return false;
    has_accepted |= matches[k].verdict == Verdict::kAccepted;
    pairs.push_back(&matches[k].pair);
  }
  if (!has_accepted) return false;
  std::sort(pairs.begin(), pairs.end(),
            [](const PairPose* const a, const PairPose* const b) {
              return IsBeforeByScore(*a, *b);
            });
  std::vector<const PairPose*> counted;
  double score = 0.;
  for (const PairPose* const pair : pairs) {
    const bool is_counted = std::any_of(
        counted.begin(), counted.end(), [&](const PairPose* const other) {
          return PairsShareScans(maps, *pair, *other);
        });
    if (is_counted) continue;
    counted.push_back(pair);
    score += pair->score;
  }
  return score >= options.min_unsupported_score + kGroupSurplus;
}

// Returns the matches that are certain together.
std::vector<size_t> FindCertainTogether(const MatchSupportOptions& options,
                                        const NeighbourhoodMaps& maps,
                                        const std::vector<Match>& matches) {
  std::vector<size_t> certain;
  for (const std::vector<size_t>& group : FindSupportingGroups(
           options, maps, matches, [&options](const Match& match) {
             return IsLikelyWithoutRival(options, match);
           })) {
    if (IsCertainTogether(options, maps, matches, group)) {
      certain.insert(certain.end(), group.begin(), group.end());
    }
  }
  return certain;
}

}  // namespace

std::string Validate(const MatchSupportOptions& options) {
  if (!(std::isfinite(options.min_unsupported_score) &&
        std::isfinite(options.min_supported_score))) {
    return "min_unsupported_score and min_supported_score must be finite";
  }
  if (options.min_supported_score > options.min_unsupported_score) {
    return "min_supported_score must not exceed min_unsupported_score";
  }
  if (options.max_index_distance < 0 || options.max_index_distance > 100) {
    return "max_index_distance must lie between 0 and 100";
  }
  if (!(options.max_distance_meters >= 0. && options.max_rotation >= 0.)) {
    return "max_distance_meters and max_rotation must not be negative";
  }
  return "";
}

void JudgeBySupport(const MatchSupportOptions& options,
                    const NeighbourhoodMaps& maps,
                    std::vector<Match>* const matches) {
  CHECK_EQ(Validate(options), "");
  MatchIndices indices;
  std::vector<size_t> supporting = FindCertainTogether(options, maps, *matches);
  std::set<size_t> is_supporting(supporting.begin(), supporting.end());
  for (size_t k = 0; k < matches->size(); ++k) {
    Match& match = (*matches)[k];
    indices.emplace(IdPair(match.pair.reference, match.pair.query), k);
    match.num_supporting = 0;
    match.num_opposing = 0;
    if (IsCertain(options, match) && is_supporting.insert(k).second) {
      supporting.push_back(k);
    }
  }
  // Grows, as what is supported supports in its turn.
  for (size_t next = 0; next < supporting.size(); ++next) {
    VisitMatchesAround(
        options, maps, indices, (*matches)[supporting[next]].pair,
        [&](const size_t k, const Prediction& prediction) {
          Match& match = (*matches)[k];
          const Vote vote =
              VoteFor(options, prediction, match.pair.T_reference_query);
          if (vote == Vote::kOpposes) ++*match.num_opposing;
          if (vote != Vote::kSupports) return;
          ++*match.num_supporting;
          if (match.verdict == Verdict::kAccepted &&
              is_supporting.insert(k).second) {
            supporting.push_back(k);
          }
        });
  }
  for (Match& match : *matches) {
    match.verdict = JudgeWithSupport(options, match);
  }
}

std::vector<std::vector<size_t>> FindSupportingGroups(
    const MatchSupportOptions& options, const NeighbourhoodMaps& maps,
    const std::vector<Match>& matches,
    const std::function<bool(const Match&)>& may_join) {
  MatchIndices indices;
  for (size_t k = 0; k < matches.size(); ++k) {
    if (!may_join(matches[k])) continue;
    indices.emplace(IdPair(matches[k].pair.reference, matches[k].pair.query),
                    k);
  }
  std::vector<std::vector<size_t>> groups;
  std::set<size_t> seen;
  for (const auto& entry : indices) {
    if (seen.count(entry.second) > 0) continue;
    groups.push_back(
        GroupOf(options, maps, matches, indices, entry.second, &seen));
  }
  return groups;
}

}  // namespace cartographer_sdf
