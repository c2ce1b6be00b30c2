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
  if (is_swapped) {
    std::swap(match.reference, match.query);
    match.T_reference_query = match.T_reference_query.Inverse();
  }
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
                        const NeighbourhoodMaps& maps, const PairPose& match,
                        NeighbourWalls* const walls)
      : options_(options), maps_(maps), match_(match), walls_(walls) {}

  // Looks at a neighbouring pair where it is predicted: at its own match, or
  // later, with CompareOthers.
  void Add(const PairPose& predicted) {
    const std::optional<PairPose> own =
        OwnMatch(maps_, predicted.reference, predicted.query);
    if (!own) {
      others_.push_back(predicted);
    } else if (OverlapsEnough(predicted)) {
      AddMatched(predicted, *own);
    }
  }

  // Registers and compares the pairs whose own matches do not confirm the
  // prediction, as long as the match is promising.
  void CompareOthers() {
    if (confirming_) {
      neighbourhood_.evidence.num_confirming = confirming_->Count();
    }
    for (const PairPose& predicted : others_) {
      if (NeighbourhoodScore(options_, match_.score, neighbourhood_.evidence) <
          options_.min_promising_score) {
        return;
      }
      if (!OverlapsEnough(predicted)) continue;
      const std::optional<ComparedWalls> walls = walls_->Registered(predicted);
      if (!walls) continue;
      Count(walls);
      neighbourhood_.proposals.push_back(
          {predicted.reference, predicted.query, walls->T_reference_query});
    }
  }

  [[nodiscard]] Neighbourhood Take() { return std::move(neighbourhood_); }

 private:
  [[nodiscard]] bool OverlapsEnough(const PairPose& predicted) const {
    return OverlapsBy(options_.min_overlap_area,
                      maps_.references.places->at(predicted.reference).surface,
                      maps_.queries.places->at(predicted.query).surface,
                      predicted.T_reference_query);
  }

  void AddMatched(const PairPose& predicted, const PairPose& own) {
    if (AreNear(own.T_reference_query, predicted.T_reference_query,
                ObservedCentroid(maps_.queries.places->at(own.query).surface),
                {options_.max_prediction_error_meters,
                 options_.max_prediction_rotation_error})) {
      if (!confirming_) confirming_.emplace(TilesOf(match_));
      confirming_->Add(TilesOf(own));
      Count(walls_->AtMatch(own));
    } else {
      neighbourhood_.evidence.num_refuting += Probability(own.score);
      others_.push_back(predicted);
    }
  }

  // In the frame of the match's reference, by local SLAM.
  [[nodiscard]] std::set<TileIndex> TilesOf(const PairPose& pair) const {
    return OverlapTiles(
        maps_.references.places->at(pair.reference).surface,
        maps_.queries.places->at(pair.query).surface, pair.T_reference_query,
        RelativePose(maps_.references, match_.reference, pair.reference),
        kGroundTileSize);
  }

  void Count(const std::optional<ComparedWalls>& walls) {
    if (!walls) return;
    NeighbourhoodEvidence& evidence = neighbourhood_.evidence;
    ++evidence.num_pairs;
    evidence.wall_length += walls->wall_length;
    evidence.contradicting_length += walls->contradicting_length;
  }

  const NeighbourhoodOptions& options_;
  const NeighbourhoodMaps& maps_;
  const PairPose& match_;
  std::optional<ConfirmingPairs> confirming_;  // of the first on
  NeighbourWalls* const walls_;
  std::vector<PairPose> others_;
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
  if (!std::isfinite(options.min_promising_score)) {
    return "min_promising_score must be finite";
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

NeighbourhoodMeter::NeighbourhoodMeter(const NeighbourhoodOptions& options,
                                       const VerificationOptions& verification,
                                       const NeighbourhoodMaps& maps)
    : options_(options),
      maps_(maps),
      walls_(verification, options.num_points, options.min_overlap_area,
             maps.references, maps.queries) {
  CHECK_EQ(Validate(options), "");
}

Neighbourhood NeighbourhoodMeter::Measure(const PairPose& match) {
  NeighbourhoodMeasurer measurer(options_, maps_, match, &walls_);
  for (const SubmapId& i : Neighbours(options_, maps_.references,
                                      maps_.reference_links, match.reference)) {
    const Rigid2 T_i_query =
        RelativePose(maps_.references, i, match.reference) *
        match.T_reference_query;
    for (const SubmapId& j :
         Neighbours(options_, maps_.queries, maps_.query_links, match.query)) {
      if ((i == match.reference && j == match.query) ||
          (maps_.min_index_gap && ShareScans(i, j, *maps_.min_index_gap))) {
        continue;
      }
      measurer.Add(
          {i, j, T_i_query * RelativePose(maps_.queries, match.query, j)});
    }
  }
  measurer.CompareOthers();
  return measurer.Take();
}

}  // namespace cartographer_sdf
