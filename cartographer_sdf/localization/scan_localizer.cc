// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/scan_localizer.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/execution/stage_clock.h"
#include "cartographer_sdf/geometry/distinct_poses.h"
#include "cartographer_sdf/localization/compared_numbers.h"
#include "cartographer_sdf/localization/panorama_search.h"
#include "cartographer_sdf/localization/sweep.h"
#include "cartographer_sdf/localization/sweep_registration.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Of a sweep that is measured: one beam per degree.
constexpr int kNumMeasuredDirections = 360;
constexpr size_t kNumCoarseBeams = 64;
constexpr double kCoarseKernelScale = 0.8, kFineKernelScale = 0.3;  // [m]
constexpr size_t kMaxNumCandidates = 40;
constexpr PoseTolerance kSamePose{0.5, 0.175};
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

double Utility(const CandidateWeights& weights, const BeamEvidence& evidence) {
  return weights.fit * evidence.fit + weights.loose_fit * LooseFit(evidence) +
         weights.log_through * LogFraction(evidence.through_wall) +
         weights.log_free * LogFraction(evidence.in_free_space) +
         weights.in_unknown * evidence.in_unknown;
}

// The probability that the right pose is among the candidates, the best first.
double PresenceProbability(const PresenceWeights& weights,
                           const std::vector<ScanCandidate>& candidates) {
  const BeamEvidence& best = candidates.front().evidence;
  const double chance_fit = candidates.size() > kChanceCandidate
                                ? candidates[kChanceCandidate].evidence.fit
                                : kChanceFit;
  const double log_odds =
      weights.loose_fit * LooseFit(best) +
      weights.log_through * LogFraction(best.through_wall) +
      weights.log_free * LogFraction(best.in_free_space) +
      weights.in_unknown * best.in_unknown +
      weights.num_beams * best.num_beams / kNumMeasuredDirections +
      weights.lead * (best.fit - chance_fit) + weights.bias;
  return 1. / (1. + std::exp(-log_odds));
}

// What a pose of the robot in the grid explains.
struct MeasuredSweep {
  RegisteredSweep registered;
  BeamEvidence evidence;
  double utility;
};

// Registers poses of the robot in the grid and returns the best distinct ones.
std::vector<MeasuredSweep> RegisterAll(
    const CandidateWeights& weights, const RayMap& map, const Sweep& sweep,
    const size_t num_beams, const double kernel_scale,
    const std::vector<Rigid2>& T_grid_robot) {
  std::vector<MeasuredSweep> measured;
  for (const Rigid2& guess : T_grid_robot) {
    const std::optional<RegisteredSweep> registered =
        RegisterSweep(map.field, sweep, num_beams, kernel_scale, guess);
    if (!registered) continue;
    const BeamEvidence evidence =
        MeasureBeams(map, sweep, registered->T_grid_robot);
    measured.push_back({*registered, evidence, Utility(weights, evidence)});
  }
  std::stable_sort(measured.begin(), measured.end(),
                   [](const MeasuredSweep& a, const MeasuredSweep& b) {
                     return a.utility > b.utility;
                   });
  return KeepDistinct(
      measured,
      [](const MeasuredSweep& one) { return one.registered.T_grid_robot; },
      sweep.centre, kSamePose, kMaxNumCandidates);
}

int NumEchoes(const Sweep& sweep) {
  return static_cast<int>(
      std::count_if(sweep.beams.begin(), sweep.beams.end(),
                    [](const RobotBeam& beam) { return beam.has_echo; }));
}

std::vector<Rigid2> PosesOf(const std::vector<MeasuredSweep>& sweeps) {
  std::vector<Rigid2> T_grid_robot;
  for (const MeasuredSweep& sweep : sweeps) {
    T_grid_robot.push_back(sweep.registered.T_grid_robot);
  }
  return T_grid_robot;
}

