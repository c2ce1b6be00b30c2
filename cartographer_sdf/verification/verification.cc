// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/verification.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Poses farther apart than this are rivals.
constexpr double kDistinctDistance = 1.;
constexpr double kDistinctRotation = 0.35;

// More would only cost time: the best ones make the closest rivals.
constexpr size_t kMaxNumSelfSimilarPoses = 3;

// A rival whose score is lower by more than this is not worth mentioning.
constexpr double kCloseRivalGap = 2.;

// Along a corridor the pose may as well be off by these [m].
constexpr double kSlides[] = {-3., -1.5, 1.5, 3.};

// Standard deviation of a wall point's distance, by the grid and by local SLAM
// [m].
constexpr double kResidualSigma = 0.05;

// A term of the score: its name and its weight's field.
struct ScoreTerm {
  const char* name;
  double ScoreWeights::*weight;
};
constexpr std::array<ScoreTerm, kNumScoreTerms> kScoreTerms = {
    {{"contradiction_ratio", &ScoreWeights::contradiction_ratio},
     {"log_overlap", &ScoreWeights::log_overlap},
     {"wall_evidence", &ScoreWeights::wall_evidence},
     {"sqrt_scatter_eigenvalue", &ScoreWeights::sqrt_scatter_eigenvalue},
     {"margin", &ScoreWeights::margin}}};

Eigen::Vector2d Middle(const SurfaceModel& model) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : model.observed_points) sum += point;
  return sum / static_cast<double>(model.observed_points.size());
}

// A refined pose and how well it agrees, not yet judged.
struct Candidate {
  Registration registration;
  Agreement agreement;
  double score;  // without the margin
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
  agreement.tiles =
      MeasureTileAgreement(options.agreement, reference, query,
                           T_reference_query, options.num_agreement_points);
  agreement.overlap_area = OverlapArea(reference, query, T_reference_query);
  const double smaller_area =
      std::min(static_cast<double>(reference.observed_points.size()) *
                   reference.area_per_observed_point,
               static_cast<double>(query.observed_points.size()) *
                   query.area_per_observed_point);
  agreement.overlap = std::min(1., agreement.overlap_area / smaller_area);
  agreement.min_scatter_eigenvalue = registration->min_scatter_eigenvalue;
  return Candidate{*std::move(registration), agreement,
                   Score(options.score_weights, agreement, 0.)};
}

