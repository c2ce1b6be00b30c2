// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/grid_conversion.h"

#include <algorithm>
#include <cmath>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "cartographer_sdf/pbstream/pose_codec.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Value 0 means unknown; 1 to 32767 map linearly to the range of the quantity.
constexpr int kUnknownValue = 0;
constexpr int kMaxValue = 32767;
constexpr float kNumSteps = 32766.f;
// The host's bounds of correspondence costs, which are 1 - probability. Older
// files, which do not store the bounds, have zeros.
constexpr float kMinCost = 0.1f;
constexpr float kMaxCost = 0.9f;
// Bounds of a plausible cell size [m].
constexpr double kMinResolution = 1e-4;
constexpr double kMaxResolution = 1e3;
// 400 m by 400 m at 5 cm.
constexpr int kMaxNumGridCells = 1 << 26;
// Parameters of the occupancy of a TSDF, see the header.
constexpr float kSurfaceProbability = 0.9f;
constexpr float kFreeProbability = 0.1f;
constexpr float kFreeDistanceInCells = 1.5f;
constexpr float kSurfaceDistanceInCells = 0.75f;

float ValueToFloat(const int value, const float lower, const float upper) {
  return lower + static_cast<float>(value - 1) * ((upper - lower) / kNumSteps);
}

int FloatToValue(const float number, const float lower, const float upper) {
  const float clamped = std::clamp(number, lower, upper);
  return static_cast<int>(
             std::lround((clamped - lower) * (kNumSteps / (upper - lower)))) +
         1;
}

// Returns the position of our cell (i, j) in the host's list of cells.
int FlatIndex(const Eigen::Array2i& size, const int i, const int j) {
  const int host_x = size.y() - 1 - j;
  const int host_y = size.x() - 1 - i;
  return host_x + size.y() * host_y;
}

// Calls visit(i, j, flat index) for each cell. Our columns are the host's rows:
// in bands of as many of our rows as a cache line holds, neither is read in
// strides.
template <typename Visitor>
void VisitCells(const Eigen::Array2i& size, const Visitor& visit) {
  constexpr int kBand = 16;
  for (int begin = 0; begin < size.x(); begin += kBand) {
    const int end = std::min(begin + kBand, size.x());
    for (int j = 0; j < size.y(); ++j) {
      for (int i = begin; i < end; ++i) visit(i, j, FlatIndex(size, i, j));
    }
  }
}

absl::Status CheckLimits(const proto::MapLimits& limits, const int num_values) {
  if (!(limits.resolution() >= kMinResolution &&
        limits.resolution() <= kMaxResolution)) {
    return absl::DataLossError(
        absl::StrCat("has a grid with cells of ", limits.resolution(), " m"));
  }
  if (!(std::abs(limits.max().x()) <= kMaxCoordinate &&
        std::abs(limits.max().y()) <= kMaxCoordinate)) {
    return absl::DataLossError("has a grid with a corner that is not finite");
  }
  const int64_t num_x = limits.cell_limits().num_x_cells();
  const int64_t num_y = limits.cell_limits().num_y_cells();
  if (num_x <= 0 || num_y <= 0 || num_x * num_y != num_values) {
    return absl::DataLossError(absl::StrCat("has a grid of ", num_x, " x ",
                                            num_y, " cells with ", num_values,
                                            " values"));
  }
  if (num_values > kMaxNumGridCells) {
    return absl::DataLossError(absl::StrCat(
        "has a grid of ", num_x, " x ", num_y, " cells, which is too many"));
  }
  return absl::OkStatus();
}

absl::Status CheckValues(const google::protobuf::RepeatedField<int>& values) {
  // kMaxValue has all the bits that a value may have.
  static_assert((kMaxValue & (kMaxValue + 1)) == 0 && kUnknownValue == 0);
  int bits = 0;
  for (const int value : values) bits |= value;
  if ((bits & ~kMaxValue) == 0) return absl::OkStatus();
  for (const int value : values) {
    if (value < kUnknownValue || value > kMaxValue) {
      return absl::DataLossError(
          absl::StrCat("has a grid with the invalid value ", value));
    }
  }
  return absl::OkStatus();
}

CellGeometry MakeGeometry(const proto::MapLimits& limits,
                          const Rigid2& T_local_submap) {
  CellGeometry geometry;
  geometry.resolution = limits.resolution();
  geometry.size = Eigen::Array2i(limits.cell_limits().num_y_cells(),
                                 limits.cell_limits().num_x_cells());
  const Eigen::Vector2d max_local(limits.max().x(), limits.max().y());
  const Rigid2 T_local_grid(
      max_local - limits.resolution() * geometry.size.matrix().cast<double>(),
      0.);
  geometry.T_submap_grid = T_local_submap.Inverse() * T_local_grid;
  return geometry;
}

absl::Status FillProbabilities(const proto::Grid2D& stored,
                               OccupancyGrid* const grid) {
  float min_cost = stored.min_correspondence_cost();
  float max_cost = stored.max_correspondence_cost();
  if (min_cost == 0.f && max_cost == 0.f) {
    min_cost = kMinCost;
    max_cost = kMaxCost;
  }
  if (!(min_cost > 0.f && min_cost < max_cost && max_cost < 1.f)) {
    return absl::DataLossError(
        absl::StrCat("has a grid with correspondence costs from ", min_cost,
                     " to ", max_cost));
  }
  const int* const values = stored.cells().data();
  VisitCells(grid->geometry.size, [&](const int i, const int j, const int k) {
    const int value = values[k];
    if (value == kUnknownValue) return;
    grid->known(i, j) = true;
    grid->probability(i, j) = 1.f - ValueToFloat(value, min_cost, max_cost);
  });
  return absl::OkStatus();
}

