// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// How well the walls of two submaps agree with each other's walls and free
// space under a pose.

#ifndef CARTOGRAPHER_SDF_VERIFICATION_AGREEMENT_H_
#define CARTOGRAPHER_SDF_VERIFICATION_AGREEMENT_H_

#include <string>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/verification/surface_model.h"

namespace cartographer_sdf {

struct AgreementOptions {
  // A wall point this near to a wall of the other submap is a hit [m].
  double hit_distance_meters = 0.15;
  // A wall point in the other's free space, farther than this from its walls,
  // is a contradiction [m]. Between the two it is neither.
  double contradiction_distance_meters = 0.25;
  // Whether points and cells count by how surely they are occupied or free.
  bool weigh_by_certainty = true;
};
[[nodiscard]] std::string Validate(const AgreementOptions& options);

// Sums over the wall points of one submap, weighted by how surely they are
// occupied.
struct DirectedAgreement {
  double num_points = 0.;  // within what the other submap has observed
  double hits = 0.;
  // Weighted too by how surely the other's cell is free.
  double contradictions = 0.;
  double squared_distance = 0.;  // of the hits [m^2]

  [[nodiscard]] double HitRatio() const {
    return num_points > 0. ? hits / num_points : 0.;
  }
  [[nodiscard]] double ContradictionRatio() const {
    return num_points > 0. ? contradictions / num_points : 0.;
  }
};

// The first `max_num_points` wall points of `points`, taken by T_model_points
// into `model`.
[[nodiscard]] DirectedAgreement MeasureAgreement(
    const AgreementOptions& options, const SurfaceModel& model,
    const SurfaceModel& points, const Rigid2& T_model_points,
    size_t max_num_points);

// The same for points that are not a submap's, such as a scan's.
[[nodiscard]] DirectedAgreement MeasureAgreement(
    const AgreementOptions& options, const SurfaceModel& model,
    const std::vector<SurfacePoint>& points, const Rigid2& T_model_points,
    size_t max_num_points);

// Wall points crowd: a long wall, or a cupboard scanned from near, is many
// points and yet one fact. On squares of 2 m each place counts once.
struct TileAgreement {
  // Squares that hold wall of one submap within what the other has observed;
  // those that hold less than some 0.4 m of it in part.
  double num_tiles = 0.;
  // Mean of the squares' hit ratios.
  double mean_hit_ratio = 0.;
};

// By the wall points of both submaps, at most `max_num_points` of each. Squares
// are those of the reference frame.
[[nodiscard]] TileAgreement MeasureTileAgreement(
    const AgreementOptions& options, const SurfaceModel& reference,
    const SurfaceModel& query, const Rigid2& T_reference_query,
    size_t max_num_points);

// Area observed by both [m^2], by a sample of the query's observed points.
[[nodiscard]] double OverlapArea(const SurfaceModel& reference,
                                 const SurfaceModel& query,
                                 const Rigid2& T_reference_query);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_VERIFICATION_AGREEMENT_H_