// Stable: of equal ones the first.
void SortByScore(std::vector<Candidate>* const candidates) {
  std::stable_sort(
      candidates->begin(), candidates->end(),
      [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
}

bool IsDistinct(const Rigid2& a, const Rigid2& b,
                const Eigen::Vector2d& middle) {
  return !AreNear(a, b, middle, kDistinctDistance, kDistinctRotation);
}

std::vector<Candidate> RefineBest(const VerificationOptions& options,
                                  const SurfaceModel& reference,
                                  const SurfaceModel& query,
                                  const std::vector<Rigid2>& hypotheses,
                                  const Eigen::Vector2d& middle) {
  std::vector<Candidate> candidates;
  for (const Rigid2& T_reference_query :
       RankHypotheses(options.ranking, reference, query, hypotheses, middle)) {
    std::optional<Candidate> candidate =
        Refine(options, reference, query, T_reference_query);
    if (candidate) candidates.push_back(*std::move(candidate));
  }
  SortByScore(&candidates);
  return candidates;
}

Eigen::Vector2d MiddleOfOverlap(const SurfaceModel& reference,
                                const SurfaceModel& query,
                                const Rigid2& T_reference_query) {
  const Rigid2 T_grid_query =
      reference.geometry.T_submap_grid.Inverse() * T_reference_query;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (const Eigen::Vector2d& point : query.observed_points) {
    const Eigen::Array2d cell =
        (T_grid_query * point).array() / reference.geometry.resolution;
    if ((cell < 0.).any() ||
        (cell >= reference.geometry.size.cast<double>()).any() ||
        !reference
             .cells(static_cast<Eigen::Index>(cell.x()),
                    static_cast<Eigen::Index>(cell.y()))
             .observed) {
      continue;
    }
    sum += point;
    ++count;
  }
  return count > 0 ? Eigen::Vector2d(sum / count) : Middle(query);
}

// Where else the query may lie: turned by half a turn, shifted along the walls,
// or where one of the submaps resembles itself.
std::vector<Candidate> Rivals(const VerificationOptions& options,
                              const SurfaceModel& reference,
                              const SurfaceModel& query,
                              const Registration& best) {
  const Rigid2& T_reference_query = best.T_reference_query;
  const Eigen::Vector2d middle =
      MiddleOfOverlap(reference, query, T_reference_query);
  std::vector<Rigid2> guesses = {T_reference_query * Rigid2(2. * middle, M_PI)};
  // The direction in which the walls hold the pose least.
  const Eigen::Vector2d along = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(
                                    best.normal_matrix.topLeftCorner<2, 2>())
                                    .eigenvectors()
                                    .col(0);
  for (const double slide : kSlides) {
    guesses.emplace_back(T_reference_query.translation() + slide * along,
                         T_reference_query.rotation());
  }
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

// Those that are not the same pose as `candidate`.
std::vector<Candidate> DistinctFrom(const Candidate& candidate,
                                    const std::vector<Candidate>& others,
                                    const Eigen::Vector2d& middle) {
  std::vector<Candidate> distinct;
  for (const Candidate& other : others) {
    if (IsDistinct(other.registration.T_reference_query,
                   candidate.registration.T_reference_query, middle)) {
      distinct.push_back(other);
    }
  }
  return distinct;
}

// The candidate against the others, which may be the same pose, and, where it
// is more likely right than wrong, against what nobody proposed.
Verification Verify(const VerificationOptions& options,
                    const SurfaceModel& reference, const SurfaceModel& query,
                    const Candidate& candidate,
                    const std::vector<Candidate>& others,
                    const Eigen::Vector2d& middle) {
  std::vector<Candidate> rivals = DistinctFrom(candidate, others, middle);
  const auto margin = [&rivals, &candidate] {
    double margin = kMaxMargin;
    for (const Candidate& rival : rivals) {
      margin = std::min(margin, candidate.score - rival.score);
    }
    return std::max(margin, -kMaxMargin);
  };
  const auto score = [&options, &candidate, &margin] {
    return Score(options.score_weights, candidate.agreement, margin());
  };
  // Only then, as few pairs get here.
  if (score() > 0. || options.min_score <= 0.) {
    for (Candidate& rival :
         DistinctFrom(candidate,
                      Rivals(options, reference, query, candidate.registration),
                      middle)) {
      rivals.push_back(std::move(rival));
    }
  }
  Verification verification;
  verification.T_reference_query = candidate.registration.T_reference_query;
  verification.information =
      candidate.registration.normal_matrix / (kResidualSigma * kResidualSigma);
  verification.agreement = candidate.agreement;
  verification.margin = margin();
  verification.score = score();
  verification.verdict = Judge(options, verification.agreement,
                               verification.score, verification.margin);
  SortByScore(&rivals);
  for (const Candidate& rival : rivals) {
    if (verification.rivals.size() >= kMaxNumRivals ||
        rival.score < candidate.score - kCloseRivalGap) {
      break;
    }
    const Rigid2& pose = rival.registration.T_reference_query;
    const bool is_new = std::all_of(
        verification.rivals.begin(), verification.rivals.end(),
        [&](const Rigid2& other) { return IsDistinct(pose, other, middle); });
    if (is_new) verification.rivals.push_back(pose);
  }
  return verification;
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

std::string Validate(const ScoreWeights& weights) {
  for (const ScoreTerm& term : kScoreTerms) {
    if (!std::isfinite(weights.*term.weight)) {
      return std::string(term.name) + " must be finite";
    }
  }
  if (!std::isfinite(weights.bias)) return "bias must be finite";
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

Verdict Judge(const VerificationOptions& options, const Agreement& agreement,
              const double score, const double margin) {
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
  if (margin < options.min_margin) return Verdict::kAmbiguous;
  if (score < options.min_score) return Verdict::kUnlikely;
  return Verdict::kAccepted;
}

double Agreement::WallEvidence() const {
  // Chance finds poses under which about three of four walls agree.
  constexpr double kHitRatioByChance = 0.75;
  constexpr double kExponent = 0.75;
  return std::pow(tiles.num_tiles, kExponent) *
         (tiles.mean_hit_ratio - kHitRatioByChance);
}

std::array<const char*, kNumScoreTerms> ScoreTermNames() {
  std::array<const char*, kNumScoreTerms> names = {};
  for (int k = 0; k < kNumScoreTerms; ++k) names[k] = kScoreTerms[k].name;
  return names;
}

std::array<double, kNumScoreTerms> ScoreTerms(const Agreement& agreement,
                                              const double margin) {
  return {0.5 * (agreement.query_in_reference.ContradictionRatio() +
                 agreement.reference_in_query.ContradictionRatio()),
          std::log(0.05 + agreement.overlap), agreement.WallEvidence(),
          std::sqrt(std::max(agreement.min_scatter_eigenvalue, 0.)), margin};
}

double Score(const ScoreWeights& weights, const Agreement& agreement,
             const double margin) {
  const std::array<double, kNumScoreTerms> terms =
      ScoreTerms(agreement, margin);
  double score = weights.bias;
  for (int k = 0; k < kNumScoreTerms; ++k) {
    score += weights.*kScoreTerms[k].weight * terms[k];
  }
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
  return Verify(options, reference, query, candidates.front(), candidates,
                middle);
}

std::vector<Verification> VerifyPoses(const VerificationOptions& options,
                                      const SurfaceModel& reference,
                                      const SurfaceModel& query,
                                      const std::vector<Rigid2>& poses) {
  CHECK_EQ(Validate(options), "");
  const Eigen::Vector2d middle = Middle(query);
  std::vector<Candidate> candidates;
  for (const Rigid2& T_reference_query : poses) {
    std::optional<Candidate> candidate =
        Refine(options, reference, query, T_reference_query);
    if (candidate) candidates.push_back(*std::move(candidate));
  }
  SortByScore(&candidates);
  std::vector<Verification> verifications;
  for (const Candidate& candidate : candidates) {
    const bool is_new = std::all_of(
        verifications.begin(), verifications.end(),
        [&](const Verification& better) {
          return IsDistinct(candidate.registration.T_reference_query,
                            better.T_reference_query, middle);
        });
    if (!is_new) continue;
    verifications.push_back(
        Verify(options, reference, query, candidate, candidates, middle));
  }
  std::stable_sort(verifications.begin(), verifications.end(),
                   [](const Verification& a, const Verification& b) {
                     return a.score > b.score;
                   });
  return verifications;
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
