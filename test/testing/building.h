// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Buildings made of boxes, and what a lidar that turns all the way round sees
// of them: submaps and scans with exactly known poses. Without noise.

#ifndef TEST_TESTING_BUILDING_H_
#define TEST_TESTING_BUILDING_H_

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/place/surface_model.h"
#include "glog/logging.h"
#include "gmock/gmock.h"

namespace cartographer_sdf::testing {

struct Box {
  Rigid2 T_world_box;  // the origin is the middle
  Eigen::Vector2d size;
};
using Building = std::vector<Box>;
using Viewpoints = std::vector<Eigen::Vector2d>;  // world

inline Box Wall(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  constexpr double kThickness = 0.15;
  const Eigen::Vector2d along = to - from;
  return {Rigid2(0.5 * (from + to), std::atan2(along.y(), along.x())),
          {along.norm() + kThickness, kThickness}};
}

inline Box Furniture(const double x, const double y, const double width,
                     const double depth, const double yaw) {
  return {Rigid2(x, y, yaw), {width, depth}};
}

// Four walls around the origin, with corners at half of the size.
inline Building BareRoom(const double width, const double height) {
  const double x = 0.5 * width, y = 0.5 * height;
  return {Wall({-x, -y}, {x, -y}), Wall({x, -y}, {x, y}), Wall({x, y}, {-x, y}),
          Wall({-x, y}, {-x, -y})};
}

// A corridor along x with a furnished room at either end, 7 m x 5 m and
// 7 m x 6.5 m.
inline Building TwoRooms() {
  return {
      // The corridor.
      Wall({-3., 5.}, {5., 5.}),
      Wall({6., 5.}, {10., 5.}),
      Wall({11.2, 5.}, {16., 5.}),
      Wall({-3., 7.2}, {16., 7.2}),
      Wall({-3., 5.}, {-3., 7.2}),
      Wall({16., 5.}, {16., 7.2}),
      // The west room.
      Wall({0., 0.}, {7., 0.}),
      Wall({0., 0.}, {0., 5.}),
      Wall({7., 0.}, {7., 5.}),
      Furniture(1.6, 3.4, 1.4, 0.7, 0.4),
      Furniture(4.1, 0.5, 1.2, 0.6, 0.),
      Furniture(5.4, 2.6, 0.5, 0.5, 0.8),
      Furniture(0.4, 0.9, 0.5, 1.1, 0.),
      // The east room.
      Wall({9., -1.5}, {16., -1.5}),
      Wall({9., -1.5}, {9., 5.}),
      Wall({16., -1.5}, {16., 5.}),
      Furniture(9.6, 0.6, 0.9, 1.8, 0.),
      Furniture(12.2, 1.4, 1.6, 0.8, -0.5),
      Furniture(14.8, 3.9, 0.4, 1.9, 0.),
      Furniture(14.1, -0.4, 0.6, 0.6, 0.3),
  };
}

inline Viewpoints WestRoomViewpoints() {
  return {{1., 2.2}, {3., 2.}, {5.6, 1.2}, {3.2, 3.8}, {5.5, 4.2}};
}
inline Viewpoints EastRoomViewpoints() {
  return {{10.6, 2.7}, {11., -0.8}, {13.6, 0.8}, {13.5, 3.4}, {15.2, 1.}};
}

// Of a ray of unit direction, the distance to where it enters the box.
inline std::optional<double> EnterBox(const Box& box,
                                      const Eigen::Vector2d& p_world,
                                      const Eigen::Vector2d& direction) {
  const Rigid2 T_box_world = box.T_world_box.Inverse();
  const Eigen::Vector2d p = T_box_world * p_world;
  const Eigen::Vector2d d = T_box_world.RotationMatrix() * direction;
  double enter = 0.;
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 2; ++axis) {
    const double half = 0.5 * box.size[axis];
    if (std::abs(d[axis]) < 1e-12) {
      if (std::abs(p[axis]) > half) return std::nullopt;
      continue;
    }
    const double a = (-half - p[axis]) / d[axis];
    const double b = (half - p[axis]) / d[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (enter >= leave) return std::nullopt;
  return enter;
}

// Beams from one viewpoint: directions in the world with the range at which
// each hits, if it does, and what.
struct Beam {
  Eigen::Vector2d direction;
  std::optional<double> range;
  const Box* box = nullptr;
};
constexpr double kMaxRange = 9.;

inline std::vector<Beam> CastBeams(const Building& building,
                                   const Eigen::Vector2d& p_world,
                                   const int num_beams) {
  std::vector<Beam> beams;
  for (int k = 0; k < num_beams; ++k) {
    const double angle = 2. * M_PI * (k + 0.5) / num_beams;
    Beam beam;
    beam.direction = {std::cos(angle), std::sin(angle)};
    for (const Box& box : building) {
      const std::optional<double> range =
          EnterBox(box, p_world, beam.direction);
      if (range && *range < beam.range.value_or(kMaxRange)) {
        beam.range = range;
        beam.box = &box;
      }
    }
    beams.push_back(beam);
  }
  return beams;
}

// A scan in the frame of its node.
inline std::vector<SurfacePoint> TakeScan(const Building& building,
                                          const Rigid2& T_world_node) {
  std::vector<SurfacePoint> points;
  for (const Beam& beam :
       CastBeams(building, T_world_node.translation(), 360)) {
    if (!beam.range) continue;
    points.push_back(
        {T_world_node.Inverse() * Eigen::Vector2d(T_world_node.translation() +
                                                  *beam.range * beam.direction),
         1.});
  }
  return points;
}

// A submap: walls have a probability of 0.8, free space 0.2; the rest is
// unknown. Walls are closed between neighbouring beams, as a robot that drives
// by would see them.
inline OccupancyGrid SeeFrom(const Building& building,
                             const Rigid2& T_world_submap,
                             const Viewpoints& viewpoints) {
  constexpr double kResolution = 0.05, kStep = 0.025;
  Eigen::AlignedBox2d bounds;
  for (const Eigen::Vector2d& p_world : viewpoints) {
    const Eigen::Vector2d p = T_world_submap.Inverse() * p_world;
    const Eigen::Vector2d reach = Eigen::Vector2d::Constant(kMaxRange + 0.1);
    bounds.extend(Eigen::Vector2d(p - reach));
    bounds.extend(Eigen::Vector2d(p + reach));
  }
  CellGeometry geometry;
  geometry.resolution = kResolution;
  geometry.T_submap_grid =
      Rigid2((bounds.min() / kResolution).array().floor() * kResolution, 0.);
  geometry.size = (bounds.sizes() / kResolution).array().ceil().cast<int>() + 1;
  OccupancyGrid grid = UnknownGrid(geometry);
  const auto mark = [&](const Eigen::Vector2d& p_world,
                        const float probability) {
    const Eigen::Array2i cell =
        geometry.CellAt(T_world_submap.Inverse() * p_world);
    CHECK(geometry.Contains(cell));
    // A cell that was hit stays a wall.
    float& stored = grid.probability(cell.x(), cell.y());
    bool& known = grid.known(cell.x(), cell.y());
    stored = known ? std::max(stored, probability) : probability;
    known = true;
  };
  for (const Eigen::Vector2d& p_world : viewpoints) {
    const std::vector<Beam> beams = CastBeams(building, p_world, 1440);
    const Beam* previous = &beams.back();
    for (const Beam& beam : beams) {
      const double end = beam.range.value_or(kMaxRange);
      for (double range = 0.; range < end; range += kStep) {
        mark(p_world + range * beam.direction, 0.2f);
      }
      if (beam.range) mark(p_world + end * beam.direction, 0.8f);
      if (beam.box != nullptr && beam.box == previous->box) {
        const Eigen::Vector2d p = end * beam.direction;
        const Eigen::Vector2d q = *previous->range * previous->direction;
        const double length = (p - q).norm();
        for (double along = kStep; along < length; along += kStep) {
          mark(p_world + p + along / length * (q - p), 0.8f);
        }
      }
      previous = &beam;
    }
  }
  return grid;
}

inline SurfaceModel SurfaceSeenFrom(const Building& building,
                                    const Rigid2& T_world_submap,
                                    const Viewpoints& viewpoints) {
  std::optional<SurfaceModel> model = MakeSurfaceModel(
      FieldOptions(), SeeFrom(building, T_world_submap, viewpoints));
  CHECK(model.has_value());
  return *std::move(model);
}

// Two poses of the same frames.
MATCHER_P3(IsPoseNear, expected, meters, radians,
           "is a pose within " + ::testing::PrintToString(meters) + " m, " +
               ::testing::PrintToString(radians) + " rad of " +
               ::testing::PrintToString(expected)) {
  const Rigid2 error = expected.Inverse() * arg;
  *result_listener << "off by " << error;
  return error.translation().norm() <= meters &&
         std::abs(error.rotation()) <= radians;
}

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_BUILDING_H_
