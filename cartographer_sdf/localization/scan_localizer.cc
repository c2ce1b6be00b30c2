// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/scan_localizer.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/execution/stage_clock.h"
#include "cartographer_sdf/geometry/distinct_poses.h"
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
    measured.push_back(
        {*registered, evidence, CandidateUtility(weights, evidence)});
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

std::vector<Rigid2> PosesOf(const std::vector<MeasuredSweep>& sweeps) {
  std::vector<Rigid2> T_grid_robot;
  for (const MeasuredSweep& sweep : sweeps) {
    T_grid_robot.push_back(sweep.registered.T_grid_robot);
  }
  return T_grid_robot;
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

// Registers likely poses with all beams of the sweep.
std::vector<ScanCandidate> RegisterLikely(
    const ScanLocalizationOptions& options, const PanoramaMap& map,
    const Sweep& sweep, const std::vector<Rigid2>& T_grid_robot) {
  std::vector<ScanCandidate> candidates;
  for (const MeasuredSweep& measured :
       RegisterAll(options.candidate_weights, map.rays, sweep, kNoLimit,
                   kFineKernelScale, T_grid_robot)) {
    candidates.push_back(
        CandidateOf(map.rays.geometry().T_submap_grid, measured));
  }
  return candidates;
}

}  // namespace

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
  if (options.num_echo_poses < 0 || options.num_echo_poses > 10'000) {
    return "num_echo_poses must lie between 0 and 10000";
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
  return MakePanoramaMap(*std::move(rays), std::move(viewpoints));
}

PanoramaMap MakePanoramaMap(RayMap rays, Viewpoints viewpoints) {
  EchoMap echoes = MakeEchoMap(rays, viewpoints);
  return {std::move(rays), std::move(viewpoints), std::move(echoes)};
}

std::vector<Rigid2> FindLikelyPoses(
    const ScanLocalizationOptions& options, const PanoramaMap& map,
    const std::vector<RobotScan>& scans,
    std::vector<std::pair<std::string, double>>* const stage_seconds) {
  StageClock clock({}, stage_seconds);
  clock.Begin("search panoramas");
  const Sweep coarse =
      MakeSweep(scans, kNumDirections, options.max_range_meters);
  std::vector<Rigid2> poses =
      SearchPanoramas(map.viewpoints, map.rays.geometry().resolution, coarse,
                      static_cast<size_t>(options.num_registered_poses));
  clock.Begin("search echoes");
  const std::vector<Rigid2> by_echoes = SearchEchoes(
      map.echoes, coarse, static_cast<size_t>(options.num_echo_poses));
  poses.insert(poses.end(), by_echoes.begin(), by_echoes.end());
  clock.Begin("register coarsely");
  std::vector<Rigid2> likely =
      PosesOf(RegisterAll(options.candidate_weights, map.rays, coarse,
                          kNumCoarseBeams, kCoarseKernelScale, poses));
  clock.End();
  return likely;
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
        options.min_num_beams, AdviceForGap(sweep.widest_gap));
    return result;
  }
  const std::vector<Rigid2> likely =
      FindLikelyPoses(options, map, scans, &result.stage_seconds);
  StageClock clock({}, &result.stage_seconds);
  clock.Begin("register finely");
  result.candidates = RegisterLikely(options, map, sweep, likely);
  clock.End();
  if (result.candidates.empty()) {
    result.elsewhere_probability = 1.;
    result.reason = "no pose of the map has its echoes near walls";
    return result;
  }
  AssignProbabilities(options.candidate_weights, /*utility_factor=*/1.,
                      options.presence_weights, &result);
  JudgeCandidates(options.min_probability, sweep.widest_gap, &result);
  return result;
}

}  // namespace cartographer_sdf
