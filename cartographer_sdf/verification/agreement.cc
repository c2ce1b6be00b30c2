// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/agreement.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cartographer_sdf {
namespace {

// A sample of this size gives a half overlap to 2 %.
constexpr size_t kMaxNumOverlapPoints = 1000;

constexpr size_t kChunkSize = 64;

// Cells of a model under points of another frame.
class CellLookup {
 public:
  CellLookup(const SurfaceModel& model, const Rigid2& T_model_points)
      : model_(model) {
    const Rigid2 T_grid_points =
        model.geometry.T_submap_grid.Inverse() * T_model_points;
    const double cells_per_meter = 1. / model.geometry.resolution;
    rotation_ = cells_per_meter * T_grid_points.RotationMatrix();
    translation_ = cells_per_meter * T_grid_points.translation();
  }

  // Null outside of the model.
  [[nodiscard]] const SurfaceCell* Find(const Eigen::Vector2d& point) const {
    const Eigen::Vector2d cell = rotation_ * point + translation_;
    if (!(cell.x() >= 0. && cell.y() >= 0. &&
          cell.x() < model_.geometry.size.x() &&
          cell.y() < model_.geometry.size.y())) {
      return nullptr;
    }
    return &model_.cells(static_cast<Eigen::Index>(cell.x()),
                         static_cast<Eigen::Index>(cell.y()));
  }

 private:
  const SurfaceModel& model_;
  Eigen::Matrix2d rotation_;
  Eigen::Vector2d translation_;
};

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
  const CellLookup lookup(model, T_model_points);
  const double hit = options.hit_distance_meters;
  const double contradiction = options.contradiction_distance_meters;
  DirectedAgreement result;
  const size_t count = std::min(max_num_points, points.size());
  std::array<const SurfaceCell*, kChunkSize> cells;
  for (size_t begin = 0; begin < count; begin += kChunkSize) {
    const size_t size = std::min(kChunkSize, count - begin);
    // The cells lie far apart in memory: all are on their way before the first
    // is looked at.
    for (size_t k = 0; k < size; ++k) {
      cells[k] = lookup.Find(points[begin + k].position);
      __builtin_prefetch(cells[k]);
    }
    for (size_t k = 0; k < size; ++k) {
      if (cells[k] == nullptr) continue;
      const SurfaceCell& cell = *cells[k];
      const double weight =
          options.weigh_by_certainty ? points[begin + k].weight : 1.;
      const double distance = 1e-3 * std::abs(cell.distance);
      // Walls border on the unknown, so a hit may well lie in it.
      if (distance <= hit) {
        result.num_points += weight;
        result.hits += weight;
        result.squared_distance += weight * distance * distance;
      } else if (cell.observed) {
        result.num_points += weight;
        if (distance > contradiction) {
          result.contradictions +=
              weight * (options.weigh_by_certainty ? cell.free / 255. : 1.);
        }
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
  const CellLookup lookup(reference, T_reference_query);
  const size_t num_points =
      std::min(query.observed_points.size(), kMaxNumOverlapPoints);
  int count = 0;
  for (size_t k = 0; k < num_points; ++k) {
    const SurfaceCell* const cell = lookup.Find(query.observed_points[k]);
    count += cell != nullptr && cell->observed;
  }
  return count * query.area_per_observed_point *
         static_cast<double>(query.observed_points.size()) /
         static_cast<double>(num_points);
}

}  // namespace cartographer_sdf
