// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/verification.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Poses nearer than this, at the middle of the overlap, are one answer.
constexpr double kSameDistance = 0.3;
constexpr double kSameRotation = 0.1;
// Poses farther apart than this are rivals.
constexpr double kDistinctDistance = 1.;
constexpr double kDistinctRotation = 0.35;

// More would only cost time: the best ones make the closest rivals.
constexpr size_t kMaxNumSelfSimilarPoses = 3;

// Standard deviation of a wall point's distance, by the grid and by local SLAM
// [m].
constexpr double kResidualSigma = 0.05;

// Each survivor is also tried turned by these before refinement: a hypothesis
// from keypoints is off by some degrees, beyond the reach of Gauss-Newton at
// the far ends of a submap [rad].
constexpr double kPolishRotations[] = {-0.035, 0.035, -0.07, 0.07};

double RankingScore(const RankingOptions& options,
                    const SurfaceModel& reference, const SurfaceModel& query,
                    const Rigid2& T_reference_query, const int num_points) {
  const AgreementOptions tolerance{options.hit_distance_meters,
                                   options.contradiction_distance_meters};
  const DirectedAgreement forward = MeasureAgreement(
      tolerance, reference, query, T_reference_query, num_points);
  const DirectedAgreement backward = MeasureAgreement(
      tolerance, query, reference, T_reference_query.Inverse(), num_points);
  // Points that the other has not seen neither speak for nor against the pose,
  // but a pose at which little is seen by both says little: a few more points
  // in the denominator.
  const double num_seen = forward.num_points + backward.num_points;
  const double regularized = num_seen + 0.1 * num_points;
  return (forward.hits + backward.hits -
          options.contradiction_weight *
              (forward.contradictions + backward.contradictions)) /
         regularized;
}

struct Ranked {
  double score;
  Rigid2 T_reference_query;
};

// Best first; equal ones in an order that is theirs, whatever the order in
// which they came.
bool IsBetter(const Ranked& a, const Ranked& b) {
  const auto key = [](const Ranked& ranked) {
    const Rigid2& pose = ranked.T_reference_query;
    return std::make_tuple(-ranked.score, pose.rotation(),
                           pose.translation().x(), pose.translation().y());
  };
  return key(a) < key(b);
}

bool IsNear(const Rigid2& a, const Rigid2& b, const Eigen::Vector2d& at,
            const double distance, const double rotation) {
  return (a * at - b * at).norm() < distance &&
         std::abs(NormalizeAngle(a.rotation() - b.rotation())) < rotation;
}

// Best first; of those that are nearly the same pose, the best.
std::vector<Ranked> KeepBest(std::vector<Ranked> ranked, const size_t count,
                             const double min_score,
                             const Eigen::Vector2d& middle) {
  std::sort(ranked.begin(), ranked.end(), IsBetter);
  std::vector<Ranked> kept;
  for (const Ranked& candidate : ranked) {
    if (kept.size() >= count || candidate.score < min_score) break;
    const bool is_new =
        std::none_of(kept.begin(), kept.end(), [&](const Ranked& better) {
          return IsNear(candidate.T_reference_query, better.T_reference_query,
                        middle, kSameDistance, kSameRotation);
        });
    if (is_new) kept.push_back(candidate);
  }
  return kept;
}

Eigen::Vector2d Middle(const SurfaceModel& model) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : model.observed_points) sum += point;
  return sum / static_cast<double>(model.observed_points.size());
}

Rigid2 TurnAbout(const Rigid2& T_reference_query, const Eigen::Vector2d& at,
                 const double rotation) {
  const double turned = T_reference_query.rotation() + rotation;
  return Rigid2(T_reference_query * at - Eigen::Rotation2Dd(turned) * at,
                turned);
}

// Those whose score is worse than that of the first by more than the gap.
void DropWorse(const double gap, std::vector<Ranked>* const ranked) {
  while (!ranked->empty() &&
         ranked->back().score < ranked->front().score - gap) {
    ranked->pop_back();
  }
}