absl::Status CheckTsdf(const proto::Tsdf2D& tsdf, const int num_values) {
  if (tsdf.weight_cells_size() != num_values) {
    return absl::DataLossError(
        absl::StrCat("has a TSDF with ", num_values, " distances and ",
                     tsdf.weight_cells_size(), " weights"));
  }
  if (!(tsdf.truncation_distance() > 0.f && tsdf.max_weight() > 0.f) ||
      !std::isfinite(tsdf.truncation_distance()) ||
      !std::isfinite(tsdf.max_weight())) {
    return absl::DataLossError(absl::StrCat(
        "has a TSDF with truncation distance ", tsdf.truncation_distance(),
        " m and maximum weight ", tsdf.max_weight()));
  }
  return CheckValues(tsdf.weight_cells());
}

absl::Status FillImpliedProbabilities(const proto::Grid2D& stored,
                                      OccupancyGrid* const grid) {
  const proto::Tsdf2D& tsdf = stored.tsdf_2d();
  const absl::Status status = CheckTsdf(tsdf, stored.cells_size());
  if (!status.ok()) return status;
  const float truncation = tsdf.truncation_distance();
  const float resolution = static_cast<float>(grid->geometry.resolution);
  const float free_distance =
      std::min(kFreeDistanceInCells * resolution, truncation);
  VisitCells(grid->geometry.size, [&](const int i, const int j, const int k) {
    const int value = stored.cells(k);
    const float distance = ValueToFloat(value, -truncation, truncation);
    if (value == kUnknownValue ||
        // "Unknown" and the lowest value both mean a weight of zero.
        tsdf.weight_cells(k) <= 1 ||
        distance < -kSurfaceDistanceInCells * resolution) {
      return;
    }
    grid->known(i, j) = true;
    grid->probability(i, j) =
        kSurfaceProbability +
        (kFreeProbability - kSurfaceProbability) *
            std::min(1.f, std::abs(distance) / free_distance);
  });
  return absl::OkStatus();
}

// The inverse of MakeGeometry.
proto::MapLimits MakeLimits(const CellGeometry& geometry,
                            const Rigid2& T_local_submap) {
  const Rigid2 T_local_grid = T_local_submap * geometry.T_submap_grid;
  constexpr double kMaxAngle = 1e-9;  // [rad], of rounding
  CHECK_LE(std::abs(T_local_grid.rotation()), kMaxAngle);
  const Eigen::Vector2d max_local =
      T_local_grid.translation() +
      geometry.resolution * geometry.size.matrix().cast<double>();
  proto::MapLimits limits;
  limits.set_resolution(geometry.resolution);
  limits.mutable_max()->set_x(max_local.x());
  limits.mutable_max()->set_y(max_local.y());
  limits.mutable_cell_limits()->set_num_x_cells(geometry.size.y());
  limits.mutable_cell_limits()->set_num_y_cells(geometry.size.x());
  return limits;
}

}  // namespace

absl::StatusOr<OccupancyGrid> MakeOccupancyGrid(const proto::Grid2D& grid,
                                                const Rigid2& T_local_submap) {
  absl::Status status = CheckLimits(grid.limits(), grid.cells_size());
  if (status.ok()) status = CheckValues(grid.cells());
  if (!status.ok()) return status;
  OccupancyGrid result =
      UnknownGrid(MakeGeometry(grid.limits(), T_local_submap));
  switch (grid.grid_case()) {
    case proto::Grid2D::kProbabilityGrid2D:
      status = FillProbabilities(grid, &result);
      break;
    case proto::Grid2D::kTsdf2D:
      status = FillImpliedProbabilities(grid, &result);
      break;
    case proto::Grid2D::GRID_NOT_SET:
      status = absl::DataLossError("has a grid of an unknown type");
      break;
  }
  if (!status.ok()) return status;
  return result;
}

proto::Grid2D MakeGrid2D(const OccupancyGrid& grid,
                         const Rigid2& T_local_submap) {
  const Eigen::Array2i& size = grid.geometry.size;
  CHECK((size > 0).all());
  CHECK(grid.known.rows() == size.x() && grid.known.cols() == size.y() &&
        grid.probability.rows() == size.x() &&
        grid.probability.cols() == size.y());
  proto::Grid2D result;
  *result.mutable_limits() = MakeLimits(grid.geometry, T_local_submap);
  result.mutable_probability_grid_2d();
  result.set_min_correspondence_cost(kMinCost);
  result.set_max_correspondence_cost(kMaxCost);
  result.mutable_cells()->Resize(size.x() * size.y(), kUnknownValue);
  Eigen::Array2i min_known = size;
  Eigen::Array2i max_known = Eigen::Array2i::Constant(-1);
  for (int j = 0; j < size.y(); ++j) {
    for (int i = 0; i < size.x(); ++i) {
      if (!grid.known(i, j)) continue;
      result.set_cells(
          FlatIndex(size, i, j),
          FloatToValue(1.f - grid.probability(i, j), kMinCost, kMaxCost));
      min_known = min_known.min(Eigen::Array2i(i, j));
      max_known = max_known.max(Eigen::Array2i(i, j));
    }
  }
  if ((max_known >= 0).all()) {
    proto::CellBox& box = *result.mutable_known_cells_box();
    box.set_min_x(size.y() - 1 - max_known.y());
    box.set_min_y(size.x() - 1 - max_known.x());
    box.set_max_x(size.y() - 1 - min_known.y());
    box.set_max_y(size.x() - 1 - min_known.x());
  }
  return result;
}

}  // namespace cartographer_sdf
