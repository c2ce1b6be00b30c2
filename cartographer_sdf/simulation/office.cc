// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/office.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "cartographer_sdf/geometry/number_range.h"
#include "cartographer_sdf/simulation/random_numbers.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

// Depth of the rooms between the outer wall and the corridor, and width of
// rooms along the corridor [m].
constexpr double kMinRoomDepth = 4.8;
constexpr double kMaxRoomDepth = 6.5;
constexpr double kMinRoomWidth = 3.;
constexpr double kMaxRoomWidth = 8.;
constexpr double kCorridorWidth = 2.2;
constexpr double kDoorWidth = 1.1;
// Radius around the middle of a door that is kept free of furniture [m].
constexpr double kDoorRadius = 0.5 * kDoorWidth + 0.8;

struct Room {
  AlignedBox2d box;
  // The part of the room's wall that faces the corridor, and the unit vector
  // from it into the corridor.
  Vector2d wall_begin, wall_end;
  Vector2d outward;
};

// Borders of intervals of random width that fill [minimum, maximum].
std::vector<double> Split(const double minimum, const double maximum,
                          RandomNumbers* const random) {
  std::vector<double> borders = {minimum};
  while (maximum - borders.back() > kMaxRoomWidth) {
    const double width = random->Uniform(kMinRoomWidth, kMaxRoomWidth);
    borders.push_back(
        std::min(borders.back() + width, maximum - kMinRoomWidth));
  }
  borders.push_back(maximum);
  return borders;
}

// A row of rooms in `box` along its side in direction `outward` (an axis). The
// outermost rooms extend by `extension` beyond the wall that faces a corridor.
void AddRow(const AlignedBox2d& box, const Vector2d& outward,
            const Vector2d& extension, RandomNumbers* const random,
            std::vector<Room>* const rooms) {
  const int along = outward.x() == 0. ? 0 : 1;
  const std::vector<double> borders =
      Split(box.min()[along], box.max()[along], random);
  for (size_t k = 0; k + 1 != borders.size(); ++k) {
    Room room;
    room.outward = outward;
    room.box = box;
    room.box.min()[along] = borders[k];
    room.box.max()[along] = borders[k + 1];
    const Vector2d middle =
        room.box.center() + 0.5 * room.box.sizes()
                                      .cwiseProduct(outward.cwiseAbs())
                                      .cwiseProduct(outward);
    room.wall_begin = room.wall_end = middle;
    room.wall_begin[along] = borders[k];
    room.wall_end[along] = borders[k + 1];
    if (k == 0) room.box.min()[along] -= extension[0];
    if (k + 2 == borders.size()) room.box.max()[along] += extension[1];
    rooms->push_back(room);
  }
}

std::vector<Room> MakeRooms(const OfficeOptions& options,
                            RandomNumbers* const random) {
  const auto depth = [&] {
    return random->Uniform(kMinRoomDepth, kMaxRoomDepth);
  };
  const double west = depth(), east = options.width - depth();
  const double south = depth(), north = options.height - depth();
  const Vector2d none = Vector2d::Zero();
  const Vector2d corners(west, options.width - east);
  std::vector<Room> rooms;
  const auto box = [](double x0, double y0, double x1, double y1) {
    return AlignedBox2d(Vector2d(x0, y0), Vector2d(x1, y1));
  };
  AddRow(box(west, 0., east, south), Vector2d::UnitY(), corners, random,
         &rooms);
  AddRow(box(west, north, east, options.height), -Vector2d::UnitY(), corners,
         random, &rooms);
  AddRow(box(0., south, west, north), Vector2d::UnitX(), none, random, &rooms);
  AddRow(box(east, south, options.width, north), -Vector2d::UnitX(), none,
         random, &rooms);
  const AlignedBox2d core = box(west + kCorridorWidth, south + kCorridorWidth,
                                east - kCorridorWidth, north - kCorridorWidth);
  const double crossing =
      core.center().x() + random->Uniform(-0.1, 0.1) * core.sizes().x();
  for (const AlignedBox2d& half :
       {box(core.min().x(), core.min().y(), crossing - 0.5 * kCorridorWidth,
            core.max().y()),
        box(crossing + 0.5 * kCorridorWidth, core.min().y(), core.max().x(),
            core.max().y())}) {
    const double middle =
        half.center().y() + random->Uniform(-0.15, 0.15) * half.sizes().y();
    AddRow(box(half.min().x(), half.min().y(), half.max().x(), middle),
           -Vector2d::UnitY(), none, random, &rooms);
    AddRow(box(half.min().x(), middle, half.max().x(), half.max().y()),
           Vector2d::UnitY(), none, random, &rooms);
  }
  return rooms;
}