std::vector<Ranked> RankHypotheses(const RankingOptions& options,
                                   const SurfaceModel& reference,
                                   const SurfaceModel& query,
                                   const std::vector<Rigid2>& hypotheses,
                                   const Eigen::Vector2d& middle) {
  std::vector<Ranked> coarse;
  for (const Rigid2& T_reference_query : hypotheses) {
    coarse.push_back({RankingScore(options, reference, query, T_reference_query,
                                   options.num_coarse_points),
                      T_reference_query});
  }
  coarse = KeepBest(std::move(coarse), options.num_coarse_survivors,
                    options.min_coarse_score, middle);
  std::vector<Ranked> fine;
  const auto rank_fine = [&](const Rigid2& T_reference_query) {
    fine.push_back({RankingScore(options, reference, query, T_reference_query,
                                 options.num_fine_points),
                    T_reference_query});
  };
  for (const Ranked& survivor : coarse) rank_fine(survivor.T_reference_query);
  fine = KeepBest(std::move(fine), options.num_refined,
                  options.min_coarse_score, middle);
  // Polishing gains less than this.
  DropWorse(2. * options.max_fine_score_gap, &fine);
  const std::vector<Ranked> unpolished = fine;
  for (const Ranked& survivor : unpolished) {
    for (const double rotation : kPolishRotations) {
      rank_fine(TurnAbout(survivor.T_reference_query, middle, rotation));
    }
  }
  fine = KeepBest(std::move(fine), options.num_refined, options.min_fine_score,
                  middle);
  DropWorse(options.max_fine_score_gap, &fine);
  return fine;
}

Verdict Judge(const VerificationOptions& options,
              const Verification& verification) {
  const Agreement& agreement = verification.agreement;
  if (agreement.overlap_area < options.min_overlap_area) {
    return Verdict::kTooLittleOverlap;
  }
  if (std::max(agreement.query_in_reference.ContradictionRatio(),
               agreement.reference_in_query.ContradictionRatio()) >
      options.max_contradiction_ratio) {
    return Verdict::kContradicted;
  }
  if (agreement.min_scatter_eigenvalue < options.min_scatter_eigenvalue) {
    return Verdict::kDegenerate;
  }
  if (verification.margin < options.min_margin) return Verdict::kAmbiguous;
  if (verification.score < options.min_score) return Verdict::kUnlikely;
  return Verdict::kAccepted;
}

// A refined pose and how well it agrees, not yet judged.
struct Candidate {
  Registration registration;
  Agreement agreement;
};

std::optional<Candidate> Refine(const VerificationOptions& options,
                                const SurfaceModel& reference,
                                const SurfaceModel& query,
                                const Rigid2& guess_T_reference_query) {
  std::optional<Registration> registration = RegisterSubmaps(
      options.registration, reference, query, guess_T_reference_query);
  if (!registration) return std::nullopt;
  const Rigid2& T_reference_query = registration->T_reference_query;
  Agreement agreement;
  agreement.query_in_reference =
      MeasureAgreement(options.agreement, reference, query, T_reference_query,
                       options.num_agreement_points);
  agreement.reference_in_query = MeasureAgreement(
      options.agreement, query, reference, T_reference_query.Inverse(),
      options.num_agreement_points);
  agreement.overlap_area = OverlapArea(reference, query, T_reference_query);
  const double smaller_area =
      std::min(static_cast<double>(reference.observed_points.size()) *
                   reference.area_per_observed_point,
               static_cast<double>(query.observed_points.size()) *
                   query.area_per_observed_point);
  agreement.overlap = std::min(1., agreement.overlap_area / smaller_area);
  agreement.min_scatter_eigenvalue = registration->min_scatter_eigenvalue;
  return Candidate{*std::move(registration), agreement};
}

bool IsDistinct(const Rigid2& a, const Rigid2& b,
                const Eigen::Vector2d& middle) {
  return !IsNear(a, b, middle, kDistinctDistance, kDistinctRotation);
}

