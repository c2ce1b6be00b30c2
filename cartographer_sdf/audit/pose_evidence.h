// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What the walls and the free space of two submaps say of a pose that somebody
// else claims.

#ifndef CARTOGRAPHER_SDF_AUDIT_POSE_EVIDENCE_H_
#define CARTOGRAPHER_SDF_AUDIT_POSE_EVIDENCE_H_

#include <Eigen/Core>
#include <optional>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/verification/surface_model.h"
#include "cartographer_sdf/verification/verification.h"

namespace cartographer_sdf {

// A middle of what a submap has observed, in its frame [m].
[[nodiscard]] Eigen::Vector2d MiddleOf(const SurfaceModel& model);

struct PoseEvidence {
  // The claimed pose, registered; as claimed where the walls do not hold it
  // near there.
  Rigid2 T_reference_query;
  // How far registration moves the middle of the query [m], [rad]; none where
  // it finds no pose.
  std::optional<double> shift;
  std::optional<double> turn;
  bool is_held = false;
  Agreement agreement;
  // Of the score without the margin, to the best distinct pose of the same
  // pair: negative where another pose is better. At most kMaxMargin.
  double margin = 0.;
  // Log-odds of being right, as verification scores matches.
  double score = 0.;
  // Where recognition, which is not told the claim, would put the query; none
  // where it would not say.
  std::optional<Rigid2> recognized_T_reference_query;
};

// Registers the claimed pose and judges it as verification judges a match.
// `recognized`, what MatchPlaces says of the pair, is among the rivals. A claim
// that registration moves by more than these [m], [rad] is not held by the
// walls. Some milliseconds.
[[nodiscard]] PoseEvidence ExaminePose(const VerificationOptions& options,
                                       double max_shift, double max_turn,
                                       const SurfaceModel& reference,
                                       const SurfaceModel& query,
                                       const std::optional<Match>& recognized,
                                       const Rigid2& claimed_T_reference_query);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_AUDIT_POSE_EVIDENCE_H_
