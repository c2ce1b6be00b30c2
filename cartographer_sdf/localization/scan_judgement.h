// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// How probable each pose is that explains what a robot sees, how probable it is
// that the robot is elsewhere, and what verdict follows.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_SCAN_JUDGEMENT_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_SCAN_JUDGEMENT_H_

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/localization/beam_evidence.h"
#include "cartographer_sdf/localization/localizer.h"

namespace cartographer_sdf {

// Which of the candidates is the right one, if one is: probabilities are
// proportional to the exponential of a sum of these terms. The weights, and
// those below, are learned on scans of several buildings in their own map and
// in others'; see scripts/measure_scan_localization.py.
struct CandidateWeights {
  double fit = 27.8;           // BeamEvidence::fit
  double loose_fit = -23.1;    // echoes near a wall, less their fit
  double log_through = -1.85;  // ln(0.03 + beams through walls)
  double log_free = -0.9;      // ln(0.03 + echoes in free space)
  double in_unknown = -8.3;    // beams that end in unknown space
};
[[nodiscard]] std::string Validate(const CandidateWeights& weights);

// Whether the right pose is among the candidates: the log-odds of it are the
// sum of these terms, of the best candidate.
struct PresenceWeights {
  double loose_fit = -22.4;
  double log_through = -1.27;
  double log_free = -0.08;
  double in_unknown = -4.1;
  double num_beams = 1.25;  // in turns, of one beam per degree
  // How much better it fits than what fits by chance: the sixth best candidate.
  double lead = 24.9;
  // Less than was learned by 0.3, as a wrong answer is worse than none: of
  // 2,134 scans of other buildings one was certain.
  double bias = -5.5;
};
[[nodiscard]] std::string Validate(const PresenceWeights& weights);

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

// The exponents of candidates' probabilities.
[[nodiscard]] double CandidateUtility(const CandidateWeights& weights,
                                      const BeamEvidence& evidence);

// Of at least one candidate, the best first; each with its evidence. Utilities
// are multiplied by the factor: more than one where the evidence is the mean of
// several looks.
void AssignProbabilities(const CandidateWeights& candidate_weights,
                         double utility_factor,
                         const PresenceWeights& presence_weights,
                         ScanLocalization* result);

// Of probabilities that were assigned, the most probable candidate first.
// `widest_gap` [rad]: of the field of view, see Sweep.
void JudgeCandidates(double min_probability, double widest_gap,
                     ScanLocalization* result);

// What would help a robot with this gap in its field of view.
[[nodiscard]] std::string AdviceForGap(double widest_gap);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_SCAN_JUDGEMENT_H_
