// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/verification.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// More would only take time: the best are the closest rivals.
constexpr size_t kMaxNumSelfSimilarPoses = 3;

// A rival whose score is lower by more than this is not reported.
constexpr double kCloseRivalGap = 2.;

// Possible pose errors along a corridor [m].
constexpr double kSlides[] = {-3., -1.5, 1.5, 3.};

// Coarsely registered poses nearer than this settle at the same pose.
constexpr PoseTolerance kSameBasin{0.1, 0.02};

struct Candidate {
  MeasuredPose pose;
  double score;  // without the margin
};

const Rigid2& PoseOf(const Candidate& candidate) {
  return candidate.pose.T_reference_query;
}

// With the numbers of points of the screening.
VerificationOptions OnFewPoints(VerificationOptions options) {
  const int num_points = options.screening.num_points;
  options.agreement.max_num_points =
      std::min(options.agreement.max_num_points, num_points);
  options.registration.max_num_points = std::min(
      options.registration.max_num_points, std::max(10, num_points / 3));
  return options;
}

// Verifies poses of one pair of submaps.
class PairVerifier {
 public:
  PairVerifier(const VerificationOptions& options,
               const SurfaceModel& reference, const SurfaceModel& query)
      : options_(options),
        reference_(reference),
        query_(query),
        centroid_(ObservedCentroid(query)),
        few_points_(OnFewPoints(options)) {
    CHECK_EQ(Validate(options), "");
  }

  [[nodiscard]] const Eigen::Vector2d& centroid() const { return centroid_; }

  static void SortByScore(std::vector<Candidate>* const candidates) {
    std::stable_sort(candidates->begin(), candidates->end(),
                     [](const Candidate& a, const Candidate& b) {
                       return a.score > b.score;
                     });
  }

  // Returns registered poses, best first, ties in the order given.
  [[nodiscard]] std::vector<Candidate> Refine(
      const std::vector<Rigid2>& guesses) const {
    std::vector<Candidate> candidates;
    for (const Rigid2& guess : guesses) {
      std::optional<Candidate> candidate = MakeCandidate(
          RegisterAndMeasure(options_, reference_, query_, guess));
      if (candidate) candidates.push_back(*std::move(candidate));
    }
    SortByScore(&candidates);
    return candidates;
  }

  // Does the same, without the guesses whose screening shows that they are
  // nowhere near the best of them or `score_to_beat`.
  [[nodiscard]] std::vector<Candidate> RefinePromising(
      const std::vector<Rigid2>& guesses, const double score_to_beat) const {
    const ScreeningOptions& screening = options_.screening;
    std::vector<Candidate> candidates;
    double best_score = score_to_beat;
    for (const Candidate& screened : Screen(guesses)) {
      if (screened.score < best_score - screening.max_score_gap) break;
      if (!candidates.empty() && screened.score < screening.min_score) break;
      std::optional<Candidate> candidate = Settle(PoseOf(screened));
      if (!candidate) continue;
      best_score = std::max(best_score, candidate->score);
      candidates.push_back(*std::move(candidate));
    }
    SortByScore(&candidates);
    return candidates;
  }

  [[nodiscard]] std::vector<Candidate> RefineBest(
      const std::vector<Rigid2>& hypotheses) const {
    return RefinePromising(RankHypotheses(options_.ranking, reference_, query_,
                                          hypotheses, centroid_),
                           -std::numeric_limits<double>::infinity());
  }

  // Judges the candidate against the others, which may be the same pose. Also
  // tries poses that no one proposed: always, or only if the candidate is more
  // likely correct than not.
  enum class RivalSearch { kWhereLikely, kAlways };
  [[nodiscard]] VerifiedPose Verify(const Candidate& candidate,
                                    const std::vector<Candidate>& others,
                                    const RivalSearch search) const {
    std::vector<Candidate> rivals = DistinctFrom(candidate, others);
    if (search == RivalSearch::kAlways || ScoreAmong(candidate, rivals) > 0.) {
      for (Candidate& rival : DistinctFrom(
               candidate, RefinePromising(UnproposedPoses(candidate.pose),
                                          candidate.score))) {
        rivals.push_back(std::move(rival));
      }
    }
    VerifiedPose verified;
    verified.T_reference_query = PoseOf(candidate);
    verified.evidence = candidate.pose.evidence;
    verified.margin = Margin(candidate, rivals);
    verified.score = ScoreAmong(candidate, rivals);
    verified.verdict = Judge(options_.judgement, verified.evidence,
                             verified.score, verified.margin);
    verified.rivals = CloseRivals(candidate, std::move(rivals));
    return verified;
  }