std::vector<Candidate> RefineBest(const VerificationOptions& options,
                                  const SurfaceModel& reference,
                                  const SurfaceModel& query,
                                  const std::vector<Rigid2>& hypotheses,
                                  const Eigen::Vector2d& middle) {
  std::vector<Candidate> candidates;
  for (const Ranked& ranked :
       RankHypotheses(options.ranking, reference, query, hypotheses, middle)) {
    std::optional<Candidate> candidate =
        Refine(options, reference, query, ranked.T_reference_query);
    if (candidate) candidates.push_back(*std::move(candidate));
  }
  // Stable: of equal ones the first.
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) {
                     return a.agreement.Quality() > b.agreement.Quality();
                   });
  return candidates;
}

// Where else the query may lie, if one of the submaps resembles itself.
std::vector<Candidate> SelfSimilarRivals(const VerificationOptions& options,
                                         const SurfaceModel& reference,
                                         const SurfaceModel& query,
                                         const Rigid2& T_reference_query) {
  std::vector<Rigid2> guesses;
  for (const Rigid2& similar : reference.self_similar_poses) {
    guesses.push_back(similar * T_reference_query);
    guesses.push_back(similar.Inverse() * T_reference_query);
  }
  for (const Rigid2& similar : query.self_similar_poses) {
    guesses.push_back(T_reference_query * similar);
    guesses.push_back(T_reference_query * similar.Inverse());
  }
  std::vector<Candidate> rivals;
  for (const Rigid2& guess : guesses) {
    std::optional<Candidate> rival = Refine(options, reference, query, guess);
    if (rival) rivals.push_back(*std::move(rival));
  }
  return rivals;
}

double MarginOf(const std::vector<Candidate>& candidates, const Candidate& best,
                const Eigen::Vector2d& middle) {
  double margin = kMaxMargin;
  for (const Candidate& rival : candidates) {
    if (IsDistinct(rival.registration.T_reference_query,
                   best.registration.T_reference_query, middle)) {
      margin = std::min(margin,
                        best.agreement.Quality() - rival.agreement.Quality());
    }
  }
  return std::max(margin, 0.);
}

}  // namespace

const char* VerdictName(const Verdict verdict) {
  switch (verdict) {
    case Verdict::kAccepted:
      return "accepted";
    case Verdict::kTooLittleOverlap:
      return "too_little_overlap";
    case Verdict::kContradicted:
      return "contradicted";
    case Verdict::kUnlikely:
      return "unlikely";
    case Verdict::kDegenerate:
      return "degenerate";
    case Verdict::kAmbiguous:
      return "ambiguous";
  }
  LOG(FATAL) << "not a verdict: " << static_cast<int>(verdict);
}

std::string Validate(const RankingOptions& options) {
  if (options.num_coarse_points < 1 || options.num_fine_points < 1 ||
      options.num_coarse_survivors < 1 || options.num_refined < 1) {
    return "num_coarse_points, num_fine_points, num_coarse_survivors and "
           "num_refined must be positive";
  }
  if (!(options.hit_distance_meters > 0. &&
        options.contradiction_distance_meters >= options.hit_distance_meters)) {
    return "hit_distance_meters must be positive and not above "
           "contradiction_distance_meters";
  }
  if (!(options.contradiction_weight >= 0. &&
        options.max_fine_score_gap >= 0.)) {
    return "contradiction_weight and max_fine_score_gap must not be negative";
  }
  return "";
}

std::string Validate(const ScoreWeights& weights) {
  for (const double weight :
       {weights.mean_hit_ratio, weights.mean_contradiction_ratio,
        weights.max_contradiction_ratio, weights.log_overlap_area,
        weights.log_overlap, weights.sqrt_scatter_eigenvalue, weights.margin,
        weights.bias}) {
    if (!std::isfinite(weight))
      return "mean_hit_ratio and others must be finite";
  }
  return "";
}

std::string Validate(const VerificationOptions& options) {
  for (const std::string& error :
       {Validate(options.ranking), Validate(options.registration),
        Validate(options.agreement), Validate(options.score_weights)}) {
    if (!error.empty()) return error;
  }
  if (options.num_agreement_points < 1) {
    return "num_agreement_points must be positive";
  }
  if (!(options.min_overlap_area >= 0. &&
        options.max_contradiction_ratio >= 0. &&
        options.min_scatter_eigenvalue >= 0. && options.min_margin >= 0.)) {
    return "min_overlap_area, max_contradiction_ratio, min_scatter_eigenvalue "
           "and min_margin must not be negative";
  }
  return "";
}

