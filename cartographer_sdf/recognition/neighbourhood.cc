// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/neighbourhood.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Keeps the logarithm finite: less than one wall point in a hundred contradicts
// by noise alone.
constexpr double kNoiseRatio = 0.01;

struct NeighbourhoodTerm {
  const char* name;
  double NeighbourhoodWeights::*weight;
};
constexpr std::array<NeighbourhoodTerm, kNumNeighbourhoodTerms> kTerms = {
    {{"pair_score", &NeighbourhoodWeights::pair_score},
     {"log_contradiction", &NeighbourhoodWeights::log_contradiction}}};

// Returns the submap itself and its existing neighbours.
std::vector<SubmapId> Neighbours(const NeighbourhoodOptions& options,
                                 const TrajectoryPlaces& map,
                                 const SubmapId& id) {
  std::vector<SubmapId> neighbours;
  for (int step = -options.num_steps; step <= options.num_steps; ++step) {
    // Files may contain any index.
    const int64_t index =
        static_cast<int64_t>(id.index) + step * options.index_step;
    if (index < 0 || index > std::numeric_limits<int>::max()) continue;
    const SubmapId neighbour{id.trajectory, static_cast<int>(index)};
    if (map.places->count(neighbour) > 0) neighbours.push_back(neighbour);
  }
  return neighbours;
}

Rigid2 RelativePose(const TrajectoryPlaces& map, const SubmapId& a,
                    const SubmapId& b) {
  return map.odometry->at(a).T_local_submap.Inverse() *
         map.odometry->at(b).T_local_submap;
}

// Adds the wall of `points` in metres: each sampled point also stands for those
// not sampled.
void Add(const AgreementOptions& options, const SurfaceModel& model,
         const SurfaceModel& points, const Rigid2& T_model_points,
         NeighbourhoodEvidence* const evidence) {
  const DirectedAgreement agreement =
      MeasureAgreement(options, model, points.walls, T_model_points);
  const double num_sampled = static_cast<double>(std::min(
      points.walls.size(), static_cast<size_t>(options.max_num_points)));
  const double stands_for = static_cast<double>(points.walls.size()) /
                            num_sampled * points.geometry.resolution;
  evidence->wall_length += stands_for * agreement.num_points;
  evidence->contradicting_length += stands_for * agreement.contradictions;
}

// Registers a pair of neighbours from its predicted pose and adds its evidence.
// Returns nullopt if registration fails, or the common observed area is too
// small before or after it.
std::optional<Rigid2> AddPair(const NeighbourhoodOptions& options,
                              const VerificationOptions& verification,
                              const SurfaceModel& reference,
                              const SurfaceModel& query,
                              const Rigid2& predicted,
                              NeighbourhoodEvidence* const evidence) {
  if (OverlapArea(reference, query, predicted) < options.min_overlap_area) {
    return std::nullopt;
  }
  const std::optional<Rigid2> registered =
      RegisterSubmaps(verification.registration, reference, query, predicted);
  if (!registered ||
      OverlapArea(reference, query, *registered) < options.min_overlap_area) {
    return std::nullopt;
  }
  AgreementOptions agreement = verification.agreement;
  agreement.max_num_points = options.num_points;
  ++evidence->num_pairs;
  Add(agreement, reference, query, *registered, evidence);
  Add(agreement, query, reference, registered->Inverse(), evidence);
  return registered;
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
  if (options.max_num_rounds < 0 || options.max_num_rounds > 1000) {
    return "max_num_rounds must lie between 0 and 1000";
  }
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

Neighbourhood MeasureNeighbourhood(const NeighbourhoodOptions& options,
                                   const VerificationOptions& verification,
                                   const TrajectoryPlaces& references,
                                   const TrajectoryPlaces& queries,
                                   const std::optional<int> min_index_gap,
                                   const PairPose& pair) {
  CHECK_EQ(Validate(options), "");
  Neighbourhood neighbourhood;
  for (const SubmapId& i : Neighbours(options, references, pair.reference)) {
    const SurfaceModel& i_surface = references.places->at(i).surface;
    const Rigid2 T_i_query =
        RelativePose(references, i, pair.reference) * pair.T_reference_query;
    for (const SubmapId& j : Neighbours(options, queries, pair.query)) {
      if ((i == pair.reference && j == pair.query) ||
          (min_index_gap && ShareScans(i, j, *min_index_gap))) {
        continue;
      }
      const std::optional<Rigid2> T_i_j = AddPair(
          options, verification, i_surface, queries.places->at(j).surface,
          T_i_query * RelativePose(queries, pair.query, j),
          &neighbourhood.evidence);
      if (T_i_j) neighbourhood.proposals.push_back({i, j, *T_i_j});
    }
  }
  return neighbourhood;
}

}  // namespace cartographer_sdf
