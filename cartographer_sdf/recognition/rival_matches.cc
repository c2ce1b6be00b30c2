// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/rival_matches.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Returns ln(1 + odds), whatever the size of the log-odds.
double LogOfOnePlusOdds(const double log_odds) {
  return std::max(log_odds, 0.) + std::log1p(std::exp(-std::abs(log_odds)));
}

// One of the submaps that a shared submap is matched with.
struct View {
  size_t match;
  SubmapId other;
  Rigid2 T_other_shared;
};

// The views of each submap on one side, from the submaps of the other.
using Views = std::map<SubmapId, std::vector<View>>;

class RivalFinder {
 public:
  RivalFinder(const RivalMatchOptions& options, const TrajectoryPlaces& others,
              const TrajectoryLinks* const links)
      : options_(options), others_(others), links_(links) {}

  // Enters the scores of the best rivals of all matches that are views.
  void Find(const Views& views, const std::vector<Match>& matches,
            std::vector<double>* const best_rivals) const {
    for (const auto& [shared, of_shared] : views) {
      for (const View& view : of_shared) {
        double& best = (*best_rivals)[view.match];
        for (const View& other : of_shared) {
          const double score = matches[other.match].pair.score;
          if (score > best && Exclude(view, other)) best = score;
        }
      }
    }
  }

 private:
  // Whether the shared submap cannot be where both put it.
  [[nodiscard]] bool Exclude(const View& a, const View& b) const {
    if (a.other.trajectory != b.other.trajectory || a.other == b.other ||
        (links_ != nullptr && links_->IsBrokenBetween(a.other, b.other))) {
      return false;
    }
    const OdometryPose& pose_a = others_.odometry->at(a.other);
    const OdometryPose& pose_b = others_.odometry->at(b.other);
    const Rigid2 T_a_b =
        pose_a.T_local_submap.Inverse() * pose_b.T_local_submap;
    // From where b puts the shared submap to where a does.
    const Rigid2 T_by_a_by_b =
        a.T_other_shared.Inverse() * (T_a_b * b.T_other_shared);
    const double way =
        std::abs(pose_b.distance_driven - pose_a.distance_driven);
    const double rotation_drift =
        options_.max_rotation_drift_per_sqrt_meter * std::sqrt(way);
    const double drift = options_.max_drift_per_meter * way +
                         rotation_drift * T_a_b.translation().norm();
    return T_by_a_by_b.translation().norm() >
               options_.min_distance_meters + drift ||
           std::abs(T_by_a_by_b.rotation()) >
               options_.min_rotation + rotation_drift;
  }

  const RivalMatchOptions& options_;
  const TrajectoryPlaces& others_;
  const TrajectoryLinks* const links_;
};

}  // namespace

std::string Validate(const RivalMatchOptions& options) {
  if (!(options.min_lead >= 0.)) return "min_lead must not be negative";
  if (!(options.rival_weight >= 0. && options.rival_weight <= 1.)) {
    return "rival_weight must lie between 0 and 1";
  }
  if (!(options.min_distance_meters >= 0. && options.min_rotation >= 0.)) {
    return "min_distance_meters and min_rotation must not be negative";
  }
  if (!(options.max_drift_per_meter >= 0. &&
        options.max_rotation_drift_per_sqrt_meter >= 0.)) {
    return "max_drift_per_meter and max_rotation_drift_per_sqrt_meter must not "
           "be negative";
  }
  return "";
}

void RefuseRivalMatches(const RivalMatchOptions& options,
                        const JudgementOptions& judgement,
                        const NeighbourhoodMaps& maps,
                        std::vector<Match>* const matches) {
  CHECK_EQ(Validate(options), "");
  Views of_queries, of_references;
  for (size_t k = 0; k < matches->size(); ++k) {
    const PairPose& pair = (*matches)[k].pair;
    const Rigid2 T_query_reference = pair.T_reference_query.Inverse();
    of_queries[pair.query].push_back(
        {k, pair.reference, pair.T_reference_query});
    // Within one map both submaps are of the same kind.
    (maps.min_index_gap ? of_queries : of_references)[pair.reference].push_back(
        {k, pair.query, T_query_reference});
  }
  std::vector<double> best_rivals(matches->size(),
                                  -std::numeric_limits<double>::infinity());
  RivalFinder(options, maps.references, maps.reference_links)
      .Find(of_queries, *matches, &best_rivals);
  RivalFinder(options, maps.queries, maps.query_links)
      .Find(of_references, *matches, &best_rivals);
  for (size_t k = 0; k < matches->size(); ++k) {
    Match& match = (*matches)[k];
    const double lead = match.pair.score - best_rivals[k];
    match.pair.score -= options.rival_weight * LogOfOnePlusOdds(best_rivals[k]);
    match.has_rival = lead < options.min_lead;
    if (match.verdict == Verdict::kAccepted &&
        (match.has_rival || match.pair.score < judgement.min_score)) {
      match.verdict = Verdict::kAmbiguous;
    }
  }
}

}  // namespace cartographer_sdf
