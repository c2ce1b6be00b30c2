// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/floor_plan.h"

#include <string>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "cartographer_sdf/map_image/grey_image.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// The free threshold of ROS's map_server, 0.196 occupied, rounded so that its
// grey for unknown cells (205 of 255) is not free.
constexpr double kFreeBrightness = 0.81;

// Calls visit(cell, cell centre relative to the box centre) for the cells of a
// box with the given half sizes, clipped to the plan.
template <typename Visitor>
void VisitBox(const CellGeometry& geometry, const Eigen::Vector2d& centre,
              const Eigen::Vector2d& half_size, const Visitor& visit) {
  const Eigen::Array2i minimum = geometry.CellAt(centre - half_size).max(0);
  const Eigen::Array2i maximum =
      geometry.CellAt(centre + half_size).min(geometry.size - 1);
  for (int j = minimum.y(); j <= maximum.y(); ++j) {
    for (int i = minimum.x(); i <= maximum.x(); ++i) {
      const Eigen::Vector2d p_world =
          geometry.CellsToGrid(Eigen::Vector2d(i, j));
      visit(i, j, p_world - centre);
    }
  }
}

template <typename Visitor>
void VisitRectangle(const CellGeometry& geometry, const Eigen::Vector2d& centre,
                    const Eigen::Vector2d& size, const double yaw,
                    const Visitor& visit) {
  const Eigen::Matrix2d R_world_rectangle =
      Rigid2(centre, yaw).RotationMatrix();
  const Eigen::Matrix2d R_rectangle_world = R_world_rectangle.transpose();
  const Eigen::Vector2d half_size = 0.5 * size;
  VisitBox(geometry, centre, R_world_rectangle.cwiseAbs() * half_size,
           [&](const int i, const int j, const Eigen::Vector2d& offset) {
             const Eigen::Vector2d p_rectangle = R_rectangle_world * offset;
             if ((p_rectangle.array().abs() <= half_size.array()).all()) {
               visit(i, j);
             }
           });
}

// Sets the mask, which may still be empty, where the rectangle is occupied.
void MarkOccupied(const Eigen::Vector2d& centre, const Eigen::Vector2d& size,
                  const double yaw, const bool value, const FloorPlan& plan,
                  BoolArray* const mask) {
  if (mask->size() == 0) {
    *mask =
        BoolArray::Constant(plan.occupied.rows(), plan.occupied.cols(), false);
  }
  VisitRectangle(plan.geometry, centre, size, yaw,
                 [&](const int i, const int j) {
                   if (plan.occupied(i, j)) (*mask)(i, j) = value;
                 });
}

}  // namespace

FloorPlan EmptyFloorPlan(const Eigen::Vector2d& size, const double resolution) {
  CHECK_GT(resolution, 0.);
  FloorPlan plan;
  plan.geometry.resolution = resolution;
  plan.geometry.size =
      (size.array() / resolution - 1e-9).ceil().cast<int>().max(1);
  plan.occupied = BoolArray::Constant(plan.geometry.size.x(),
                                      plan.geometry.size.y(), false);
  return plan;
}

void FillRectangle(const Eigen::Vector2d& centre, const Eigen::Vector2d& size,
                   const double yaw, const bool occupied,
                   FloorPlan* const plan) {
  VisitRectangle(
      plan->geometry, centre, size, yaw,
      [&](const int i, const int j) { plan->occupied(i, j) = occupied; });
}

void MakeGlass(const Eigen::Vector2d& centre, const Eigen::Vector2d& size,
               const double yaw, FloorPlan* const plan) {
  MarkOccupied(centre, size, yaw, true, *plan, &plan->glass);
}

void MakeUnseen(const Eigen::Vector2d& centre, const Eigen::Vector2d& size,
                const double yaw, const bool unseen, FloorPlan* const plan) {
  MarkOccupied(centre, size, yaw, unseen, *plan, &plan->unseen);
}

void FillDisc(const Eigen::Vector2d& centre, const double radius,
              FloorPlan* const plan) {
  VisitBox(plan->geometry, centre, Eigen::Vector2d::Constant(radius),
           [&](const int i, const int j, const Eigen::Vector2d& offset) {
             if (offset.norm() <= radius) plan->occupied(i, j) = true;
           });
}

absl::StatusOr<FloorPlan> ReadPgm(const std::string& path,
                                  const double resolution) {
  if (!(resolution >= 0.01 && resolution <= 1.)) {
    return absl::InvalidArgumentError(absl::StrCat(
        "the resolution of ", path, " must lie between 0.01 m and 1 m"));
  }
  const absl::StatusOr<GreyImage> image = ReadPgmImage(path);
  if (!image.ok()) return image.status();
  FloorPlan plan;
  plan.geometry.resolution = resolution;
  plan.geometry.size =
      Eigen::Array2i(static_cast<int>(image->brightness.rows()),
                     static_cast<int>(image->brightness.cols()));
  plan.occupied = image->brightness < static_cast<float>(kFreeBrightness);
  return plan;
}

}  // namespace cartographer_sdf
