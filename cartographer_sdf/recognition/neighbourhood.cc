// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/neighbourhood.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include "cartographer_sdf/geometry/distinct_poses.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Keeps the logarithm finite: less than one wall point in a hundred contradicts
// by noise alone.
constexpr double kNoiseRatio = 0.01;

// Edge length of the tiles in which ground is counted [m]: some are filled by
// the points of any overlap that is looked at.
constexpr double kGroundTileSize = 2.;

struct NeighbourhoodTerm {
  const char* name;
  double NeighbourhoodWeights::*weight;
};
constexpr std::array<NeighbourhoodTerm, kNumNeighbourhoodTerms> kTerms = {
    {{"pair_score", &NeighbourhoodWeights::pair_score},
     {"log_contradiction", &NeighbourhoodWeights::log_contradiction},
     {"log_confirmation", &NeighbourhoodWeights::log_confirmation}}};

std::vector<SubmapId> Neighbours(const NeighbourhoodOptions& options,
                                 const TrajectoryPlaces& map,
                                 const TrajectoryLinks* const links,
                                 const SubmapId& id) {
  return SubmapsAround(map, links, id, options.num_steps, options.index_step);
}

// Returns the match of a pair by itself.
std::optional<PairPose> OwnMatch(const NeighbourhoodMaps& maps,
                                 const SubmapId& reference,
                                 const SubmapId& query) {
  if (maps.own_matches == nullptr) return std::nullopt;
  const bool is_swapped = maps.min_index_gap && query < reference;
  const auto found =
      maps.own_matches->find(is_swapped ? std::make_pair(query, reference)
                                        : std::make_pair(reference, query));
  if (found == maps.own_matches->end()) return std::nullopt;
  PairPose match = found->second;
  if (is_swapped) match.T_reference_query = match.T_reference_query.Inverse();
  return match;
}

double Probability(const double log_odds) {
  return 1. / (1. + std::exp(-log_odds));
}

// Counts pairs that confirm a match. Pairs that see the same ground are
// independent witnesses against noise, but a single one against a look-alike:
// four submaps of one hall that agree on where it is may agree on the wrong
// hall. They count as the geometric mean of both. Ground is counted in tiles.
class ConfirmingPairs {
 public:
  // `seen` is the ground of the match itself.
  explicit ConfirmingPairs(std::set<TileIndex> seen) : seen_(std::move(seen)) {}

  void Add(const std::set<TileIndex>& tiles) {
    ++num_pairs_;
    num_tiles_ += tiles.size();
    std::set_difference(tiles.begin(), tiles.end(), seen_.begin(), seen_.end(),
                        std::inserter(news_, news_.end()));
  }

  // Independent of the order of the pairs.
  [[nodiscard]] double Count() const {
    if (num_tiles_ == 0) return 0.;
    const double count = static_cast<double>(num_pairs_);
    // Pairs of the mean size that would have shown no ground twice.
    const double independent = count * static_cast<double>(news_.size()) /
                               static_cast<double>(num_tiles_);
    return std::sqrt(count * independent);
  }

 private:
  const std::set<TileIndex> seen_;
  std::set<TileIndex> news_;
  size_t num_pairs_ = 0;
  size_t num_tiles_ = 0;
};

// Measures one match's neighbouring pairs.
class NeighbourhoodMeasurer {
 public:
  NeighbourhoodMeasurer(const NeighbourhoodOptions& options,
                        const VerificationOptions& verification,
                        const NeighbourhoodMaps& maps, const PairPose& pair)
      : options_(options),
        verification_(verification),
        maps_(maps),
        reference_(pair.reference),
        confirming_(
            TilesOf(pair.reference, pair.query, pair.T_reference_query)) {
    agreement_ = verification.agreement;
    agreement_.max_num_points = options.num_points;
  }

  void Add(const SubmapId& reference, const SubmapId& query,
           const Rigid2& predicted) {
    const SurfaceModel& i = maps_.references.places->at(reference).surface;
    const SurfaceModel& j = maps_.queries.places->at(query).surface;
    if (!OverlapsEnough(i, j, predicted)) return;
    const std::optional<PairPose> match = OwnMatch(maps_, reference, query);
    const bool is_confirmed =
        match &&
        AreNear(match->T_reference_query, predicted, ObservedCentroid(j),
                {options_.max_prediction_error_meters,
                 options_.max_prediction_rotation_error});
    NeighbourhoodEvidence& evidence = neighbourhood_.evidence;
    std::optional<Rigid2> pose;
    if (is_confirmed) {
      confirming_.Add(TilesOf(reference, query, match->T_reference_query));
      pose = match->T_reference_query;
    } else {
      if (match) evidence.num_refuting += Probability(match->score);
      pose = RegisterSubmaps(verification_.registration, i, j, predicted);
    }
    if (!pose || !OverlapsEnough(i, j, *pose)) return;
    ++evidence.num_pairs;
    AddWall(i, j, *pose);
    AddWall(j, i, pose->Inverse());
    if (!is_confirmed) {
      neighbourhood_.proposals.push_back({reference, query, *pose});
    }
  }

