// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/agreement.h"

#include <algorithm>
#include <cmath>

namespace cartographer_sdf {
namespace {

// A sample of this size gives a half overlap to 2 %.
constexpr size_t kMaxNumOverlapPoints = 1000;

}  // namespace

std::string Validate(const AgreementOptions& options) {
  if (!(options.hit_distance_meters > 0. &&
        options.contradiction_distance_meters >= options.hit_distance_meters)) {
    return "hit_distance_meters must be positive and not above "
           "contradiction_distance_meters";
  }
  return "";
}

DirectedAgreement MeasureAgreement(const AgreementOptions& options,
                                   const SurfaceModel& model,
                                   const std::vector<SurfacePoint>& points,
                                   const Rigid2& T_model_points,
                                   const size_t max_num_points) {
  const CellGeometry& geometry = model.geometry;
  const Rigid2 T_grid_points =
      geometry.T_submap_grid.Inverse() * T_model_points;
  const Eigen::Matrix2d R = T_grid_points.RotationMatrix();
  const double hit = options.hit_distance_meters;
  const double contradiction = options.contradiction_distance_meters;
  DirectedAgreement result;
  const size_t count = std::min(max_num_points, points.size());
  for (size_t k = 0; k < count; ++k) {
    const SurfacePoint& wall = points[k];
    const Eigen::Vector2d p_grid =
        R * wall.position + T_grid_points.translation();
    const double x = std::floor(p_grid.x() / geometry.resolution);
    const double y = std::floor(p_grid.y() / geometry.resolution);
    if (!(x >= 0. && y >= 0. && x < geometry.size.x() &&
          y < geometry.size.y())) {
      continue;
    }
    const Eigen::Index i = static_cast<Eigen::Index>(x);
    const Eigen::Index j = static_cast<Eigen::Index>(y);
    const SurfaceCell& cell = model.cells(i, j);
    const double distance = 1e-3 * std::abs(cell.distance);
    // Walls border on the unknown, so a hit may well lie in it.
    if (distance <= hit) {
      result.num_points += wall.weight;
      result.hits += wall.weight;
      result.squared_distance += wall.weight * distance * distance;
    } else if (cell.observed) {
      result.num_points += wall.weight;
      if (distance > contradiction) {
        result.contradictions += wall.weight * cell.free / 255.;
      }
    }
  }
  return result;
}

DirectedAgreement MeasureAgreement(const AgreementOptions& options,
                                   const SurfaceModel& model,
                                   const SurfaceModel& points,
                                   const Rigid2& T_model_points,
                                   const size_t max_num_points) {
  return MeasureAgreement(options, model, points.walls, T_model_points,
                          max_num_points);
}

double OverlapArea(const SurfaceModel& reference, const SurfaceModel& query,
                   const Rigid2& T_reference_query) {
  const CellGeometry& geometry = reference.geometry;
  const Rigid2 T_grid_query =
      geometry.T_submap_grid.Inverse() * T_reference_query;
  const Eigen::Matrix2d R = T_grid_query.RotationMatrix();
  int count = 0;
  const size_t num_points =
      std::min(query.observed_points.size(), kMaxNumOverlapPoints);
  for (size_t k = 0; k < num_points; ++k) {
    const Eigen::Vector2d& point = query.observed_points[k];
    const Eigen::Array2i cell =
        ((R * point + T_grid_query.translation()).array() / geometry.resolution)
            .floor()
            .cast<int>();
    count +=
        geometry.Contains(cell) && reference.cells(cell.x(), cell.y()).observed;
  }
  return count * query.area_per_observed_point *
         static_cast<double>(query.observed_points.size()) /
         static_cast<double>(num_points);
}

}  // namespace cartographer_sdf
