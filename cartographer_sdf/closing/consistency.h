// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Selects a mutually consistent set of closures. Two closures and the odometry
// between their ends form a cycle; the error by which it fails to close is held
// against the uncertainty that odometry gathers on the way ([Mangelson2018]).
// Every pair of closures is checked, and those that contradict weightier ones
// are dropped.
//
// The cycle of two closures far apart on the trajectory is uninformative; that
// of two near each other separates true closures from perceptual aliasing. A
// single closure is never compared with odometry: local SLAM may have torn the
// map where the closure matters most.

#ifndef CARTOGRAPHER_SDF_CLOSING_CONSISTENCY_H_
#define CARTOGRAPHER_SDF_CLOSING_CONSISTENCY_H_

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "cartographer_sdf/grid/pair_pose.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/place/trajectory_places.h"

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
  // A cycle whose end point is less certain than this is not tested [m].
  double max_cycle_sigma_meters = 1.;
  // A closure without support needs this score; log-odds.
  double min_unsupported_score = 5.;
  // Score of all consistent closures together that counts as support.
  double min_support = 8.;
};
[[nodiscard]] std::string Validate(const ConsistencyOptions& options);

// Standard deviation of the translation by odometry after so much driving [m].
[[nodiscard]] double DriftSigma(const ConsistencyOptions& options,
                                double driven);

enum class CycleVerdict { kUninformative, kConsistent, kInconsistent };

// The cycle of two closures: each pair of their ends is joined by odometry
// where it shares a trajectory; of the two ways to join them, the more certain.
// The same for either order of the two, and either direction of each.
[[nodiscard]] CycleVerdict CheckCycle(
    const ConsistencyOptions& options,
    const std::map<SubmapId, OdometryPose>& odometry, const PairPose& one,
    const PairPose& other);

enum class Selection {
  kSelected,
  kInconsistent,  // weightier closures contradict it
  kUnsupported,   // no other supports it, and it is not certain alone
};

struct SelectionResult {
  Selection selection;
  double support = 0.;        // scores of the selected closures that agree
  double contradiction = 0.;  // scores of the selected ones that do not
};

// What each two of several closures say of each other. A score below zero
// counts as none.
class VerdictTable {
 public:
  // `closures` outlives it; `check` is the same for either order of the two.
  VerdictTable(const std::vector<PairPose>& closures,
               const std::function<CycleVerdict(const PairPose&,
                                                const PairPose&)>& check);

  // Support and contradiction of closure k by the others; k itself is passed
  // over.
  [[nodiscard]] SelectionResult Weigh(size_t k,
                                      const std::vector<size_t>& others) const;
  // The one less the other.
  [[nodiscard]] double Support(size_t k,
                               const std::vector<size_t>& others) const;
  // The closures that most others support come first, and set the frame in
  // which later ones are judged. The same whatever the order given.
  [[nodiscard]] std::vector<size_t> InOrderOfWeight() const;

 private:
  const std::vector<PairPose>& closures_;
  std::vector<CycleVerdict> verdicts_;
};

// One result for each closure, in order; independent of the order. Quadratic
// in the number of closures.
[[nodiscard]] std::vector<SelectionResult> SelectConsistent(
    const ConsistencyOptions& options,
    const std::map<SubmapId, OdometryPose>& odometry,
    const std::vector<PairPose>& closures);

// SelectConsistent for pairs whose reference lies in one map and whose query in
// another, joined by the odometry of each. Trajectories of the two maps are
// different ones even where their ids are equal.
[[nodiscard]] std::vector<SelectionResult> SelectConsistentBetween(
    const ConsistencyOptions& options,
    const std::map<SubmapId, OdometryPose>& reference_odometry,
    const std::map<SubmapId, OdometryPose>& query_odometry,
    const std::vector<PairPose>& pairs);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CLOSING_CONSISTENCY_H_