double Agreement::Quality() const {
  constexpr double kPerLogArea = 0.07;
  return 0.5 * (query_in_reference.HitRatio() + reference_in_query.HitRatio()) -
         query_in_reference.ContradictionRatio() -
         reference_in_query.ContradictionRatio() +
         kPerLogArea * std::log(1. + overlap_area);
}

std::array<double, kNumScoreTerms> ScoreTerms(const Agreement& agreement,
                                              const double margin) {
  const DirectedAgreement& a = agreement.query_in_reference;
  const DirectedAgreement& b = agreement.reference_in_query;
  return {0.5 * (a.HitRatio() + b.HitRatio()),
          0.5 * (a.ContradictionRatio() + b.ContradictionRatio()),
          std::max(a.ContradictionRatio(), b.ContradictionRatio()),
          std::log(1. + agreement.overlap_area),
          std::log(0.05 + agreement.overlap),
          std::sqrt(std::max(agreement.min_scatter_eigenvalue, 0.)),
          margin};
}

double Score(const ScoreWeights& weights, const Agreement& agreement,
             const double margin) {
  const std::array<double, kNumScoreTerms> terms =
      ScoreTerms(agreement, margin);
  const std::array<double, kNumScoreTerms> factors = {
      weights.mean_hit_ratio,
      weights.mean_contradiction_ratio,
      weights.max_contradiction_ratio,
      weights.log_overlap_area,
      weights.log_overlap,
      weights.sqrt_scatter_eigenvalue,
      weights.margin};
  double score = weights.bias;
  for (int k = 0; k < kNumScoreTerms; ++k) score += factors[k] * terms[k];
  return score;
}

std::optional<Verification> VerifyHypotheses(
    const VerificationOptions& options, const SurfaceModel& reference,
    const SurfaceModel& query, const std::vector<Rigid2>& hypotheses) {
  CHECK_EQ(Validate(options), "");
  const Eigen::Vector2d middle = Middle(query);
  const std::vector<Candidate> candidates =
      RefineBest(options, reference, query, hypotheses, middle);
  if (candidates.empty()) return std::nullopt;
  const Candidate& best = candidates.front();
  Verification verification;
  verification.T_reference_query = best.registration.T_reference_query;
  verification.information =
      best.registration.normal_matrix / (kResidualSigma * kResidualSigma);
  verification.agreement = best.agreement;
  verification.margin = MarginOf(candidates, best, middle);
  verification.score =
      Score(options.score_weights, best.agreement, verification.margin);
  verification.verdict = Judge(options, verification);
  if (verification.verdict == Verdict::kAccepted) {
    // Only now, as few pairs get here.
    verification.margin =
        std::min(verification.margin,
                 MarginOf(SelfSimilarRivals(options, reference, query,
                                            verification.T_reference_query),
                          best, middle));
    verification.score =
        Score(options.score_weights, best.agreement, verification.margin);
    verification.verdict = Judge(options, verification);
  }
  return verification;
}

std::vector<Rigid2> FindSelfSimilarPoses(
    const VerificationOptions& options, const SurfaceModel& model,
    const std::vector<Rigid2>& hypotheses) {
  CHECK_EQ(Validate(options), "");
  const Eigen::Vector2d middle = Middle(model);
  std::vector<Rigid2> distinct, poses;
  for (const Rigid2& hypothesis : hypotheses) {
    if (IsDistinct(hypothesis, Rigid2(), middle))
      distinct.push_back(hypothesis);
  }
  for (const Candidate& candidate :
       RefineBest(options, model, model, distinct, middle)) {
    const Rigid2& pose = candidate.registration.T_reference_query;
    // Different hypotheses may have been refined to one pose.
    const bool is_new = std::all_of(poses.begin(), poses.end(),
                                    [&pose, &middle](const Rigid2& better) {
                                      return IsDistinct(pose, better, middle);
                                    });
    if (poses.size() < kMaxNumSelfSimilarPoses && is_new &&
        IsDistinct(pose, Rigid2(), middle)) {
      poses.push_back(pose);
    }
  }
  return poses;
}

}  // namespace cartographer_sdf
