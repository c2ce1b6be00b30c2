// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Which closures believe each other? Two closures and the odometry between
// their ends form a cycle; what it fails to close by is held against the
// uncertainty that odometry gathers on the way ([Mangelson2018]). Every pair of
// closures is checked, and those that contradict weightier ones are dropped.
//
// Far apart on the trajectory a cycle says nothing; near each other it tells
// true closures from look-alikes. A closure alone is never held against
// odometry: local SLAM may have torn the map where it matters most.

#ifndef CARTOGRAPHER_SDF_CLOSURE_CONSISTENCY_H_
#define CARTOGRAPHER_SDF_CLOSURE_CONSISTENCY_H_

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/closure/loop_closure.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/submap_id.h"

namespace cartographer_sdf {

struct ConsistencyOptions {
  // Standard deviations of odometry (local SLAM): of its rotation after one
  // metre, growing with the square root of the distance [rad / sqrt(m)] ...
  double rotation_sigma_per_sqrt_meter = 0.01;
  // ... and of its translation, as a fraction of the distance.
  double translation_sigma_per_meter = 0.01;
  // Of a closure, and of a submap's own shape [m], [rad].
  double closure_translation_sigma_meters = 0.15;
  double closure_rotation_sigma = 0.02;
  // A cycle is consistent when it closes within this many standard deviations
  // (Mahalanobis; 4.03 holds 99.9 % of true ones).
  double max_mahalanobis_distance = 4.03;
  // A cycle whose closing point is less certain than this is not asked [m].
  double max_cycle_sigma_meters = 1.;
  // A closure without support needs this score; log-odds.
  double min_unsupported_score = 5.;
  // Score of all consistent closures together that counts as support.
  double min_support = 8.;
};
[[nodiscard]] std::string Validate(const ConsistencyOptions& options);

// Where odometry says that a submap is, in its trajectory's local frame.
struct OdometryPose {
  Rigid2 T_local_submap;
  double distance_driven = 0.;  // up to the submap, along the trajectory [m]
};

enum class CycleVerdict { kConsistent, kInconsistent, kUninformative };

// The cycle of two closures: each pair of their ends is joined by odometry
// where it shares a trajectory; of the two ways to join them, the more certain.
// The same for either order of the two, and either direction of each.
[[nodiscard]] CycleVerdict CheckCycle(
    const ConsistencyOptions& options,
    const std::map<SubmapId, OdometryPose>& odometry, const LoopClosure& one,
    const LoopClosure& other);

enum class Selection {
  kSelected,
  kContradicted,  // by weightier closures
  kUnsupported,   // by no other, and not certain enough alone
};
// "selected", ...
[[nodiscard]] const char* SelectionName(Selection selection);

struct SelectionResult {
  Selection selection;
  double support = 0.;        // scores of the selected closures that agree
  double contradiction = 0.;  // scores of the selected ones that do not
};

// One result for each closure, in order; independent of the order. Quadratic
// in the number of closures.
[[nodiscard]] std::vector<SelectionResult> SelectConsistent(
    const ConsistencyOptions& options,
    const std::map<SubmapId, OdometryPose>& odometry,
    const std::vector<LoopClosure>& closures);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CLOSURE_CONSISTENCY_H_
