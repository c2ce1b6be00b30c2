// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/confirmation.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "cartographer_sdf/geometry/evenly_spaced.h"
#include "cartographer_sdf/verification/crossing_wall.h"

namespace cartographer_sdf {
namespace {

// Largest standard deviation of a prediction [m]: an offset that registration
// recovers with ease for pairs that may agree, less than half of that for pairs
// that count against the placement.
constexpr double kMaxSigma = 0.7;
constexpr double kMaxContradictionSigma = 0.3;

// Whether a pose differs from a predicted one by no more than answers may.
bool IsNearPrediction(const LocalizationTask& task,
                      const Rigid2& T_reference_query,
                      const PairPose& predicted) {
  return AreNear(
      T_reference_query, predicted.T_reference_query,
      task.query.layout->centroids.at(predicted.query),
      {task.placement.same_distance_meters, task.placement.same_rotation});
}

// Returns the match if the walls, registered near the predicted pose, make it
// more likely right than not.
std::optional<Match> MeasureAt(const LocalizationTask& task,
                               const PairPose& predicted) {
  const VerificationOptions& options = task.match.verification;
  const std::optional<MeasuredPose> measured = RegisterAndMeasure(
      options, task.map.places->at(predicted.reference).surface,
      task.query.places->at(predicted.query).surface,
      predicted.T_reference_query);
  if (!measured ||
      !IsNearPrediction(task, measured->T_reference_query, predicted)) {
    return std::nullopt;
  }
  JudgementOptions likely = options.judgement;
  likely.min_score = 0.;
  Match match;
  match.pair = {predicted.reference, predicted.query,
                measured->T_reference_query,
                Score(likely.score_weights, measured->evidence, 0.)};
  match.pair_score = match.pair.score;
  match.evidence = measured->evidence;
  match.verdict =
      Judge(likely, match.evidence, match.pair.score, likely.min_margin);
  if (match.verdict != Verdict::kAccepted) return std::nullopt;
  return match;
}

// A pair of places that the placement makes overlap.
struct PairToCheck {
  const Place* reference;
  const Place* query;
  Rigid2 T_reference_query;  // predicted
  double way;                // from the nearest vote, through both maps [m]
  std::optional<Match> agreeing;
  std::optional<Match> contradicting;
};

class Confirmer {
 public:
  Confirmer(const LocalizationTask& task, std::vector<PairPose> votes,
            const bool tolerates_rivals)
      : task_(task),
        votes_(std::move(votes)),
        tolerates_rivals_(tolerates_rivals) {
    for (const PairPose& vote : votes_) done_.insert(IdsOf(vote));
  }

  // Verifies the pairs that the votes so far predict, nearest first; returns
  // false if none is left.
  bool Spread(const size_t max_num_pairs, const Executor& executor,
              Confirmation* const confirmation) {
    std::vector<PairToCheck> pairs = PredictPairs(kMaxSigma, done_);
    if (pairs.empty()) return false;
    pairs.erase(pairs.begin() + static_cast<std::ptrdiff_t>(
                                    std::min(pairs.size(), max_num_pairs)),
                pairs.end());
    executor(pairs.size(), [&](const size_t k) { Check(&pairs[k]); });
    for (PairToCheck& pair : pairs) {
      done_.insert({pair.reference->id, pair.query->id});
      if (pair.agreeing) {
        votes_.push_back(pair.agreeing->pair);
        confirmation->agreeing.push_back(*std::move(pair.agreeing));
      }
      if (pair.contradicting) {
        confirmation->contradicting.push_back(*std::move(pair.contradicting));
      }
    }
    num_checked_ += pairs.size();
    return true;
  }