void AssignProbabilities(const ScanLocalizationOptions& options,
                         ScanLocalization* const result) {
  std::vector<ScanCandidate>& candidates = result->candidates;
  const double best =
      Utility(options.candidate_weights, candidates.front().evidence);
  double sum = 0.;
  for (ScanCandidate& candidate : candidates) {
    candidate.probability =
        std::exp(Utility(options.candidate_weights, candidate.evidence) - best);
    sum += candidate.probability;
  }
  const double presence =
      PresenceProbability(options.presence_weights, candidates);
  for (ScanCandidate& candidate : candidates) {
    candidate.probability *= presence / sum;
  }
  result->elsewhere_probability = 1. - presence;
}

std::string FormatScanPose(const Rigid2& pose) {
  return absl::StrFormat("(%.2f, %.2f, %.0f degrees)", pose.translation().x(),
                         pose.translation().y(), pose.rotation() * 180. / M_PI);
}

std::string Advice(const Sweep& sweep) {
  return sweep.widest_gap > kWideGap
             ? absl::StrFormat(
                   "turn around (%.0f degrees were not seen) or drive 5 m",
                   sweep.widest_gap * 180. / M_PI)
             : "drive 5 m";
}

std::string DescribeFit(const BeamEvidence& evidence) {
  return absl::StrFormat(
      "%.0f %% of its beams end at walls, %.0f %% cross walls, %.0f %% meet "
      "something that is not in the map",
      100. * evidence.at_wall, 100. * evidence.through_wall,
      100. * evidence.in_free_space);
}

// Of the candidates, how many it takes to hold nine tenths of what they hold.
size_t NumLikely(const ScanLocalization& result) {
  double left = 0.9 * (1. - *result.elsewhere_probability);
  size_t count = 0;
  while (count < result.candidates.size() && left > 0.) {
    left -= result.candidates[count++].probability;
  }
  return count;
}

void JudgeCandidates(const ScanLocalizationOptions& options, const Sweep& sweep,
                     ScanLocalization* const result) {
  const ScanCandidate& best = result->candidates.front();
  const ComparedNumbers compared =
      FormatCompared(best.probability, options.min_probability, 3);
  if (best.probability >= options.min_probability) {
    result->verdict = LocalizationVerdict::kLocalized;
    result->reason =
        absl::StrCat("one pose has the probability ", compared.number, ": ",
                     DescribeFit(best.evidence));
  } else if (*result->elsewhere_probability > 0.5) {
    result->verdict = LocalizationVerdict::kNothingAlike;
    result->reason = absl::StrFormat(
        "it fits nowhere well: at the best pose %s; with the probability %.2f "
        "the robot is where the map never was, or too much has changed; %s",
        DescribeFit(best.evidence), *result->elsewhere_probability,
        Advice(sweep));
  } else if (*result->elsewhere_probability <= kMaxElsewhereIfAmbiguous &&
             NumLikely(*result) > 1) {
    result->verdict = LocalizationVerdict::kAmbiguous;
    result->reason = absl::StrFormat(
        "%d poses look alike; the best two are %s with the probability %.2f "
        "and %s with %.2f; %s",
        NumLikely(*result), FormatScanPose(best.T_map_robot), best.probability,
        FormatScanPose(result->candidates[1].T_map_robot),
        result->candidates[1].probability, Advice(sweep));
  } else {
    result->verdict = LocalizationVerdict::kUncertain;
    result->reason = absl::StrFormat(
        "the best pose, %s, has the probability %s, and certain is %s; being "
        "elsewhere has %.2f; %s",
        FormatScanPose(best.T_map_robot), compared.number, compared.threshold,
        *result->elsewhere_probability, Advice(sweep));
  }
}

// Without a probability yet.
ScanCandidate CandidateOf(const Rigid2& T_map_grid,
                          const MeasuredSweep& measured) {
  ScanCandidate candidate;
  candidate.T_map_robot = T_map_grid * measured.registered.T_grid_robot;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  rotation.topLeftCorner<2, 2>() = T_map_grid.RotationMatrix();
  candidate.covariance =
      rotation * measured.registered.covariance * rotation.transpose();
  candidate.evidence = measured.evidence;
  return candidate;
}

