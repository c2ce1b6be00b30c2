// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// How well the walls of two submaps agree with each other's walls and free
// space under a pose.

#ifndef CARTOGRAPHER_SDF_VERIFICATION_AGREEMENT_H_
#define CARTOGRAPHER_SDF_VERIFICATION_AGREEMENT_H_

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/place/surface_model.h"

namespace cartographer_sdf {

struct AgreementOptions {
  // A wall point this near to a wall of the other submap is a hit [m].
  double hit_distance_meters = 0.15;
  // A wall point in the other's free space, farther than this from its walls,
  // is a contradiction [m]. Between the two it is neither.
  double contradiction_distance_meters = 0.25;
  // Whether points and cells count by how certainly they are occupied or free.
  bool weigh_by_certainty = true;
  // Wall points used of each submap. Larger: more precise, slower.
  int max_num_points = 2000;
};
[[nodiscard]] std::string Validate(const AgreementOptions& options);

// Sums over the wall points of one submap, each weighted by its certainty.
struct DirectedAgreement {
  double num_points = 0.;  // within what the other submap has observed
  double hits = 0.;
  // Weighted also by the certainty that the other's cell is free.
  double contradictions = 0.;
  double squared_distance = 0.;  // of the hits [m^2]

  [[nodiscard]] double HitRatio() const {
    return num_points > 0. ? hits / num_points : 0.;
  }
  [[nodiscard]] double ContradictionRatio() const {
    return num_points > 0. ? contradictions / num_points : 0.;
  }
};

// Of points in a frame of their own, taken by T_model_points into `model`.
[[nodiscard]] DirectedAgreement MeasureAgreement(
    const AgreementOptions& options, const SurfaceModel& model,
    const std::vector<SurfacePoint>& points, const Rigid2& T_model_points);

// A long wall, or a cupboard scanned from near, is many points and yet one
// fact. On tiles of 2 m each stretch of wall counts once.
struct TileAgreement {
  // Tiles that hold wall of one submap within what the other has observed; a
  // tile with less than some 0.4 m of wall counts in part.
  double num_tiles = 0.;
  // Mean of the tiles' hit ratios.
  double mean_hit_ratio = 0.;
};

// Of all wall points of two submaps: each in the other, and both on tiles of
// the reference frame.
struct PairAgreement {
  DirectedAgreement query_in_reference;
  DirectedAgreement reference_in_query;
  TileAgreement tiles;
};
[[nodiscard]] PairAgreement MeasurePairAgreement(
    const AgreementOptions& options, const SurfaceModel& reference,
    const SurfaceModel& query, const Rigid2& T_reference_query);

// Area observed by both [m^2], from a sample of the query's observed points: a
// thousand give a half overlap to 2 %.
constexpr int kMaxNumOverlapPoints = 1000;
[[nodiscard]] double OverlapArea(const SurfaceModel& reference,
                                 const SurfaceModel& query,
                                 const Rigid2& T_reference_query,
                                 int max_num_points = kMaxNumOverlapPoints);

// Whether OverlapArea would return at least `min_area` [m^2]. Looks at no more
// points than it takes to know.
[[nodiscard]] bool OverlapsBy(double min_area, const SurfaceModel& reference,
                              const SurfaceModel& query,
                              const Rigid2& T_reference_query,
                              int max_num_points = kMaxNumOverlapPoints);

// Whether the two overlap enough at the pose to judge whether they agree: by
// two fifths of the smaller observed area.
[[nodiscard]] bool OverlapsEnough(const SurfaceModel& reference,
                                  const SurfaceModel& query,
                                  const Rigid2& T_reference_query);

// The centroid of what both observed in the query frame [m]; none where nothing
// is observed by both.
[[nodiscard]] std::optional<Eigen::Vector2d> OverlapCentroid(
    const SurfaceModel& reference, const SurfaceModel& query,
    const Rigid2& T_reference_query);

// The tiles of this edge length [m] that hold points observed by both, in a
// frame in which the reference has this pose. From as many points as the
// overlap.
using TileIndex = std::pair<int, int>;
[[nodiscard]] std::set<TileIndex> OverlapTiles(const SurfaceModel& reference,
                                               const SurfaceModel& query,
                                               const Rigid2& T_reference_query,
                                               const Rigid2& T_frame_reference,
                                               double tile_size);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_VERIFICATION_AGREEMENT_H_