  // Searches the votes and what they predict for crossing walls.
  void FindCrossingWalls(const Executor& executor,
                         Confirmation* const confirmation) const {
    std::vector<PairPose> pairs = votes_;
    std::set<Ids> voted;
    for (const PairPose& vote : votes_) voted.insert(IdsOf(vote));
    for (const PairToCheck& pair :
         PredictPairs(kMaxContradictionSigma, voted)) {
      pairs.push_back(
          {pair.reference->id, pair.query->id, pair.T_reference_query, 0.});
    }
    const std::vector<size_t> indices = EvenlySpacedIndices(
        pairs.size(), std::min(pairs.size(), kMaxNumCrossingPairs));
    std::vector<std::optional<double>> lengths(indices.size());
    executor(indices.size(), [&](const size_t k) {
      const PairPose& pair = pairs[indices[k]];
      lengths[k] = CrossingLength(pair, voted.count(IdsOf(pair)) > 0);
    });
    for (size_t k = 0; k < indices.size(); ++k) {
      if (!lengths[k]) continue;
      ++confirmation->num_compared;
      if (*lengths[k] <= task_.match.verification.crossing.max_wall_meters) {
        continue;
      }
      const PairPose& pair = pairs[indices[k]];
      confirmation->crossing_walls.push_back(
          {pair.reference, pair.query, *lengths[k]});
    }
  }

  [[nodiscard]] size_t num_checked() const { return num_checked_; }

 private:
  using Ids = std::pair<SubmapId, SubmapId>;

  [[nodiscard]] static Ids IdsOf(const PairPose& pair) {
    return {pair.reference, pair.query};
  }

  // Returns the length of the longest crossing wall at the pose of the vote, or
  // where a predicted pair registers; nullopt if that is not near.
  [[nodiscard]] std::optional<double> CrossingLength(const PairPose& pair,
                                                     const bool is_vote) const {
    const SurfaceModel& reference =
        task_.map.places->at(pair.reference).surface;
    const SurfaceModel& query = task_.query.places->at(pair.query).surface;
    Rigid2 T_reference_query = pair.T_reference_query;
    if (!is_vote) {
      const std::optional<Rigid2> registered =
          RegisterSubmaps(task_.match.verification.registration, reference,
                          query, T_reference_query);
      if (!registered || !IsNearPrediction(task_, *registered, pair)) {
        return std::nullopt;
      }
      T_reference_query = *registered;
    }
    return LongestCrossingWall(reference, query, T_reference_query);
  }

  // Returns the pairs that the votes make overlap, without those in `done`,
  // nearest first.
  [[nodiscard]] std::vector<PairToCheck> PredictPairs(
      const double max_sigma, const std::set<Ids>& done) const {
    std::vector<PairToCheck> pairs;
    for (const auto& [reference_id, reference] : *task_.map.places) {
      if (task_.map.layout->T_map_submap.count(reference_id) == 0) continue;
      for (const auto& [query_id, query] : *task_.query.places) {
        if (done.count({reference_id, query_id}) > 0) continue;
        std::optional<PairToCheck> pair = Predict(reference, query);
        if (pair && DriftSigma(task_.consistency, pair->way) <= max_sigma &&
            OverlapsEnough(reference.surface, query.surface,
                           pair->T_reference_query)) {
          pairs.push_back(*std::move(pair));
        }
      }
    }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const PairToCheck& a, const PairToCheck& b) {
                       return a.way < b.way;
                     });
    return pairs;
  }

  // Predicts the pose of the pair by the vote nearest to both.
  [[nodiscard]] std::optional<PairToCheck> Predict(const Place& reference,
                                                   const Place& query) const {
    const PairPose* nearest = nullptr;
    double shortest = std::numeric_limits<double>::infinity();
    for (const PairPose& vote : votes_) {
      const std::optional<double> in_map =
          task_.map.layout->distances.Between(vote.reference, reference.id);
      const std::optional<double> in_query =
          task_.query.layout->distances.Between(vote.query, query.id);
      if (!in_map || !in_query || *in_map + *in_query >= shortest) continue;
      shortest = *in_map + *in_query;
      nearest = &vote;
    }
    if (nearest == nullptr) return std::nullopt;
    return PairToCheck{
        &reference,
        &query,
        task_.map.layout->T_map_submap.at(reference.id).Inverse() *
            PlaceByVote(task_.layouts(), *nearest, query.id),
        shortest,
        {},
        {}};
  }

  void Check(PairToCheck* const pair) const {
    pair->agreeing =
        tolerates_rivals_
            ? MeasureAt(task_, {pair->reference->id, pair->query->id,
                                pair->T_reference_query, 0.})
            : VerifyPrediction(*pair);
    if (pair->agreeing ||
        DriftSigma(task_.consistency, pair->way) > kMaxContradictionSigma) {
      return;
    }
    pair->contradicting = FindContradiction(
        task_.match.verification, task_.placement.max_contradiction_ratio,
        *pair->reference, *pair->query, pair->T_reference_query);
  }

