// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/neighbourhood.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Keeps the logarithm finite: less than one wall point in a hundred contradicts
// by noise.
constexpr double kNoiseRatio = 0.01;

struct NeighbourhoodTerm {
  const char* name;
  double NeighbourhoodWeights::*weight;
};
constexpr std::array<NeighbourhoodTerm, kNumNeighbourhoodTerms> kTerms = {
    {{"pair_score", &NeighbourhoodWeights::pair_score},
     {"log_contradiction", &NeighbourhoodWeights::log_contradiction}}};

// Itself and the neighbours that are there.
std::vector<SubmapId> Neighbours(const NeighbourhoodOptions& options,
                                 const PlacesAlongTrajectories& map,
                                 const SubmapId& id) {
  std::vector<SubmapId> neighbours;
  for (int step = -options.num_steps; step <= options.num_steps; ++step) {
    // Any file may say any index.
    const int64_t index =
        static_cast<int64_t>(id.index) + step * options.index_step;
    if (index < 0 || index > std::numeric_limits<int>::max()) continue;
    const SubmapId neighbour{id.trajectory, static_cast<int>(index)};
    if (map.places->count(neighbour) > 0) neighbours.push_back(neighbour);
  }
  return neighbours;
}

Rigid2 RelativePose(const PlacesAlongTrajectories& map, const SubmapId& a,
                    const SubmapId& b) {
  return map.odometry->at(a).T_local_submap.Inverse() *
         map.odometry->at(b).T_local_submap;
}

// Wall of `points` in metres: each point stands for those not looked at.
void Add(const AgreementOptions& options, const SurfaceModel& model,
         const SurfaceModel& points, const Rigid2& T_model_points,
         const int max_num_points, NeighbourhoodEvidence* const evidence) {
  const DirectedAgreement agreement =
      MeasureAgreement(options, model, points, T_model_points, max_num_points);
  const double looked_at = static_cast<double>(
      std::min(points.walls.size(), static_cast<size_t>(max_num_points)));
  const double stands_for = static_cast<double>(points.walls.size()) /
                            looked_at * points.geometry.resolution;
  evidence->wall_length += stands_for * agreement.num_points;
  evidence->contradicting_length += stands_for * agreement.contradictions;
}

}  // namespace

std::string Validate(const NeighbourhoodWeights& weights) {
  for (const NeighbourhoodTerm& term : kTerms) {
    if (!std::isfinite(weights.*term.weight)) {
      return std::string(term.name) + " must be finite";
    }
  }
  if (!std::isfinite(weights.bias)) return "bias must be finite";
  return "";
}

std::string Validate(const NeighbourhoodOptions& options) {
  if (options.num_steps < 0 || options.num_steps > 10 ||
      options.index_step < 1 || options.index_step > 100) {
    return "num_steps must lie between 0 and 10 and index_step between 1 and "
           "100";
  }
  if (options.num_points < 1) return "num_points must be positive";
  if (!(options.min_overlap_area >= 0. &&
        options.prior_wall_length_meters > 0. &&
        options.prior_contradiction_ratio > 0.)) {
    return "min_overlap_area must not be negative, prior_wall_length_meters "
           "and prior_contradiction_ratio must be positive";
  }
  if (!(options.max_gain >= 0.)) return "max_gain must not be negative";
  return Validate(options.weights);
}

double LogContradiction(const NeighbourhoodOptions& options,
                        const NeighbourhoodEvidence& evidence) {
  const double prior_ratio = options.prior_contradiction_ratio;
  const double ratio =
      (evidence.contradicting_length +
       prior_ratio * options.prior_wall_length_meters) /
      (evidence.wall_length + options.prior_wall_length_meters);
  return std::log((kNoiseRatio + ratio) / (kNoiseRatio + prior_ratio));
}

std::array<const char*, kNumNeighbourhoodTerms> NeighbourhoodTermNames() {
  std::array<const char*, kNumNeighbourhoodTerms> names = {};
  for (int k = 0; k < kNumNeighbourhoodTerms; ++k) names[k] = kTerms[k].name;
  return names;
}

std::array<double, kNumNeighbourhoodTerms> NeighbourhoodTerms(
    const NeighbourhoodOptions& options, const double pair_score,
    const NeighbourhoodEvidence& evidence) {
  return {pair_score, LogContradiction(options, evidence)};
}

double NeighbourhoodScore(const NeighbourhoodOptions& options,
                          const double pair_score,
                          const NeighbourhoodEvidence& evidence) {
  const std::array<double, kNumNeighbourhoodTerms> terms =
      NeighbourhoodTerms(options, pair_score, evidence);
  double score = options.weights.bias;
  for (int k = 0; k < kNumNeighbourhoodTerms; ++k) {
    score += options.weights.*kTerms[k].weight * terms[k];
  }
  return std::min(score, pair_score + options.max_gain);
}

Neighbourhood AskNeighbours(const NeighbourhoodOptions& options,
                            const VerificationOptions& verification,
                            const PlacesAlongTrajectories& references,
                            const PlacesAlongTrajectories& queries,
                            const std::optional<int> min_index_gap,
                            const SubmapId& reference, const SubmapId& query,
                            const Rigid2& T_reference_query) {
  CHECK_EQ(Validate(options), "");
  Neighbourhood neighbourhood;
  for (const SubmapId& i : Neighbours(options, references, reference)) {
    const SurfaceModel& i_surface = references.places->at(i).surface;
    const Rigid2 T_i_query =
        RelativePose(references, i, reference) * T_reference_query;
    for (const SubmapId& j : Neighbours(options, queries, query)) {
      if (i == reference && j == query) continue;
      if (min_index_gap && i.trajectory == j.trajectory &&
          std::abs(i.index - j.index) < *min_index_gap) {
        continue;
      }
      const SurfaceModel& j_surface = queries.places->at(j).surface;
      const Rigid2 predicted = T_i_query * RelativePose(queries, query, j);
      if (OverlapArea(i_surface, j_surface, predicted) <
          options.min_overlap_area) {
        continue;
      }
      const std::optional<Registration> registration = RegisterSubmaps(
          verification.registration, i_surface, j_surface, predicted);
      if (!registration) continue;
      const Rigid2& T_i_j = registration->T_reference_query;
      if (OverlapArea(i_surface, j_surface, T_i_j) < options.min_overlap_area) {
        continue;
      }
      ++neighbourhood.evidence.num_pairs;
      Add(verification.agreement, i_surface, j_surface, T_i_j,
          options.num_points, &neighbourhood.evidence);
      Add(verification.agreement, j_surface, i_surface, T_i_j.Inverse(),
          options.num_points, &neighbourhood.evidence);
      neighbourhood.proposals.push_back({i, j, T_i_j});
    }
  }
  return neighbourhood;
}

}  // namespace cartographer_sdf
