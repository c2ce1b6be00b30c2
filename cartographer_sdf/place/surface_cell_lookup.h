// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_PLACE_SURFACE_CELL_LOOKUP_H_
#define CARTOGRAPHER_SDF_PLACE_SURFACE_CELL_LOOKUP_H_

#include <Eigen/Core>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/place/surface_model.h"

namespace cartographer_sdf {

// Cells of a model under points of another frame.
class SurfaceCellLookup {
 public:
  // The model must outlive it.
  SurfaceCellLookup(const SurfaceModel& model, const Rigid2& T_model_points)
      : model_(model), cells_(model.cells.Pin()) {
    const Rigid2 T_grid_points =
        model.geometry.T_submap_grid.Inverse() * T_model_points;
    const double cells_per_meter = 1. / model.geometry.resolution;
    rotation_ = cells_per_meter * T_grid_points.RotationMatrix();
    translation_ = cells_per_meter * T_grid_points.translation();
  }

  // Null outside of the model; valid as long as the lookup.
  [[nodiscard]] const SurfaceCell* Find(const Eigen::Vector2d& point) const {
    const Eigen::Vector2d cell = rotation_ * point + translation_;
    if (!(cell.x() >= 0. && cell.y() >= 0. &&
          cell.x() < model_.geometry.size.x() &&
          cell.y() < model_.geometry.size.y())) {
      return nullptr;
    }
    return &(*cells_)(static_cast<Eigen::Index>(cell.x()),
                      static_cast<Eigen::Index>(cell.y()));
  }

 private:
  const SurfaceModel& model_;
  const PinnedCells cells_;
  Eigen::Matrix2d rotation_;
  Eigen::Vector2d translation_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PLACE_SURFACE_CELL_LOOKUP_H_