  [[nodiscard]] Neighbourhood Take() {
    neighbourhood_.evidence.num_confirming = confirming_.Count();
    return std::move(neighbourhood_);
  }

 private:
  [[nodiscard]] bool OverlapsEnough(const SurfaceModel& reference,
                                    const SurfaceModel& query,
                                    const Rigid2& pose) const {
    return OverlapsBy(options_.min_overlap_area, reference, query, pose);
  }

  // In the frame of the match's reference, by local SLAM.
  [[nodiscard]] std::set<TileIndex> TilesOf(const SubmapId& reference,
                                            const SubmapId& query,
                                            const Rigid2& pose) const {
    return OverlapTiles(maps_.references.places->at(reference).surface,
                        maps_.queries.places->at(query).surface, pose,
                        RelativePose(maps_.references, reference_, reference),
                        kGroundTileSize);
  }

  // Adds the wall of `points` in metres: each sampled point also stands for
  // those not sampled.
  void AddWall(const SurfaceModel& model, const SurfaceModel& points,
               const Rigid2& T_model_points) {
    const DirectedAgreement agreement =
        MeasureAgreement(agreement_, model, points.walls, T_model_points);
    const double num_sampled = static_cast<double>(std::min(
        points.walls.size(), static_cast<size_t>(agreement_.max_num_points)));
    const double stands_for = static_cast<double>(points.walls.size()) /
                              num_sampled * points.geometry.resolution;
    NeighbourhoodEvidence& evidence = neighbourhood_.evidence;
    evidence.wall_length += stands_for * agreement.num_points;
    evidence.contradicting_length += stands_for * agreement.contradictions;
  }

  const NeighbourhoodOptions& options_;
  const VerificationOptions& verification_;
  const NeighbourhoodMaps& maps_;
  const SubmapId reference_;  // of the match
  ConfirmingPairs confirming_;
  AgreementOptions agreement_;
  Neighbourhood neighbourhood_;
};

}  // namespace

std::vector<SubmapId> SubmapsAround(const TrajectoryPlaces& map,
                                    const TrajectoryLinks* const links,
                                    const SubmapId& id, const int num_steps,
                                    const int index_step) {
  std::vector<SubmapId> around;
  for (int step = -num_steps; step <= num_steps; ++step) {
    // Files may contain any index.
    const int64_t index = id.index + int64_t{step} * index_step;
    if (index < 0 || index > std::numeric_limits<int>::max()) continue;
    const SubmapId other{id.trajectory, static_cast<int>(index)};
    if (map.places->count(other) == 0 ||
        (links != nullptr && links->IsBrokenBetween(id, other))) {
      continue;
    }
    around.push_back(other);
  }
  return around;
}

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
  if (options.max_proposal_index_distance < 0 ||
      options.max_proposal_index_distance > 100) {
    return "max_proposal_index_distance must lie between 0 and 100";
  }
  if (options.max_num_matches_per_submap < 0) {
    return "max_num_matches_per_submap must not be negative";
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
  if (!(options.max_prediction_error_meters > 0. &&
        options.max_prediction_rotation_error > 0.)) {
    return "max_prediction_error_meters and max_prediction_rotation_error must "
           "be positive";
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

double LogConfirmation(const NeighbourhoodEvidence& evidence) {
  // One match for and one against keep it finite.
  return std::log((evidence.num_confirming + 1.) /
                  (evidence.num_refuting + 1.));
}

std::array<const char*, kNumNeighbourhoodTerms> NeighbourhoodTermNames() {
  std::array<const char*, kNumNeighbourhoodTerms> names = {};
  for (int k = 0; k < kNumNeighbourhoodTerms; ++k) names[k] = kTerms[k].name;
  return names;
}

std::array<double, kNumNeighbourhoodTerms> NeighbourhoodTerms(
    const NeighbourhoodOptions& options, const double pair_score,
    const NeighbourhoodEvidence& evidence) {
  return {pair_score, LogContradiction(options, evidence),
          LogConfirmation(evidence)};
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
                                   const NeighbourhoodMaps& maps,
                                   const PairPose& pair) {
  CHECK_EQ(Validate(options), "");
  NeighbourhoodMeasurer measurer(options, verification, maps, pair);
  for (const SubmapId& i : Neighbours(options, maps.references,
                                      maps.reference_links, pair.reference)) {
    const Rigid2 T_i_query = RelativePose(maps.references, i, pair.reference) *
                             pair.T_reference_query;
    for (const SubmapId& j :
         Neighbours(options, maps.queries, maps.query_links, pair.query)) {
      if ((i == pair.reference && j == pair.query) ||
          (maps.min_index_gap && ShareScans(i, j, *maps.min_index_gap))) {
        continue;
      }
      measurer.Add(i, j, T_i_query * RelativePose(maps.queries, pair.query, j));
    }
  }
  return measurer.Take();
}

}  // namespace cartographer_sdf
