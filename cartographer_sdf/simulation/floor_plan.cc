// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/floor_plan.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Bounds the memory that a hostile header can ask for.
constexpr int64_t kMaxPixels = 100'000'000;
// The free threshold of ROS's map_server, 0.196 occupied, rounded so that its
// grey of the unknown (205 of 255) is not free.
constexpr double kFreeBrightness = 0.81;

// Reads a decimal number of a PGM header or of P2 data; nothing where there is
// none or it exceeds `maximum`.
std::optional<int64_t> ReadNumber(const int64_t maximum, std::istream* in) {
  while (std::isspace(in->peek()) || in->peek() == '#') {
    if (in->get() == '#') {
      while (in->good() && in->get() != '\n') {
      }
    }
  }
  if (!std::isdigit(in->peek())) return std::nullopt;
  int64_t number = 0;
  while (std::isdigit(in->peek())) {
    number = 10 * number + (in->get() - '0');
    if (number > maximum) return std::nullopt;
  }
  return number;
}

std::optional<int64_t> ReadPixel(const bool is_text, const int64_t maximum,
                                 std::istream* in) {
  if (is_text) return ReadNumber(maximum, in);
  int64_t pixel = in->get();
  if (maximum > 255) pixel = 256 * pixel + in->get();
  if (!in->good() || pixel > maximum) return std::nullopt;
  return pixel;
}

// Calls visit(cell) for the cells of a square around a point, clipped.
template <typename Visitor>
void VisitSquare(const CellGeometry& geometry, const Eigen::Vector2d& centre,
                 const double half_side, const Visitor& visit) {
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(half_side);
  const Eigen::Array2i minimum = geometry.CellAt(centre - half).max(0);
  const Eigen::Array2i maximum =
      geometry.CellAt(centre + half).min(geometry.size - 1);
  for (int j = minimum.y(); j <= maximum.y(); ++j) {
    for (int i = minimum.x(); i <= maximum.x(); ++i) {
      visit(Eigen::Array2i(i, j));
    }
  }
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
  const Rigid2 T_rectangle_world = Rigid2(centre, yaw).Inverse();
  VisitSquare(plan->geometry, centre, 0.5 * size.norm(),
              [&](const Eigen::Array2i& cell) {
                const Eigen::Vector2d p_rectangle =
                    T_rectangle_world * plan->geometry.CellCentre(cell);
                if ((p_rectangle.array().abs() <= 0.5 * size.array()).all()) {
                  plan->occupied(cell.x(), cell.y()) = occupied;
                }
              });
}

void FillDisc(const Eigen::Vector2d& centre, const double radius,
              const bool occupied, FloorPlan* const plan) {
  VisitSquare(plan->geometry, centre, radius, [&](const Eigen::Array2i& cell) {
    if ((plan->geometry.CellCentre(cell) - centre).norm() <= radius) {
      plan->occupied(cell.x(), cell.y()) = occupied;
    }
  });
}

absl::StatusOr<FloorPlan> ReadPgm(const std::string& path,
                                  const double resolution) {
  if (!(resolution > 0.) || !std::isfinite(resolution)) {
    return absl::InvalidArgumentError(
        absl::StrCat("the resolution of ", path, " must be positive"));
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) return absl::NotFoundError(absl::StrCat("cannot open ", path));
  const int magic[2] = {in.get(), in.get()};
  const bool is_text = magic[1] == '2';
  if (magic[0] != 'P' || (!is_text && magic[1] != '5')) {
    return absl::InvalidArgumentError(
        absl::StrCat(path, " is not a PGM image (P2 or P5)"));
  }
  const std::optional<int64_t> width = ReadNumber(kMaxPixels, &in);
  const std::optional<int64_t> height = ReadNumber(kMaxPixels, &in);
  const std::optional<int64_t> maximum = ReadNumber(65535, &in);
  if (!width || !height || !maximum || *width < 1 || *height < 1 ||
      *maximum < 1 || *width > kMaxPixels / *height || !std::isspace(in.get())) {
    return absl::InvalidArgumentError(
        absl::StrCat("the PGM header of ", path, " is broken or too large"));
  }
  std::vector<bool> occupied;  // Grows with the data, not with the header.
  for (int64_t k = 0; k != *width * *height; ++k) {
    const std::optional<int64_t> pixel = ReadPixel(is_text, *maximum, &in);
    if (!pixel) {
      return absl::DataLossError(
          absl::StrCat(path, " ends or is corrupted at pixel ", k, " of ",
                       *width * *height));
    }
    occupied.push_back(static_cast<double>(*pixel) <
                       kFreeBrightness * static_cast<double>(*maximum));
  }
  FloorPlan plan;
  plan.geometry.resolution = resolution;
  plan.geometry.size = Eigen::Array2i(*width, *height);
  plan.occupied.resize(*width, *height);
  for (int64_t j = 0; j != *height; ++j) {
    for (int64_t i = 0; i != *width; ++i) {
      plan.occupied(i, *height - 1 - j) = occupied[j * *width + i];
    }
  }
  return plan;
}

}  // namespace cartographer_sdf
