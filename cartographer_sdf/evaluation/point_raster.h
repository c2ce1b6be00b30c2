// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_EVALUATION_POINT_RASTER_H_
#define CARTOGRAPHER_SDF_EVALUATION_POINT_RASTER_H_

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace cartographer_sdf {

// Points sorted into squares, to find those around a place. Holds a reference
// to the points.
class PointRaster {
 public:
  // `radius` > 0 is the largest distance that will be asked for.
  PointRaster(const std::vector<Eigen::Vector2d>& points, const double radius)
      : points_(points), side_(radius) {
    for (size_t k = 0; k < points.size(); ++k) {
      squares_[Key(Square(points[k].x()), Square(points[k].y()))].push_back(
          static_cast<int>(k));
    }
  }

  // Calls `function(index)` for each point within the radius of `centre`, in an
  // order that depends on the points and the centre alone.
  template <typename Function>
  void ForEachNear(const Eigen::Vector2d& centre, const double radius,
                   const Function& function) const {
    const int64_t x = Square(centre.x());
    const int64_t y = Square(centre.y());
    for (int64_t j = y - 1; j <= y + 1; ++j) {
      for (int64_t i = x - 1; i <= x + 1; ++i) {
        const auto square = squares_.find(Key(i, j));
        if (square == squares_.end()) continue;
        for (const int k : square->second) {
          if ((points_[k] - centre).squaredNorm() <= radius * radius) {
            function(k);
          }
        }
      }
    }
  }

 private:
  [[nodiscard]] int64_t Square(const double coordinate) const {
    return static_cast<int64_t>(std::floor(coordinate / side_));
  }
  // Far squares may share a key; the distance tells their points apart.
  static uint64_t Key(const int64_t x, const int64_t y) {
    return (static_cast<uint64_t>(x) << 32) ^
           (static_cast<uint64_t>(y) & 0xffffffffu);
  }

  const std::vector<Eigen::Vector2d>& points_;
  const double side_;
  std::unordered_map<uint64_t, std::vector<int>> squares_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_POINT_RASTER_H_