void DrawWalls(const AlignedBox2d& box, const double thickness,
               FloorPlan* const plan) {
  const Vector2d centre = box.center(), size = box.sizes();
  for (const double side : {-0.5, 0.5}) {
    FillRectangle(centre + Vector2d(side * size.x(), 0.),
                  Vector2d(thickness, size.y() + thickness), 0., true, plan);
    FillRectangle(centre + Vector2d(0., side * size.y()),
                  Vector2d(size.x() + thickness, thickness), 0., true, plan);
  }
}

// Leaves only the legs of a table in the plan visible to a lidar.
void OpenTable(const Vector2d& centre, const Vector2d& size, const double yaw,
               FloorPlan* const plan) {
  const Vector2d leg = Vector2d::Constant(0.06);
  MakeUnseen(centre, size, yaw, true, plan);
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      const Vector2d p_table = Vector2d(x, y).cwiseProduct(size - leg);
      MakeUnseen(Rigid2(centre, yaw) * p_table, leg, yaw, false, plan);
    }
  }
}

// A piece of furniture with its back to a wall of the interior.
void AddAgainstWall(const AlignedBox2d& interior, const Vector2d& door,
                    RandomNumbers* const random, const bool is_open,
                    FloorPlan* const plan) {
  const bool is_desk = random->Chance(0.5);
  const double depth =
      is_desk ? random->Uniform(0.6, 0.9) : random->Uniform(0.3, 0.55);
  const double length =
      is_desk ? random->Uniform(1.2, 2.) : random->Uniform(0.6, 2.2);
  const int along = random->Index(2);
  Vector2d size, centre;
  size[along] = length;
  size[1 - along] = depth;
  centre[along] = random->Uniform(interior.min()[along] + 0.5 * length,
                                  interior.max()[along] - 0.5 * length);
  centre[1 - along] = random->Chance(0.5)
                          ? interior.min()[1 - along] + 0.5 * depth
                          : interior.max()[1 - along] - 0.5 * depth;
  if ((centre - door).norm() < kDoorRadius + 0.5 * length) return;
  FillRectangle(centre, size, 0., true, plan);
  if (!is_desk) return;
  if (is_open) OpenTable(centre, size, 0., plan);
  Vector2d chair = centre;
  const double side =
      centre[1 - along] < interior.center()[1 - along] ? 1. : -1.;
  chair[along] += random->Uniform(-0.3, 0.3) * length;
  chair[1 - along] += side * (0.5 * depth + random->Uniform(0.2, 0.4));
  FillDisc(chair, 0.22, plan);
}

// A round or rectangular table with chairs, or a pillar.
void AddFreestanding(const AlignedBox2d& interior, const Vector2d& door,
                     RandomNumbers* const random, const bool is_open,
                     FloorPlan* const plan) {
  constexpr double kMargin = 1.2;
  if (interior.sizes().minCoeff() < 2. * kMargin + 0.5) return;
  const Vector2d centre(random->Uniform(interior.min().x() + kMargin,
                                        interior.max().x() - kMargin),
                        random->Uniform(interior.min().y() + kMargin,
                                        interior.max().y() - kMargin));
  const double radius = random->Uniform(0.35, 0.7);
  if ((centre - door).norm() < kDoorRadius + radius + 0.4) return;
  const double yaw = random->Uniform(0., M_PI);
  switch (random->Index(3)) {
    case 0:
      FillRectangle(centre, Vector2d::Constant(0.8 * radius), 0., true, plan);
      return;
    case 1:
      FillDisc(centre, radius, plan);
      if (is_open) {
        // The square within.
        MakeUnseen(centre, Vector2d::Constant(2. * radius), 0., true, plan);
        OpenTable(centre, Vector2d::Constant(M_SQRT2 * radius), yaw, plan);
      }
      break;
    default:
      FillRectangle(centre, Vector2d(2. * radius, 0.8), yaw, true, plan);
      if (is_open) OpenTable(centre, Vector2d(2. * radius, 0.8), yaw, plan);
  }
  for (int k = random->Index(4); k > 0; --k) {
    const double angle = random->Uniform(0., 2. * M_PI);
    FillDisc(
        centre + (radius + 0.25) * Vector2d(std::cos(angle), std::sin(angle)),
        0.2, plan);
  }
}