// Searches with few beams, registers with few beams what fits best, and what is
// left with all beams of the sweep.
std::vector<ScanCandidate> FindCandidates(
    const ScanLocalizationOptions& options, const PanoramaMap& map,
    const std::vector<RobotScan>& scans, const Sweep& sweep,
    std::vector<std::pair<std::string, double>>* const stage_seconds) {
  StageClock clock({}, stage_seconds);
  clock.Begin("search");
  const Sweep coarse =
      MakeSweep(scans, kNumDirections, options.max_range_meters);
  const std::vector<Rigid2> poses =
      SearchPanoramas(map.viewpoints, map.rays.geometry().resolution, coarse,
                      static_cast<size_t>(options.num_registered_poses));
  clock.Begin("register coarsely");
  const std::vector<MeasuredSweep> likely =
      RegisterAll(options.candidate_weights, map.rays, coarse, kNumCoarseBeams,
                  kCoarseKernelScale, poses);
  clock.Begin("register finely");
  std::vector<ScanCandidate> candidates;
  for (const MeasuredSweep& measured :
       RegisterAll(options.candidate_weights, map.rays, sweep, kNoLimit,
                   kFineKernelScale, PosesOf(likely))) {
    candidates.push_back(
        CandidateOf(map.rays.geometry().T_submap_grid, measured));
  }
  clock.End();
  return candidates;
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

std::string Validate(const ScanLocalizationOptions& options) {
  for (const std::string& error :
       {Validate(options.viewpoints), Validate(options.candidate_weights),
        Validate(options.presence_weights)}) {
    if (!error.empty()) return error;
  }
  if (options.num_registered_poses < 1 ||
      options.num_registered_poses > 100'000) {
    return "num_registered_poses must lie between 1 and 100000";
  }
  if (options.min_num_beams < 5 ||
      options.min_num_beams > kNumMeasuredDirections) {
    return "min_num_beams must lie between 5 and 360";
  }
  if (!(options.max_range_meters > 0. && options.max_range_meters <= 1000.)) {
    return "max_range_meters must lie between 0 and 1000";
  }
  if (!(options.min_probability > 0.5 && options.min_probability < 1.)) {
    return "min_probability must lie between 0.5 and 1";
  }
  return "";
}

std::optional<PanoramaMap> MakePanoramaMap(
    const ViewpointOptions& options, const OccupancyGrid& grid,
    const std::vector<Eigen::Vector2d>& driven_positions) {
  std::optional<RayMap> rays = MakeRayMap(grid);
  if (!rays) return std::nullopt;
  const BoolArray reachable =
      ReachableCells(*rays, options.min_clearance_meters, driven_positions);
  if (!reachable.any()) return std::nullopt;
  Viewpoints viewpoints = MakeViewpoints(options, *rays, reachable);
  return PanoramaMap{*std::move(rays), std::move(viewpoints)};
}

ScanLocalization LocalizeScans(const ScanLocalizationOptions& options,
                               const PanoramaMap& map,
                               const std::vector<RobotScan>& scans) {
  CHECK_EQ(Validate(options), "");
  ScanLocalization result;
  const Sweep sweep =
      MakeSweep(scans, kNumMeasuredDirections, options.max_range_meters);
  const int num_echoes = NumEchoes(sweep);
  if (num_echoes < options.min_num_beams) {
    result.verdict = LocalizationVerdict::kTooLittleSeen;
    result.reason = absl::StrFormat(
        "there are echoes in %d directions, and it takes %d; %s", num_echoes,
        options.min_num_beams, Advice(sweep));
    return result;
  }
  result.candidates =
      FindCandidates(options, map, scans, sweep, &result.stage_seconds);
  if (result.candidates.empty()) {
    result.elsewhere_probability = 1.;
    result.reason = "no pose of the map has its echoes near walls";
    return result;
  }
  AssignProbabilities(options, &result);
  JudgeCandidates(options, sweep, &result);
  return result;
}

}  // namespace cartographer_sdf
