// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/report/reports.h"

namespace cartographer_sdf {
namespace {

constexpr size_t kMaxEchoes = 1500;
constexpr double kScanDegrees = 180. / M_PI;  // of a radian
// Less probable candidates are in the table only.
constexpr double kMinNamedProbability = 0.01;
// The map of a scan has no submaps: it is one.
constexpr SubmapId kWholeMap{0, 0};

std::vector<Eigen::Vector2d> EchoesOf(const std::vector<RobotScan>& scans) {
  std::vector<Eigen::Vector2d> echoes;
  for (const RobotScan& scan : scans) {
    for (const Eigen::Vector2f& point : scan.scan.returns) {
      const Eigen::Vector2d p_sensor = point.cast<double>();
      if (p_sensor.allFinite()) {
        echoes.push_back(scan.T_robot_sensor * p_sensor);
      }
    }
  }
  const size_t stride = 1 + echoes.size() / kMaxEchoes;
  std::vector<Eigen::Vector2d> kept;
  for (size_t k = 0; k < echoes.size(); k += stride) kept.push_back(echoes[k]);
  return kept;
}

std::string Percent(const double probability) {
  return absl::StrFormat("%.*f %%",
                         probability < 0.1 || probability > 0.99 ? 1 : 0,
                         100. * probability);
}

void JudgeScan(const std::string& map_name, const ScanLocalization& result,
               Inspection* const inspection) {
  if (result.verdict == LocalizationVerdict::kLocalized) {
    const ScanCandidate& best = result.candidates.front();
    inspection->tone = Tone::kGood;
    inspection->verdict = absl::StrFormat(
        "Localised: the robot stands at %s in %s, with a probability of %s.",
        FormatPose(best.T_map_robot), map_name, Percent(best.probability));
  } else {
    inspection->tone = Tone::kCaution;
    inspection->verdict =
        absl::StrCat("Not localised (", LocalizationVerdictName(result.verdict),
                     "): ", result.reason, ".");
  }
  inspection->numbers = {{"Answer", LocalizationVerdictName(result.verdict)},
                         {"Reason", result.reason}};
  if (result.elsewhere_probability) {
    inspection->numbers.emplace_back(
        "Probability of being elsewhere",
        absl::StrFormat("%.4f", *result.elsewhere_probability));
  }
  for (size_t k = 0; k < result.candidates.size(); ++k) {
    const ScanCandidate& candidate = result.candidates[k];
    if (k > 0 && candidate.probability < kMinNamedProbability) break;
    inspection->numbers.emplace_back(
        absl::StrCat("Candidate ", k + 1),
        absl::StrFormat("probability %.4f at %s", candidate.probability,
                        FormatPose(candidate.T_map_robot)));
  }
}

std::vector<Measure> CandidateMeasures(const ScanLocalizationOptions& options) {
  return {
      {"probability", "probability", "%", 2,
       "Of standing there; the probabilities of all candidates and of being "
       "elsewhere sum to 100 %.",
       true, Measure::Bound::kAtLeast, 100. * options.min_probability,
       "scan_localization.min_probability"},
      {"beams", "beams", "", 0, "That are compared, of one per degree.", false,
       Measure::Bound::kAtLeast, static_cast<double>(options.min_num_beams),
       "scan_localization.min_num_beams"},
      {"at_wall", "at walls", "%", 0, "Echoes at a wall of the map.", true},
      {"through_wall", "through walls", "%", 0,
       "Beams that cross a wall of the map: it is gone, or the pose is "
       "wrong.",
       true},
      {"in_free_space", "in free space", "%", 0,
       "Echoes in free space: something that is not in the map.", true},
      {"in_unknown", "in unknown space", "%", 0,
       "Beams that end where the map is unknown."},
      {"fit", "fit", "", 3,
       "How well the beams fit, on average: 1 for an echo on a wall, .6 at "
       "7 cm."},
      {"x_deviation", "standard deviation of x", "m", 3,
       "Large along what the scan does not hold."},
      {"y_deviation", "standard deviation of y", "m", 3,
       "Large along what the scan does not hold."},
      {"yaw_deviation", "standard deviation of the heading", "deg", 2, ""}};
}

InspectedRow RowOfCandidate(const ScanCandidate& candidate) {
  const BeamEvidence& evidence = candidate.evidence;
  InspectedRow row;
  row.T_map_robot = candidate.T_map_robot;
  row.values = {100. * candidate.probability,
                static_cast<double>(evidence.num_beams),
                100. * evidence.at_wall,
                100. * evidence.through_wall,
                100. * evidence.in_free_space,
                100. * evidence.in_unknown,
                evidence.fit,
                std::sqrt(candidate.covariance(0, 0)),
                std::sqrt(candidate.covariance(1, 1)),
                kScanDegrees * std::sqrt(candidate.covariance(2, 2))};
  return row;
}

InspectedTable ScanCandidateTable(const ScanLocalizationOptions& options,
                                  const ScanLocalization& result) {
  const std::string option = "scan_localization.min_probability";
  InspectedTable table{
      "candidates",
      "Candidates",
      "Arrows show where the robot may stand; dots are the echoes of its "
      "scan.",
      CandidateMeasures(options),
      {{"answer", "the answer", Tone::kGood, "It is certain.", ""},
       {"best", "best, but refused", Tone::kCaution,
        "The best of them, which is not certain.", option},
       {"other", "other", Tone::kNeutral, "Less probable than the best.",
        option}}};
  const bool is_certain = result.verdict == LocalizationVerdict::kLocalized;
  for (const ScanCandidate& candidate : result.candidates) {
    InspectedRow row = RowOfCandidate(candidate);
    row.status = !table.rows.empty() ? "other" : is_certain ? "answer" : "best";
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

absl::Status WriteScanReport(const ReportRequest& request,
                             const ScanLocalizationOptions& options,
                             const std::string& map_name,
                             const std::string& scan_name,
                             const OccupancyGrid& grid,
                             const std::vector<RobotScan>& scans,
                             const ScanLocalization& result) {
  Inspection inspection;
  inspection.title =
      absl::StrCat("Where in ", map_name, " was ", scan_name, " taken?");
  JudgeScan(map_name, result, &inspection);
  PoseGraph pose_graph;
  pose_graph.submap_poses[kWholeMap] = Rigid2();
  inspection.sessions = {{map_name}};
  inspection.states = {{"map", "Map", "The map", &pose_graph}};
  inspection.submaps[kWholeMap] = {grid.geometry, kWholeMap};
  inspection.tables = {ScanCandidateTable(options, result)};
  inspection.echoes = EchoesOf(scans);
  inspection.stage_seconds = result.stage_seconds;
  const absl::Status status = DrawInspection(
      request.options,
      [&grid](const SubmapCallback& on_submap) {
        on_submap(kWholeMap, {}, grid);
        return absl::OkStatus();
      },
      &inspection);
  if (!status.ok()) return status;
  return WriteInspector(request, inspection);
}

}  // namespace cartographer_sdf