 private:
  [[nodiscard]] double ScoreWithoutMargin(const PairEvidence& evidence) const {
    return Score(options_.judgement.score_weights, evidence, 0.);
  }

  [[nodiscard]] std::optional<Candidate> MakeCandidate(
      std::optional<MeasuredPose> pose) const {
    if (!pose) return std::nullopt;
    const double score = ScoreWithoutMargin(pose->evidence);
    return Candidate{*std::move(pose), score};
  }

  // Registers coarsely and measures on few points; best first, and of poses
  // that would settle at the same one only the best.
  [[nodiscard]] std::vector<Candidate> Screen(
      const std::vector<Rigid2>& guesses) const {
    std::vector<Candidate> screened;
    for (const Rigid2& guess : guesses) {
      const std::optional<Rigid2> coarse =
          RegisterCoarsely(options_.registration, reference_, query_, guess);
      if (!coarse) continue;
      screened.push_back(*MakeCandidate(MeasuredPose{
          *coarse, MeasurePair(few_points_.agreement, few_points_.registration,
                               reference_, query_, *coarse)}));
    }
    SortByScore(&screened);
    return KeepDistinct(screened, PoseOf, centroid_, kSameBasin,
                        screened.size());
  }

  // Completes the registration of a screened pose, and measures on all points.
  [[nodiscard]] std::optional<Candidate> Settle(const Rigid2& coarse) const {
    const std::optional<Rigid2> registered =
        RegisterFinely(options_.registration, reference_, query_, coarse);
    if (!registered) return std::nullopt;
    return MakeCandidate(MeasuredPose{
        *registered, MeasurePair(options_.agreement, options_.registration,
                                 reference_, query_, *registered)});
  }

  [[nodiscard]] static double Margin(const Candidate& candidate,
                                     const std::vector<Candidate>& rivals) {
    double margin = kMaxMargin;
    for (const Candidate& rival : rivals) {
      margin = std::min(margin, candidate.score - rival.score);
    }
    return std::max(margin, -kMaxMargin);
  }

  [[nodiscard]] double ScoreAmong(const Candidate& candidate,
                                  const std::vector<Candidate>& rivals) const {
    return Score(options_.judgement.score_weights, candidate.pose.evidence,
                 Margin(candidate, rivals));
  }

  [[nodiscard]] std::vector<Candidate> DistinctFrom(
      const Candidate& candidate, const std::vector<Candidate>& others) const {
    std::vector<Candidate> distinct;
    for (const Candidate& other : others) {
      if (!AreNear(PoseOf(other), PoseOf(candidate), centroid_,
                   kRivalTolerance)) {
        distinct.push_back(other);
      }
    }
    return distinct;
  }

  // Returns other possible poses of the query: turned by half a turn, shifted
  // along the walls, or moved by a self-similarity of either submap.
  [[nodiscard]] std::vector<Rigid2> UnproposedPoses(
      const MeasuredPose& best) const {
    const Rigid2& T_reference_query = best.T_reference_query;
    const Eigen::Vector2d middle =
        OverlapCentroid(reference_, query_, T_reference_query)
            .value_or(centroid_);
    std::vector<Rigid2> poses = {T_reference_query * Rigid2(2. * middle, M_PI)};
    const Eigen::Vector2d along = best.evidence.LeastConstrainedDirection();
    for (const double slide : kSlides) {
      poses.emplace_back(T_reference_query.translation() + slide * along,
                         T_reference_query.rotation());
    }
    for (const Rigid2& similar : reference_.self_similar_poses) {
      poses.push_back(similar * T_reference_query);
      poses.push_back(similar.Inverse() * T_reference_query);
    }
    for (const Rigid2& similar : query_.self_similar_poses) {
      poses.push_back(T_reference_query * similar);
      poses.push_back(T_reference_query * similar.Inverse());
    }
    return poses;
  }

  [[nodiscard]] std::vector<Rigid2> CloseRivals(
      const Candidate& candidate, std::vector<Candidate> rivals) const {
    SortByScore(&rivals);
    std::vector<Rigid2> close;
    for (const Candidate& rival : rivals) {
      if (rival.score < candidate.score - kCloseRivalGap) break;
      close.push_back(PoseOf(rival));
    }
    return KeepDistinct(
        close, [](const Rigid2& pose) { return pose; }, centroid_,
        kRivalTolerance, kMaxNumRivals);
  }

  const VerificationOptions& options_;
  const SurfaceModel& reference_;
  const SurfaceModel& query_;
  const Eigen::Vector2d centroid_;
  const VerificationOptions few_points_;
};

}  // namespace

