// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/ray_map.h"

#include <algorithm>
#include <cmath>

#include "cartographer_sdf/field/distance_transform.h"

namespace cartographer_sdf {
namespace {

constexpr double kMinUnknownGap = 0.3;  // [m]
// A ray that meets a wall at a flatter angle grazes it; the sine of the angle.
constexpr double kGrazingSine = 0.3;
// A ray that grazes a wall leaves it again within this distance [m].
constexpr double kMaxGrazedLength = 0.4;
// Steps where something that is not free is next to the ray [cells]: a wall of
// one cell is not missed but where a ray cuts off its corner.
constexpr double kShortStep = 0.5;

// Whether a ray that meets a wall at `t` came along it: it was near the wall
// before.
bool Grazes(const RayMap& map, const Eigen::Vector2d& begin,
            const Eigen::Vector2d& direction, const double t) {
  constexpr double kLookBack = 0.3;  // [m]
  const double resolution = map.geometry().resolution;
  const Eigen::Vector2d before =
      begin + (t - kLookBack / resolution) * direction;
  const Eigen::Array2i cell = before.array().floor().cast<int>();
  if (!map.geometry().Contains(cell)) return false;
  return map.field.distance(cell.x(), cell.y()) < kGrazingSine * kLookBack;
}

}  // namespace

std::optional<RayMap> MakeRayMap(const OccupancyGrid& grid) {
  std::optional<DistanceField> field = MakeDistanceField(FieldOptions(), grid);
  if (!field) return std::nullopt;
  const BoolArray is_wall = field->distance < 0.f;
  const BoolArray is_blocked = is_wall || !field->observed;
  if (is_blocked.all()) return std::nullopt;
  RayMap map;
  map.steps.resize(is_wall.rows(), is_wall.cols());
  VisitSquaredDistances(
      is_blocked, [&](const Eigen::Index j, const int* const squared) {
        for (Eigen::Index i = 0; i < is_wall.rows(); ++i) {
          if (squared[i] == 0) {
            map.steps(i, j) = is_wall(i, j) ? RayMap::kWall : RayMap::kUnknown;
            continue;
          }
          // From a corner of the cell to a corner of the other.
          const float gap = std::sqrt(static_cast<float>(squared[i])) - 1.4143f;
          map.steps(i, j) = static_cast<uint8_t>(std::clamp(gap, 0.f, 250.f));
        }
      });
  map.field = *std::move(field);
  return map;
}

Ray CastRay(const RayMap& map, const Eigen::Vector2d& begin,
            const Eigen::Vector2d& direction, const double max_range,
            const bool stops_at_grazed) {
  const double resolution = map.geometry().resolution;
  const double min_gap = kMinUnknownGap / resolution;
  double unknown_since = -1., grazed_since = -1.;
  double t = 0.;
  while (t < max_range) {
    const double x = begin.x() + t * direction.x();
    const double y = begin.y() + t * direction.y();
    const bool is_inside = x >= 0. && y >= 0. &&
                           x < static_cast<double>(map.steps.rows()) &&
                           y < static_cast<double>(map.steps.cols());
    const Eigen::Index i = static_cast<Eigen::Index>(x);
    const Eigen::Index j = static_cast<Eigen::Index>(y);
    const uint8_t step = is_inside ? map.steps(i, j) : RayMap::kUnknown;
    if (step == RayMap::kWall) {
      if (stops_at_grazed) return {t, RayEnd::kWall};
      if (grazed_since < 0.) {
        if (!Grazes(map, begin, direction, t)) return {t, RayEnd::kWall};
        grazed_since = t;
      } else if (t - grazed_since > kMaxGrazedLength / resolution) {
        return {grazed_since, RayEnd::kWall};
      }
      t += kShortStep;
    } else if (step == RayMap::kUnknown) {
      if (unknown_since < 0.) unknown_since = t;
      if (!is_inside || t - unknown_since >= min_gap) {
        return {unknown_since, RayEnd::kUnknown};
      }
      t += kShortStep;
    } else {
      unknown_since = grazed_since = -1.;
      t += std::max<double>(step, kShortStep);
    }
  }
  return {max_range, RayEnd::kOpen};
}

}  // namespace cartographer_sdf
