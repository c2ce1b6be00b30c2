// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/rival_placements.h"

#include <algorithm>
#include <utility>

#include "cartographer_sdf/geometry/evenly_spaced.h"

namespace cartographer_sdf {
namespace {

// Votes that are asked, evenly spaced: neighbouring places resemble themselves
// in the same way.
constexpr size_t kMaxNumAskedVotes = 40;
// Votes of the placement that are measured, evenly spaced.
constexpr size_t kMaxNumMeasuredVotes = 200;
// Rivals that are measured, of those that most votes propose.
constexpr size_t kMaxNumMeasuredRivals = 3;

std::vector<PairPose> EvenlySpaced(const std::vector<PairPose>& votes,
                                   const size_t max_count) {
  std::vector<PairPose> result;
  for (const size_t index :
       EvenlySpacedIndices(votes.size(), std::min(votes.size(), max_count))) {
    result.push_back(votes[index]);
  }
  return result;
}

// The votes at the poses that their places do not tell from those voted for.
std::vector<PairPose> SimilarVotes(const LocalizationTask& task,
                                   const std::vector<PairPose>& votes) {
  std::vector<PairPose> similar;
  for (PairPose pair : EvenlySpaced(votes, kMaxNumAskedVotes)) {
    const Rigid2 T_reference_query = pair.T_reference_query;
    const auto add = [&](const Rigid2& pose) {
      pair.T_reference_query = pose;
      similar.push_back(pair);
    };
    for (const Rigid2& pose :
         task.map.places->at(pair.reference).surface.self_similar_poses) {
      add(pose * T_reference_query);
      add(pose.Inverse() * T_reference_query);
    }
    for (const Rigid2& pose :
         task.query.places->at(pair.query).surface.self_similar_poses) {
      add(T_reference_query * pose);
      add(T_reference_query * pose.Inverse());
    }
  }
  return similar;
}

MeasuredPlacement Measure(const LocalizationTask& task,
                          std::vector<PairPose> votes,
                          const size_t max_num_pairs,
                          const Executor& executor) {
  MeasuredPlacement measured;
  measured.confirmation =
      MeasurePlacement(task, std::move(votes), max_num_pairs, executor);
  std::vector<PairPose> agreeing;
  for (const Match& match : measured.confirmation.agreeing) {
    agreeing.push_back(match.pair);
  }
  std::vector<Placement> placements = FindPlacements(
      task.placement, task.consistency, task.layouts(), agreeing);
  if (!placements.empty()) measured.placement = std::move(placements.front());
  return measured;
}

// Whether it fits what both maps show, as a placement must.
bool IsPossible(const LocalizationTask& task,
                const Confirmation& confirmation) {
  return !confirmation.agreeing.empty() &&
         !IsCrossed(task.match.verification.crossing,
                    confirmation.crossing_walls.size(),
                    confirmation.num_compared) &&
         ContradictingFraction(confirmation.agreeing,
                               confirmation.contradicting) <=
             task.placement.max_contradicting_fraction;
}

// Whether it does as well as the other.
bool IsRival(const PlacementOptions& options, const MeasuredPlacement& rival,
             const MeasuredPlacement& other) {
  return rival.placement.score >= kRivalShare * other.placement.score &&
         other.placement.score - rival.placement.score < options.min_lead;
}

}  // namespace

Contest FindRivalPlacements(const LocalizationTask& task,
                            const std::vector<PairPose>& votes,
                            const size_t max_num_pairs,
                            const Executor& executor) {
  Contest contest;
  const std::vector<PairPose> similar = SimilarVotes(task, votes);
  const std::vector<Placement> proposed =
      FindPlacements(task.placement, task.consistency, task.layouts(), similar);
  for (size_t k = 0; k < std::min(proposed.size(), kMaxNumMeasuredRivals);
       ++k) {
    std::vector<PairPose> of_rival;
    for (const size_t vote : proposed[k].votes) {
      of_rival.push_back(similar[vote]);
    }
    MeasuredPlacement rival =
        Measure(task, std::move(of_rival), max_num_pairs, executor);
    if (IsPossible(task, rival.confirmation)) {
      contest.rivals.push_back(std::move(rival));
    }
  }
  if (contest.rivals.empty()) return contest;
  contest.placement = Measure(task, EvenlySpaced(votes, kMaxNumMeasuredVotes),
                              max_num_pairs, executor);
  contest.rivals.erase(
      std::remove_if(contest.rivals.begin(), contest.rivals.end(),
                     [&](const MeasuredPlacement& rival) {
                       return !IsRival(task.placement, rival,
                                       contest.placement);
                     }),
      contest.rivals.end());
  std::stable_sort(contest.rivals.begin(), contest.rivals.end(),
                   [](const MeasuredPlacement& a, const MeasuredPlacement& b) {
                     return a.placement.score > b.placement.score;
                   });
  return contest;
}

}  // namespace cartographer_sdf