std::string Validate(const ScreeningOptions& options) {
  if (options.num_points < 10) return "num_points must be at least 10";
  if (!std::isfinite(options.min_score)) return "min_score must be finite";
  if (!(options.max_score_gap >= 0.)) {
    return "max_score_gap must not be negative";
  }
  return "";
}

std::string Validate(const VerificationOptions& options) {
  for (const std::string& error :
       {Validate(options.ranking), Validate(options.screening),
        Validate(options.registration), Validate(options.agreement),
        Validate(options.judgement), Validate(options.crossing)}) {
    if (!error.empty()) return error;
  }
  return "";
}

std::optional<MeasuredPose> RegisterAndMeasure(
    const VerificationOptions& options, const SurfaceModel& reference,
    const SurfaceModel& query, const Rigid2& guess_T_reference_query) {
  const std::optional<Rigid2> registered = RegisterSubmaps(
      options.registration, reference, query, guess_T_reference_query);
  if (!registered) return std::nullopt;
  return MeasuredPose{*registered,
                      MeasurePair(options.agreement, options.registration,
                                  reference, query, *registered)};
}

std::optional<VerifiedPose> VerifyHypotheses(
    const VerificationOptions& options, const SurfaceModel& reference,
    const SurfaceModel& query, const std::vector<Rigid2>& hypotheses) {
  const PairVerifier verifier(options, reference, query);
  const std::vector<Candidate> candidates = verifier.RefineBest(hypotheses);
  if (candidates.empty()) return std::nullopt;
  return verifier.Verify(candidates.front(), candidates,
                         PairVerifier::RivalSearch::kWhereLikely);
}

std::vector<VerifiedPose> VerifyPoses(
    const VerificationOptions& options, const SurfaceModel& reference,
    const SurfaceModel& query, const std::vector<Rigid2>& T_reference_query,
    const std::vector<Rigid2>& hypotheses_T_reference_query) {
  const PairVerifier verifier(options, reference, query);
  std::vector<Candidate> candidates = verifier.Refine(T_reference_query);
  for (Candidate& candidate :
       verifier.RefineBest(hypotheses_T_reference_query)) {
    candidates.push_back(std::move(candidate));
  }
  PairVerifier::SortByScore(&candidates);
  std::vector<VerifiedPose> verified;
  for (const Candidate& candidate :
       KeepDistinct(candidates, PoseOf, verifier.centroid(), kRivalTolerance,
                    kNoLimit)) {
    verified.push_back(verifier.Verify(
        candidate, candidates, PairVerifier::RivalSearch::kWhereLikely));
  }
  std::stable_sort(verified.begin(), verified.end(),
                   [](const VerifiedPose& a, const VerifiedPose& b) {
                     return a.score > b.score;
                   });
  return verified;
}

std::optional<VerifiedPose> VerifyClaim(
    const VerificationOptions& options, const SurfaceModel& reference,
    const SurfaceModel& query, const Rigid2& claimed_T_reference_query,
    const std::vector<Rigid2>& competitors) {
  const PairVerifier verifier(options, reference, query);
  const std::vector<Candidate> claimed = verifier.Refine(
      {PolishRotation(options.ranking, reference, query,
                      claimed_T_reference_query, verifier.centroid())});
  if (claimed.empty()) return std::nullopt;
  return verifier.Verify(claimed.front(), verifier.Refine(competitors),
                         PairVerifier::RivalSearch::kAlways);
}

std::vector<Rigid2> FindSelfSimilarPoses(
    const VerificationOptions& options, const SurfaceModel& model,
    const std::vector<Rigid2>& hypotheses) {
  const PairVerifier verifier(options, model, model);
  const auto is_identity = [&verifier](const Rigid2& pose) {
    return AreNear(pose, Rigid2(), verifier.centroid(), kRivalTolerance);
  };
  std::vector<Rigid2> distinct;
  for (const Rigid2& hypothesis : hypotheses) {
    if (!is_identity(hypothesis)) distinct.push_back(hypothesis);
  }
  std::vector<Rigid2> poses;
  // Registration may move a hypothesis to the identity.
  for (const Candidate& candidate : verifier.RefineBest(distinct)) {
    if (!is_identity(PoseOf(candidate))) poses.push_back(PoseOf(candidate));
  }
  return KeepDistinct(
      poses, [](const Rigid2& pose) { return pose; }, verifier.centroid(),
      kRivalTolerance, kMaxNumSelfSimilarPoses);
}

}  // namespace cartographer_sdf
