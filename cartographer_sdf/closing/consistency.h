// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Selects a mutually consistent set of closures. Two closures and the odometry
// between their ends form a cycle; its closing error is compared with the
// uncertainty that odometry accumulates on the way ([Mangelson2018]). Every
// pair of closures whose cycle can say something is checked, and those that
// contradict weightier ones are dropped.
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
  // Of a closure, including the distortion of its submaps [m], [rad].
  double closure_translation_sigma_meters = 0.15;
  double closure_rotation_sigma = 0.02;
  // A cycle is consistent when it closes within this many standard deviations
  // (Mahalanobis distance; 4.03 accepts 99.9 % of true ones).
  double max_mahalanobis_distance = 4.03;
  // A cycle is not tested if the standard deviation of its end point is larger
  // [m].
  double max_cycle_sigma_meters = 1.;
  // Least score of a closure without support; log-odds.
  double min_unsupported_score = 5.;
  // Least total score of all consistent closures that counts as support.
  double min_support = 8.;
};
[[nodiscard]] std::string Validate(const ConsistencyOptions& options);

// Returns the standard deviation of odometry's translation after driving
// `driven` metres [m].
[[nodiscard]] double DriftSigma(const ConsistencyOptions& options,
                                double driven);

enum class CycleVerdict { kUninformative, kConsistent, kInconsistent };

// Checks the cycle of two closures. Odometry joins a pair of their ends if both
// lie on one trajectory; of the two ways to join them, the more certain counts.
// Independent of the order of the two closures and of the direction of each.
[[nodiscard]] CycleVerdict CheckCycle(
    const ConsistencyOptions& options,
    const std::map<SubmapId, OdometryPose>& odometry, const PairPose& one,
    const PairPose& other);

enum class Selection {
  kSelected,
  kInconsistent,  // weightier closures contradict it
  kUnsupported,   // no other supports it, and its own score is too low
};

struct SelectionResult {
  Selection selection;
  double support = 0.;        // total score of selected closures that agree
  double contradiction = 0.;  // total score of those that disagree
};

// The verdicts on all pairs of a set of closures. Closures with a negative
// score have zero weight.
class VerdictTable {
 public:
  // `closures` must outlive the table; `check` must be symmetric.
  VerdictTable(const std::vector<PairPose>& closures,
               const std::function<CycleVerdict(const PairPose&,
                                                const PairPose&)>& check);

  // Returns support and contradiction of closure k by `others`; skips k itself.
  [[nodiscard]] SelectionResult Weigh(size_t k,
                                      const std::vector<size_t>& others) const;
  // Returns support minus contradiction.
  [[nodiscard]] double Support(size_t k,
                               const std::vector<size_t>& others) const;
  // Returns the indices of the closures by decreasing weight, score plus
  // support by all others, as later ones are judged against earlier ones.
  // Independent of the input order.
  [[nodiscard]] std::vector<size_t> InOrderOfWeight() const;

 private:
  const std::vector<PairPose>& closures_;
  std::vector<CycleVerdict> verdicts_;
};

// Returns one result per closure, in order; results do not depend on that
// order. Each closure is only compared with its partners (cycle_partners.h), so
// that the time is linear in the number of closures.
[[nodiscard]] std::vector<SelectionResult> SelectConsistent(
    const ConsistencyOptions& options,
    const std::map<SubmapId, OdometryPose>& odometry,
    const std::vector<PairPose>& closures);

// SelectConsistent for pairs whose reference lies in one map and whose query in
// another, joined by the odometry of each map. Trajectories of the two maps are
// distinct even if their ids are equal.
[[nodiscard]] std::vector<SelectionResult> SelectConsistentBetween(
    const ConsistencyOptions& options,
    const std::map<SubmapId, OdometryPose>& reference_odometry,
    const std::map<SubmapId, OdometryPose>& query_odometry,
    const std::vector<PairPose>& pairs);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CLOSING_CONSISTENCY_H_
