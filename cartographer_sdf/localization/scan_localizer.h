// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Where in a map is a robot that stands still, by one scan or a few: all poses
// that explain them, each with its probability, and the probability that the
// robot is elsewhere, where the map never was.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_SCAN_LOCALIZER_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_SCAN_LOCALIZER_H_

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/grid/scan.h"
#include "cartographer_sdf/localization/beam_evidence.h"
#include "cartographer_sdf/localization/localizer.h"
#include "cartographer_sdf/localization/ray_map.h"
#include "cartographer_sdf/localization/viewpoints.h"

namespace cartographer_sdf {

// Which of the candidates is the right one, if one is: probabilities are
// proportional to the exponential of a sum of these terms. The weights, and
// those below, are learned on scans of several buildings in their own map and
// in others'; see scripts/measure_scan_localization.py.
struct CandidateWeights {
  double fit = 31.8;           // BeamEvidence::fit
  double loose_fit = -16.5;    // echoes near a wall, less their fit
  double log_through = -1.98;  // ln(0.03 + beams through walls)
  double log_free = -0.92;     // ln(0.03 + echoes in free space)
  double in_unknown = -4.1;    // beams that end in unknown space
};
[[nodiscard]] std::string Validate(const CandidateWeights& weights);

// Whether the right pose is among the candidates: the log-odds of it are the
// sum of these terms, of the best candidate.
struct PresenceWeights {
  double loose_fit = -19.3;
  double log_through = -1.71;
  double log_free = -0.34;
  double in_unknown = -7.85;
  double num_beams = 1.88;  // in turns, of one beam per degree
  // How much better it fits than what fits by chance: the sixth best candidate.
  double lead = 24.3;
  double bias = -7.5;
};
[[nodiscard]] std::string Validate(const PresenceWeights& weights);

struct ScanLocalizationOptions {
  ViewpointOptions viewpoints;
  // Poses of the search that are registered. Larger: slower, and less likely
  // that the right one is missed.
  int num_registered_poses = 200;
  // Fewer beams, of one per degree, show too little.
  int min_num_beams = 30;
  // Points farther from the sensor are left out [m].
  double max_range_meters = 60.;
  CandidateWeights candidate_weights;
  PresenceWeights presence_weights;
  // Least probability of a pose that is certain.
  double min_probability = 0.99;
};
[[nodiscard]] std::string Validate(const ScanLocalizationOptions& options);

// What localising scans needs of a map, computed once.
struct PanoramaMap {
  RayMap rays;
  Viewpoints viewpoints;
};

// The grid's submap frame is the map frame. `driven_positions` [m, map frame]:
// see ReachableCells(). Nullopt where the map has no wall or no place for a
// robot.
[[nodiscard]] std::optional<PanoramaMap> MakePanoramaMap(
    const ViewpointOptions& options, const OccupancyGrid& grid,
    const std::vector<Eigen::Vector2d>& driven_positions);

struct ScanCandidate {
  Rigid2 T_map_robot;
  double probability = 0.;
  // Of x, y [m^2] and the heading [rad^2], map frame, about the sensors: large
  // along what the scan does not hold.
  Eigen::Matrix3d covariance;
  BeamEvidence evidence;
};

struct ScanLocalization {
  LocalizationVerdict verdict = LocalizationVerdict::kNothingAlike;
  // Human-readable; a refusal says how near it was and what would help.
  std::string reason;
  // Distinct poses (0.5 m or 10 degrees apart), the most probable first,
  // whatever the verdict. Their probabilities and that of being elsewhere sum
  // to one.
  std::vector<ScanCandidate> candidates;
  // None where too little was seen to search.
  std::optional<double> elsewhere_probability;
  std::vector<std::pair<std::string, double>> stage_seconds;
};

// Of scans from one place. Deterministic; uses one thread.
[[nodiscard]] ScanLocalization LocalizeScans(
    const ScanLocalizationOptions& options, const PanoramaMap& map,
    const std::vector<RobotScan>& scans);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_SCAN_LOCALIZER_H_
