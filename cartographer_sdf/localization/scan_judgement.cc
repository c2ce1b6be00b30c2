// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/scan_judgement.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/localization/compared_numbers.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Beams of a sweep that sees all round, one a degree.
constexpr double kNumAllBeams = 360.;
// Of the candidates, this one fits by chance, since few buildings repeat a
// place more often; and how well the best of fewer would.
constexpr size_t kChanceCandidate = 5;
constexpr double kChanceFit = 0.35;
constexpr double kMinFraction = 0.03;
// With at most this probability of being elsewhere, the robot is in the map,
// and the only question is where.
constexpr double kMaxElsewhereIfAmbiguous = 0.05;
// A gap this wide in the field of view is worth turning for.
constexpr double kWideGap = M_PI / 4.;

double LooseFit(const BeamEvidence& evidence) {
  return evidence.at_wall - evidence.fit;
}
double LogFraction(const double fraction) {
  return std::log(kMinFraction + fraction);
}

// The log-odds that the right pose is among the candidates, the best first.
double PresenceLogOdds(const PresenceWeights& weights,
                       const std::vector<ScanCandidate>& candidates) {
  const BeamEvidence& best = candidates.front().evidence;
  const double chance_fit = candidates.size() > kChanceCandidate
                                ? candidates[kChanceCandidate].evidence.fit
                                : kChanceFit;
  return weights.loose_fit * LooseFit(best) +
         weights.log_through * LogFraction(best.through_wall) +
         weights.log_free * LogFraction(best.in_free_space) +
         weights.in_unknown * best.in_unknown +
         weights.num_beams * best.num_beams / kNumAllBeams +
         weights.lead * (best.fit - chance_fit) + weights.bias;
}

std::string FormatScanPose(const Rigid2& pose) {
  return absl::StrFormat("(%.2f, %.2f, %.0f degrees)", pose.translation().x(),
                         pose.translation().y(), pose.rotation() * 180. / M_PI);
}

std::string DescribeFit(const BeamEvidence& evidence) {
  return absl::StrFormat(
      "%.0f %% of its beams end at walls, %.0f %% cross walls, %.0f %% meet "
      "something that is not in the map",
      100. * evidence.at_wall, 100. * evidence.through_wall,
      100. * evidence.in_free_space);
}

// Of the candidates, how many it takes to hold nine tenths of what they hold.
// How well it fits by chance; nothing where there are few poses.
std::string DescribeChance(const std::vector<ScanCandidate>& candidates) {
  if (candidates.size() <= kChanceCandidate) return "";
  return absl::StrFormat(", at the sixth best %.0f %% end at walls",
                         100. * candidates[kChanceCandidate].evidence.at_wall);
}

size_t NumLikely(const ScanLocalization& result) {
  double left = 0.9 * (1. - *result.elsewhere_probability);
  size_t count = 0;
  while (count < result.candidates.size() && left > 0.) {
    left -= result.candidates[count++].probability;
  }
  return count;
}

}  // namespace

std::string Validate(const CandidateWeights& weights) {
  const double sum = weights.fit + weights.loose_fit + weights.log_through +
                     weights.log_free + weights.in_unknown;
  return std::isfinite(sum) ? "" : "weights must be finite";
}

std::string Validate(const PresenceWeights& weights) {
  const double sum = weights.loose_fit + weights.log_through +
                     weights.log_free + weights.in_unknown + weights.num_beams +
                     weights.lead + weights.bias;
  return std::isfinite(sum) ? "" : "weights must be finite";
}

double CandidateUtility(const CandidateWeights& weights,
                        const BeamEvidence& evidence) {
  return weights.fit * evidence.fit + weights.loose_fit * LooseFit(evidence) +
         weights.log_through * LogFraction(evidence.through_wall) +
         weights.log_free * LogFraction(evidence.in_free_space) +
         weights.in_unknown * evidence.in_unknown;
}

void AssignProbabilities(const CandidateWeights& candidate_weights,
                         const double utility_factor,
                         const PresenceWeights& presence_weights,
                         ScanLocalization* const result) {
  CHECK(!result->candidates.empty());
  std::vector<ScanCandidate>& candidates = result->candidates;
  const double best =
      CandidateUtility(candidate_weights, candidates.front().evidence);
  double sum = 0.;
  for (ScanCandidate& candidate : candidates) {
    candidate.probability = std::exp(
        utility_factor *
        (CandidateUtility(candidate_weights, candidate.evidence) - best));
    sum += candidate.probability;
  }
  const double log_odds = PresenceLogOdds(presence_weights, candidates);
  const double presence = 1. / (1. + std::exp(-log_odds));
  for (ScanCandidate& candidate : candidates) {
    candidate.probability *= presence / sum;
  }
  result->elsewhere_probability = 1. - presence;
}

std::string AdviceForGap(const double widest_gap) {
  return widest_gap > kWideGap
             ? absl::StrFormat(
                   "turn around (%.0f degrees were not seen) or drive 5 m",
                   widest_gap * 180. / M_PI)
             : "drive 5 m";
}

void JudgeCandidates(const double min_probability, const double widest_gap,
                     ScanLocalization* const result) {
  const ScanCandidate& best = result->candidates.front();
  const ComparedNumbers compared =
      FormatCompared(best.probability, min_probability, 3);
  if (best.probability >= min_probability) {
    result->verdict = LocalizationVerdict::kLocalized;
    result->reason =
        absl::StrCat("one pose has the probability ", compared.number, ": ",
                     DescribeFit(best.evidence));
  } else if (*result->elsewhere_probability > 0.5) {
    result->verdict = LocalizationVerdict::kNothingAlike;
    result->reason = absl::StrFormat(
        "it fits nowhere well enough: at the best pose %s%s; with the "
        "probability %.2f the robot is where the map never was, or too much "
        "has changed; %s",
        DescribeFit(best.evidence), DescribeChance(result->candidates),
        *result->elsewhere_probability, AdviceForGap(widest_gap));
  } else if (*result->elsewhere_probability <= kMaxElsewhereIfAmbiguous &&
             NumLikely(*result) > 1) {
    result->verdict = LocalizationVerdict::kAmbiguous;
    result->reason = absl::StrFormat(
        "%d poses look alike; the best two are %s with the probability %.2f "
        "and %s with %.2f; %s",
        NumLikely(*result), FormatScanPose(best.T_map_robot), best.probability,
        FormatScanPose(result->candidates[1].T_map_robot),
        result->candidates[1].probability, AdviceForGap(widest_gap));
  } else {
    result->verdict = LocalizationVerdict::kUncertain;
    result->reason = absl::StrFormat(
        "the best pose, %s, has the probability %s, and certain is %s; being "
        "elsewhere has %.2f; %s",
        FormatScanPose(best.T_map_robot), compared.number, compared.threshold,
        *result->elsewhere_probability, AdviceForGap(widest_gap));
  }
}

}  // namespace cartographer_sdf
