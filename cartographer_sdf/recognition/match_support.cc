// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/match_support.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// The poses (reference <- query) of matches that support others.
using Supporters = std::map<IdPair, Rigid2>;

void Add(const NeighbourhoodMaps& maps, const PairPose& pair,
         Supporters* const supporters) {
  supporters->emplace(IdPair(pair.reference, pair.query),
                      pair.T_reference_query);
  // Within one map, which of the two is the reference means nothing.
  if (maps.min_index_gap) {
    supporters->emplace(IdPair(pair.query, pair.reference),
                        pair.T_reference_query.Inverse());
  }
}

int CountSupporters(const MatchSupportOptions& options,
                    const NeighbourhoodMaps& maps, const Supporters& supporters,
                    const PairPose& pair) {
  int count = 0;
  const std::vector<SubmapId> queries =
      SubmapsAround(maps.queries, maps.query_links, pair.query,
                    options.max_index_distance, 1);
  for (const SubmapId& i :
       SubmapsAround(maps.references, maps.reference_links, pair.reference,
                     options.max_index_distance, 1)) {
    for (const SubmapId& j : queries) {
      if (i == pair.reference && j == pair.query) continue;
      const auto supporter = supporters.find({i, j});
      if (supporter == supporters.end()) continue;
      const Rigid2 predicted =
          RelativePose(maps.references, pair.reference, i) * supporter->second *
          RelativePose(maps.queries, j, pair.query);
      const Rigid2 error = predicted.Inverse() * pair.T_reference_query;
      count += error.translation().norm() < options.max_distance_meters &&
               std::abs(error.rotation()) < options.max_rotation;
    }
  }
  return count;
}

bool IsCertain(const MatchSupportOptions& options, const Match& match) {
  return match.verdict == Verdict::kAccepted &&
         match.pair.score >= options.min_unsupported_score;
}

Verdict JudgeWithSupport(const MatchSupportOptions& options,
                         const Match& match) {
  const bool is_supported = *match.num_supporting > 0;
  if (match.verdict == Verdict::kAccepted && !is_supported &&
      !IsCertain(options, match)) {
    return Verdict::kUncertain;
  }
  if (match.verdict == Verdict::kUnlikely && is_supported && !match.has_rival &&
      match.pair.score >= options.min_supported_score) {
    return Verdict::kAccepted;
  }
  return match.verdict;
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
  Supporters latest;
  for (Match& match : *matches) {
    match.num_supporting = 0;
    if (IsCertain(options, match)) Add(maps, match.pair, &latest);
  }
  while (!latest.empty()) {
    Supporters next;
    for (Match& match : *matches) {
      const bool was_supported = *match.num_supporting > 0;
      *match.num_supporting +=
          CountSupporters(options, maps, latest, match.pair);
      if (!was_supported && *match.num_supporting > 0 &&
          match.verdict == Verdict::kAccepted && !IsCertain(options, match)) {
        Add(maps, match.pair, &next);
      }
    }
    latest = std::move(next);
  }
  for (Match& match : *matches) {
    match.verdict = JudgeWithSupport(options, match);
  }
}

}  // namespace cartographer_sdf