void FurnishRoom(const OfficeOptions& options, const Room& room,
                 const Vector2d& door, RandomNumbers* const random,
                 RandomNumbers* const materials, FloorPlan* const plan) {
  const Vector2d inset = Vector2d::Constant(0.5 * options.wall_thickness);
  const AlignedBox2d interior(room.box.min() + inset, room.box.max() - inset);
  const int pieces = static_cast<int>(
      std::lround(interior.volume() * options.furniture_density));
  for (int k = 0; k != pieces; ++k) {
    const bool is_open = materials->Chance(options.open_tables);
    if (random->Chance(0.6)) {
      AddAgainstWall(interior, door, random, is_open, plan);
    } else {
      AddFreestanding(interior, door, random, is_open, plan);
    }
  }
}

// A cabinet, bench or copier in the corridor before the room's wall.
void FurnishCorridor(const OfficeOptions& options, const Room& room,
                     const Vector2d& door, RandomNumbers* const random,
                     FloorPlan* const plan) {
  const Vector2d along = (room.wall_end - room.wall_begin).normalized();
  const double wall_length = (room.wall_end - room.wall_begin).norm();
  const double length = random->Uniform(0.5, 1.6);
  const double depth = random->Uniform(0.25, 0.45);
  const Vector2d centre =
      room.wall_begin +
      random->Uniform(0.5 * length, wall_length - 0.5 * length) * along +
      0.5 * (options.wall_thickness + depth) * room.outward;
  if ((centre - door).norm() < kDoorRadius + 0.5 * length) return;
  const double yaw = std::atan2(along.y(), along.x());
  FillRectangle(centre, Vector2d(length, depth), yaw, true, plan);
}

}  // namespace

std::string Validate(const OfficeOptions& options) {
  // Four rows of rooms, three corridors.
  constexpr double kLeastSize =
      2. * kMaxRoomDepth + 2. * kMinRoomWidth + 3. * kCorridorWidth;
  return FirstOutside({{"width", options.width, kLeastSize, 500.},
                       {"height", options.height, kLeastSize, 500.},
                       {"wall_thickness", options.wall_thickness, 0.01, 0.5},
                       {"closed_doors", options.closed_doors, 0., 1.},
                       {"furniture_density", options.furniture_density, 0., 1.},
                       {"glass_fronts", options.glass_fronts, 0., 1.},
                       {"open_tables", options.open_tables, 0., 1.},
                       {"resolution", options.resolution, 0.01, 0.1}});
}

FloorPlan MakeOffice(const OfficeOptions& options, const uint32_t seed) {
  CHECK_EQ(Validate(options), "");
  RandomNumbers random(seed);
  RandomNumbers materials(seed, RandomStream::kMaterials);
  FloorPlan plan = EmptyFloorPlan(Vector2d(options.width, options.height),
                                  options.resolution);
  const std::vector<Room> rooms = MakeRooms(options, &random);
  for (const Room& room : rooms) {
    DrawWalls(room.box, options.wall_thickness, &plan);
  }
  for (const Room& room : rooms) {
    const double margin = 0.5 * kDoorWidth + options.wall_thickness;
    const double fraction = margin / (room.wall_end - room.wall_begin).norm();
    const Vector2d door =
        room.wall_begin + random.Uniform(fraction, 1. - fraction) *
                              (room.wall_end - room.wall_begin);
    if (!random.Chance(options.closed_doors)) {
      const Vector2d across = options.wall_thickness * room.outward.cwiseAbs();
      const Vector2d along =
          kDoorWidth * (Vector2d::Ones() - room.outward.cwiseAbs());
      FillRectangle(door, 1.5 * across + along, 0., false, &plan);
    }
    FurnishRoom(options, room, door, &random, &materials, &plan);
    if (random.Chance(0.4))
      FurnishCorridor(options, room, door, &random, &plan);
  }
  for (const Room& room : rooms) {
    if (materials.Chance(options.glass_fronts)) {
      const Vector2d along = (room.wall_end - room.wall_begin).cwiseAbs();
      const Vector2d across = options.wall_thickness * room.outward.cwiseAbs();
      MakeGlass(0.5 * (room.wall_begin + room.wall_end), along + across, 0.,
                &plan);
    }
  }
  DrawWalls(
      AlignedBox2d(Vector2d::Zero(), Vector2d(options.width, options.height)),
      2. * options.wall_thickness, &plan);
  return plan;
}

}  // namespace cartographer_sdf
