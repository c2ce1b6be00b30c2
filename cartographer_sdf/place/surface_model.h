// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The surface of a submap as verification needs it: its distance field, how
// certainly each cell is free, and its walls as weighted points.

#ifndef CARTOGRAPHER_SDF_PLACE_SURFACE_MODEL_H_
#define CARTOGRAPHER_SDF_PLACE_SURFACE_MODEL_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "cartographer_sdf/field/distance_field.h"
#include "cartographer_sdf/place/surface_cells.h"

namespace cartographer_sdf {

struct SurfacePoint {
  Eigen::Vector2d position;  // centre of an occupied cell, submap frame [m]
  double weight;             // how surely it is occupied, in (0, 1]
};

struct SurfaceModel {
  CellGeometry geometry;  // of the distance field
  SurfaceCells cells;     // one for each of its cells
  // In a fixed pseudo-random order: the first n are a fair sample of all.
  std::vector<SurfacePoint> walls;
  // Centres of a fair sample of the observed cells, submap frame [m], and the
  // area that each stands for [m^2].
  std::vector<Eigen::Vector2d> observed_points;
  double area_per_observed_point = 0.;
  // Poses other than the identity in which the submap resembles itself: the
  // half turn of a symmetric room, shifts along a row of equal doors. Filled in
  // by FindSelfSimilarities (recognition/match.h).
  std::vector<Rigid2> self_similar_poses;
};

// `field` is the distance field of `grid`. None where the grid has no wall or
// nothing is observed.
[[nodiscard]] std::optional<SurfaceModel> MakeSurfaceModel(
    const FieldOptions& options, const OccupancyGrid& grid,
    const DistanceField& field);
[[nodiscard]] std::optional<SurfaceModel> MakeSurfaceModel(
    const FieldOptions& options, const OccupancyGrid& grid);

// Area that the submap has observed [m^2], and its centroid in the submap
// frame: the one "middle" of a submap.
[[nodiscard]] double ObservedArea(const SurfaceModel& model);
[[nodiscard]] Eigen::Vector2d ObservedCentroid(const SurfaceModel& model);

// As SampleField, to half a millimetre, in continuous cell coordinates; `cells`
// are those of a model of that geometry.
[[nodiscard]] inline std::optional<FieldSample> SampleSurface(
    const CellGeometry& geometry, const SurfaceCellArray& cells,
    const Eigen::Vector2d& point) {
  return InterpolateField(geometry, point,
                          [&cells](const Eigen::Index i, const Eigen::Index j) {
                            return 1e-3 * cells(i, j).distance;
                          });
}

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PLACE_SURFACE_MODEL_H_
