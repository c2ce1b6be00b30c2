// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Worlds whose distance to walls is a formula, and grids that sample them from
// wherever one likes.

#ifndef TEST_TESTING_WORLD_H_
#define TEST_TESTING_WORLD_H_

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "cartographer_sdf/grid/occupancy_grid.h"
#include "test/testing/random_number.h"

namespace cartographer_sdf::testing {

// Signed distance of a point to the nearest wall [m]: positive in free space,
// negative in walls. Exact for one shape; where several meet the sign is exact
// and the magnitude a lower bound.
using World = std::function<double(const Eigen::Vector2d& p_world)>;

inline World SolidDisc(const Eigen::Vector2d& centre, const double radius) {
  return [=](const Eigen::Vector2d& p) { return (p - centre).norm() - radius; };
}

// Free where the point is farther than `offset` in the given direction.
inline World SolidHalfPlane(const double direction, const double offset) {
  const Eigen::Vector2d normal(std::cos(direction), std::sin(direction));
  return [=](const Eigen::Vector2d& p) { return normal.dot(p) - offset; };
}

inline World SolidBox(const Eigen::Vector2d& centre,
                      const Eigen::Vector2d& size, const double angle = 0.) {
  const Rigid2 T_box_world = Rigid2(centre, angle).Inverse();
  return [=](const Eigen::Vector2d& p) {
    const Eigen::Array2d q =
        (T_box_world * p).array().abs() - 0.5 * size.array();
    return q.max(0.).matrix().norm() + std::min(q.maxCoeff(), 0.);
  };
}

// Free inside, solid all around.
inline World Room(const Eigen::Vector2d& centre, const Eigen::Vector2d& size) {
  const World box = SolidBox(centre, size);
  return [box](const Eigen::Vector2d& p) { return -box(p); };
}

// Free where all of the parts are.
inline World Furnished(std::vector<World> parts) {
  return [parts = std::move(parts)](const Eigen::Vector2d& p) {
    double distance = std::numeric_limits<double>::infinity();
    for (const World& part : parts) distance = std::min(distance, part(p));
    return distance;
  };
}

// Free where any of the parts is.
inline World Joined(std::vector<World> parts) {
  return [parts = std::move(parts)](const Eigen::Vector2d& p) {
    double distance = -std::numeric_limits<double>::infinity();
    for (const World& part : parts) distance = std::max(distance, part(p));
    return distance;
  };
}

// Along the x axis.
inline World Corridor(const double width) {
  return Furnished({SolidHalfPlane(M_PI_2, -0.5 * width),
                    SolidHalfPlane(-M_PI_2, -0.5 * width)});
}

// The world that looks in a new frame as `world` does in the old one.
inline World Moved(const Rigid2& T_new_old, const World& world) {
  const Rigid2 T_old_new = T_new_old.Inverse();
  return [=](const Eigen::Vector2d& p_new) { return world(T_old_new * p_new); };
}

constexpr double kRoomSide = 4.;
constexpr double kOfficePitch = kRoomSide + 0.2;

namespace internal {

// Two desks and a pillar somewhere in a room.
inline std::vector<World> Furniture(const Eigen::Vector2d& centre,
                                    std::mt19937* const engine) {
  std::vector<World> furniture;
  const auto place = [&centre, engine] {
    const double x = Uniform(-1.5, 1.5, engine);
    return Eigen::Vector2d(centre.x() + x,
                           centre.y() + Uniform(-1.5, 1.5, engine));
  };
  for (int k = 0; k < 2; ++k) {
    const Eigen::Vector2d at = place();
    const double width = Uniform(0.3, 0.9, engine);
    furniture.push_back(
        SolidBox(at, {width, 0.4}, Uniform(-M_PI, M_PI, engine)));
  }
  const Eigen::Vector2d at = place();
  furniture.push_back(SolidDisc(at, Uniform(0.1, 0.25, engine)));
  return furniture;
}

}  // namespace internal

// Rooms behind rooms, furnished, with doors of various widths at various
// places; the lower left room has its centre at the origin. Distances are those
// to the walls and the furniture of one's own room.
inline World OfficeFloor(const int columns, const int rows) {
  std::mt19937 engine(42);
  const int count = columns * rows;
  std::vector<std::vector<World>> spaces(count), furniture(count);
  for (int k = 0; k < count; ++k) {
    const int column = k % columns, row = k / columns;
    const Eigen::Vector2d centre(kOfficePitch * column, kOfficePitch * row);
    spaces[k].push_back(Room(centre, {kRoomSide, kRoomSide}));
    furniture[k] = internal::Furniture(centre, &engine);
    const Eigen::Vector2d opening(0.5, Uniform(0.8, 1.6, &engine));
    const Eigen::Vector2d right(0.5 * kOfficePitch, Uniform(-1., 1., &engine));
    const Eigen::Vector2d above(Uniform(-1., 1., &engine), 0.5 * kOfficePitch);
    if (column + 1 < columns) {
      spaces[k].push_back(Room(centre + right, opening));
      spaces[k + 1].push_back(spaces[k].back());
    }
    if (row + 1 < rows) {
      spaces[k].push_back(Room(centre + above, opening.reverse()));
      spaces[k + columns].push_back(spaces[k].back());
    }
  }
  std::vector<World> offices;
  for (int k = 0; k < count; ++k) {
    furniture[k].push_back(Joined(std::move(spaces[k])));
    offices.push_back(Furnished(std::move(furniture[k])));
  }
  const auto index = [](const double at, const int bound) {
    return std::clamp(static_cast<int>(std::lround(at / kOfficePitch)), 0,
                      bound - 1);
  };
  return [=, offices = std::move(offices)](const Eigen::Vector2d& p) {
    return offices[index(p.y(), rows) * columns + index(p.x(), columns)](p);
  };
}

// Cells farther than `behind` within walls, or farther than `before` in front
// of them, are unknown [m].
struct Visibility {
  double behind = 0.2;
  double before = std::numeric_limits<double>::infinity();
};

// What a submap of that geometry sees of the world, with perfect vision: a cell
// is what its centre is.
inline OccupancyGrid Rasterise(const World& world, const CellGeometry& geometry,
                               const Rigid2& T_world_submap = {},
                               const Visibility& visibility = {}) {
  OccupancyGrid grid = UnknownGrid(geometry);
  for (int j = 0; j < geometry.size.y(); ++j) {
    for (int i = 0; i < geometry.size.x(); ++i) {
      const double distance =
          world(T_world_submap * geometry.CellCentre({i, j}));
      if (distance < -visibility.behind || distance > visibility.before) {
        continue;
      }
      grid.known(i, j) = true;
      grid.probability(i, j) = distance > 0. ? 0.1f : 0.9f;
    }
  }
  return grid;
}

// A square of `cells` x `cells` cells whose middle is the origin of the submap,
// turned by `angle` in it.
inline CellGeometry CentredGeometry(const int cells,
                                    const double resolution = 0.05,
                                    const double angle = 0.) {
  CellGeometry geometry;
  geometry.size = {cells, cells};
  geometry.resolution = resolution;
  const double half = 0.5 * resolution * cells;
  geometry.T_submap_grid = Rigid2(0., 0., angle) * Rigid2(-half, -half, 0.);
  return geometry;
}

// A floor of as many rooms as fit into half of the grid's width, in its middle.
inline OccupancyGrid OfficeGrid(const int cells) {
  const CellGeometry geometry = CentredGeometry(cells);
  const int rooms = std::max(
      1, static_cast<int>(0.5 * cells * geometry.resolution / kOfficePitch));
  const double middle = 0.5 * kOfficePitch * (rooms - 1);
  return Rasterise(OfficeFloor(rooms, rooms), geometry,
                   Rigid2(middle, middle, 0.));
}

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_WORLD_H_
