// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/hypothesis_ranking.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "cartographer_sdf/geometry/distinct_poses.h"
#include "cartographer_sdf/verification/agreement.h"

namespace cartographer_sdf {
namespace {

// Hypotheses nearer than this count as one.
constexpr PoseTolerance kSameHypothesis{0.3, 0.1};

// Each survivor is also tried turned by these before refinement: a hypothesis
// from keypoints is off by some degrees, beyond the reach of Gauss-Newton at
// the far ends of a submap [rad].
constexpr double kPolishRotations[] = {-0.035, 0.035, -0.07, 0.07};

double RankingScore(const RankingOptions& options,
                    const SurfaceModel& reference, const SurfaceModel& query,
                    const Rigid2& T_reference_query, const int num_points) {
  const AgreementOptions tolerance{options.hit_distance_meters,
                                   options.contradiction_distance_meters, true,
                                   num_points};
  const DirectedAgreement forward =
      MeasureAgreement(tolerance, reference, query.walls, T_reference_query);
  const DirectedAgreement backward = MeasureAgreement(
      tolerance, query, reference.walls, T_reference_query.Inverse());
  // Points that the other submap has not observed neither support nor
  // contradict the pose, but a pose at which few points are observed by both is
  // weak evidence: hence the extra points in the denominator.
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

// Best first; ties are broken by the pose, whatever the input order.
bool IsBetter(const Ranked& a, const Ranked& b) {
  const auto key = [](const Ranked& ranked) {
    const Rigid2& pose = ranked.T_reference_query;
    return std::make_tuple(-ranked.score, pose.rotation(),
                           pose.translation().x(), pose.translation().y());
  };
  return key(a) < key(b);
}

// Returns the best, best first, without scores below the minimum and near
// duplicates.
std::vector<Ranked> KeepBest(std::vector<Ranked> ranked, const int count,
                             const double min_score,
                             const Eigen::Vector2d& centroid) {
  std::sort(ranked.begin(), ranked.end(), IsBetter);
  ranked.erase(std::find_if(ranked.begin(), ranked.end(),
                            [min_score](const Ranked& candidate) {
                              return candidate.score < min_score;
                            }),
               ranked.end());
  return KeepDistinct(
      ranked,
      [](const Ranked& candidate) { return candidate.T_reference_query; },
      centroid, kSameHypothesis, static_cast<size_t>(count));
}

Rigid2 TurnAbout(const Rigid2& T_reference_query, const Eigen::Vector2d& at,
                 const double rotation) {
  const double turned = T_reference_query.rotation() + rotation;
  return Rigid2(T_reference_query * at - Eigen::Rotation2Dd(turned) * at,
                turned);
}

// Drops those whose score is worse than the first by more than the gap.
void DropWorse(const double gap, std::vector<Ranked>* const ranked) {
  while (!ranked->empty() &&
         ranked->back().score < ranked->front().score - gap) {
    ranked->pop_back();
  }
}

class FineRanking {
 public:
  FineRanking(const RankingOptions& options, const SurfaceModel& reference,
              const SurfaceModel& query, const Eigen::Vector2d& centroid)
      : options_(options),
        reference_(reference),
        query_(query),
        centroid_(centroid) {}

  [[nodiscard]] Ranked Rank(const Rigid2& T_reference_query) const {
    return {RankingScore(options_, reference_, query_, T_reference_query,
                         options_.num_fine_points),
            T_reference_query};
  }
  // Returns the pose itself and its turned copies.
  [[nodiscard]] std::vector<Ranked> Polished(const Ranked& unpolished) const {
    std::vector<Ranked> ranked = {unpolished};
    for (const double rotation : kPolishRotations) {
      ranked.push_back(
          Rank(TurnAbout(unpolished.T_reference_query, centroid_, rotation)));
    }
    return ranked;
  }

 private:
  const RankingOptions& options_;
  const SurfaceModel& reference_;
  const SurfaceModel& query_;
  const Eigen::Vector2d& centroid_;
};

}  // namespace

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

Rigid2 PolishRotation(const RankingOptions& options,
                      const SurfaceModel& reference, const SurfaceModel& query,
                      const Rigid2& T_reference_query,
                      const Eigen::Vector2d& centroid) {
  const FineRanking ranking(options, reference, query, centroid);
  const std::vector<Ranked> ranked =
      ranking.Polished(ranking.Rank(T_reference_query));
  return std::min_element(ranked.begin(), ranked.end(), IsBetter)
      ->T_reference_query;
}

std::vector<Rigid2> RankHypotheses(const RankingOptions& options,
                                   const SurfaceModel& reference,
                                   const SurfaceModel& query,
                                   const std::vector<Rigid2>& hypotheses,
                                   const Eigen::Vector2d& centroid) {
  std::vector<Ranked> coarse;
  for (const Rigid2& T_reference_query : hypotheses) {
    coarse.push_back({RankingScore(options, reference, query, T_reference_query,
                                   options.num_coarse_points),
                      T_reference_query});
  }
  coarse = KeepBest(std::move(coarse), options.num_coarse_survivors,
                    options.min_coarse_score, centroid);
  const FineRanking ranking(options, reference, query, centroid);
  std::vector<Ranked> fine;
  for (const Ranked& survivor : coarse) {
    fine.push_back(ranking.Rank(survivor.T_reference_query));
  }
  fine = KeepBest(std::move(fine), options.num_refined,
                  options.min_coarse_score, centroid);
  // Polishing gains less than this.
  DropWorse(2. * options.max_fine_score_gap, &fine);
  std::vector<Ranked> polished;
  for (const Ranked& survivor : fine) {
    for (const Ranked& turned : ranking.Polished(survivor)) {
      polished.push_back(turned);
    }
  }
  fine = KeepBest(std::move(polished), options.num_refined,
                  options.min_fine_score, centroid);
  DropWorse(options.max_fine_score_gap, &fine);
  std::vector<Rigid2> poses;
  for (const Ranked& ranked : fine) poses.push_back(ranked.T_reference_query);
  return poses;
}

}  // namespace cartographer_sdf