  // Returns the match if verification accepts it near the predicted pose.
  [[nodiscard]] std::optional<Match> VerifyPrediction(
      const PairToCheck& pair) const {
    std::optional<VerifiedPose> verified =
        VerifyHypotheses(task_.match.verification, pair.reference->surface,
                         pair.query->surface, {pair.T_reference_query});
    if (!verified || verified->verdict != Verdict::kAccepted ||
        !IsNearPrediction(
            task_, verified->T_reference_query,
            {pair.reference->id, pair.query->id, pair.T_reference_query, 0.})) {
      return std::nullopt;
    }
    return MakeMatch(task_.match, *pair.reference, *pair.query,
                     *std::move(verified));
  }

  const LocalizationTask& task_;
  std::vector<PairPose> votes_;
  const bool tolerates_rivals_;
  std::set<Ids> done_;
  size_t num_checked_ = 0;
};

Confirmation Confirm(Confirmer confirmer, const size_t max_num_pairs,
                     const Executor& executor) {
  Confirmation confirmation;
  while (confirmer.num_checked() < max_num_pairs &&
         confirmer.Spread(max_num_pairs - confirmer.num_checked(), executor,
                          &confirmation)) {
  }
  confirmer.FindCrossingWalls(executor, &confirmation);
  return confirmation;
}

}  // namespace

std::optional<Match> FindContradiction(const VerificationOptions& options,
                                       const double max_contradiction_ratio,
                                       const Place& reference,
                                       const Place& query,
                                       const Rigid2& T_reference_query) {
  std::optional<MeasuredPose> measured = RegisterAndMeasure(
      options, reference.surface, query.surface, T_reference_query);
  if (!measured) {
    measured = MeasuredPose{
        T_reference_query,
        MeasurePair(options.agreement, options.registration, reference.surface,
                    query.surface, T_reference_query)};
  }
  if (measured->evidence.MeanContradictionRatio() <= max_contradiction_ratio) {
    return std::nullopt;
  }
  Match match;
  match.pair = {reference.id, query.id, measured->T_reference_query,
                Score(options.judgement.score_weights, measured->evidence, 0.)};
  match.pair_score = match.pair.score;
  match.verdict = Verdict::kContradicted;
  match.evidence = measured->evidence;
  return match;
}

double ContradictingFraction(const std::vector<Match>& agreeing,
                             const std::vector<Match>& contradicting) {
  std::set<SubmapId> agreeing_places, contradicting_places;
  for (const Match& match : agreeing) agreeing_places.insert(match.pair.query);
  for (const Match& match : contradicting) {
    if (agreeing_places.count(match.pair.query) == 0) {
      contradicting_places.insert(match.pair.query);
    }
  }
  const size_t num_places =
      agreeing_places.size() + contradicting_places.size();
  if (num_places == 0) return 0.;
  return static_cast<double>(contradicting_places.size()) /
         static_cast<double>(num_places);
}

Confirmation ConfirmPlacement(const LocalizationTask& task,
                              std::vector<PairPose> votes,
                              const size_t max_num_pairs,
                              const Executor& executor) {
  return Confirm(Confirmer(task, std::move(votes), false), max_num_pairs,
                 executor);
}

Confirmation MeasurePlacement(const LocalizationTask& task,
                              std::vector<PairPose> votes,
                              const size_t max_num_pairs,
                              const Executor& executor) {
  std::vector<std::optional<Match>> measured(votes.size());
  executor(votes.size(),
           [&](const size_t k) { measured[k] = MeasureAt(task, votes[k]); });
  std::vector<PairPose> agreeing;
  std::vector<Match> matches;
  for (std::optional<Match>& match : measured) {
    if (!match) continue;
    agreeing.push_back(match->pair);
    matches.push_back(*std::move(match));
  }
  Confirmation confirmation = Confirm(
      Confirmer(task, std::move(agreeing), true), max_num_pairs, executor);
  confirmation.agreeing.insert(confirmation.agreeing.begin(), matches.begin(),
                               matches.end());
  return confirmation;
}

}  // namespace cartographer_sdf
