// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/location.h"

#include <algorithm>
#include <cmath>

namespace cartographer_sdf {
namespace {

// A pose is clearly another one beyond so many times the differences of the
// same one; between, it speaks neither for nor against.
constexpr double kDistinctRatio = 2.;

bool IsWithin(const LocalizationOptions& options, const double ratio,
              const Rigid2& T_map_a, const Rigid2& T_map_b) {
  const Rigid2 T_a_b = T_map_a.Inverse() * T_map_b;
  return T_a_b.translation().norm() <=
             ratio * options.max_translation_difference_meters &&
         std::abs(T_a_b.rotation()) <= ratio * options.max_rotation_difference;
}

}  // namespace

bool IsSamePose(const LocalizationOptions& options, const Rigid2& T_map_a,
                const Rigid2& T_map_b) {
  return IsWithin(options, 1., T_map_a, T_map_b);
}

std::optional<Location> FindLocation(const LocalizationOptions& options,
                                     const std::vector<PoseVote>& votes) {
  std::optional<Location> best;
  for (const PoseVote& leader : votes) {
    if (!leader.is_accepted) continue;
    Location location;
    location.T_map_query = leader.T_map_query;
    for (size_t k = 0; k < votes.size(); ++k) {
      if (!(votes[k].is_accepted || votes[k].is_likely) ||
          !IsSamePose(options, leader.T_map_query, votes[k].T_map_query)) {
        continue;
      }
      location.score += std::max(votes[k].score, 0.);
      location.supporters.push_back(k);
    }
    if (!best || location.score > best->score) best = std::move(location);
  }
  if (!best) return std::nullopt;
  std::stable_sort(best->supporters.begin(), best->supporters.end(),
                   [&votes](const size_t a, const size_t b) {
                     return votes[a].score > votes[b].score;
                   });
  best->T_map_query = votes[best->supporters.front()].T_map_query;
  for (const PoseVote& leader : votes) {
    if (IsWithin(options, kDistinctRatio, best->T_map_query,
                 leader.T_map_query)) {
      continue;
    }
    double score = 0.;
    for (const PoseVote& vote : votes) {
      if (IsSamePose(options, leader.T_map_query, vote.T_map_query)) {
        score += std::max(vote.score, 0.);
      }
    }
    best->runner_up_score = std::max(best->runner_up_score, score);
  }
  return best;
}

}  // namespace cartographer_sdf
