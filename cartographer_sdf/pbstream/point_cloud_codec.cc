// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/point_cloud_codec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr float kPrecision = 0.001f;  // [m]
constexpr int kBitsPerCoordinate = 10;
constexpr int kCoordinateMask = (1 << kBitsPerCoordinate) - 1;
constexpr int kPointLimit = 1 << (3 * kBitsPerCoordinate);
// Coordinates of at most 2^23 mm, in blocks of 2^10 mm.
constexpr int kMaxBlockCoordinate = 1 << (23 - kBitsPerCoordinate);
// Number of points and three coordinates.
constexpr int kBlockHeaderSize = 4;

int RoundToMillimetres(const float coordinate) {
  CHECK_LE(std::abs(coordinate), kMaxEncodedCoordinate);
  return static_cast<int>(std::lround(coordinate / kPrecision));
}

float Coordinate(const int block, const int offset) {
  return static_cast<float>(block * (1 << kBitsPerCoordinate) + offset) *
         kPrecision;
}

absl::Status CheckBlockHeader(const int* const header,
                              const int64_t num_values_left) {
  if (header[0] <= 0 || header[0] > num_values_left) {
    return absl::DataLossError(absl::StrCat(
        "has a point cloud with a block of ", header[0], " points"));
  }
  for (int i = 1; i < kBlockHeaderSize; ++i) {
    if (std::abs(static_cast<int64_t>(header[i])) > kMaxBlockCoordinate) {
      return absl::DataLossError("has a point cloud that is too large");
    }
  }
  return absl::OkStatus();
}

}  // namespace

proto::CompressedPointCloud CompressPointCloud(const PointCloud2& points) {
  std::map<std::array<int, 2>, std::vector<int>> blocks;
  for (const Eigen::Vector2f& point : points) {
    const int x = RoundToMillimetres(point.x());
    const int y = RoundToMillimetres(point.y());
    // Arithmetic shift: floor, for negative coordinates too.
    blocks[{x >> kBitsPerCoordinate, y >> kBitsPerCoordinate}].push_back(
        (y & kCoordinateMask) << kBitsPerCoordinate | (x & kCoordinateMask));
  }
  proto::CompressedPointCloud cloud;
  cloud.set_num_points(static_cast<int>(points.size()));
  for (const auto& [block, encoded_points] : blocks) {
    cloud.add_point_data(static_cast<int>(encoded_points.size()));
    cloud.add_point_data(block[0]);
    cloud.add_point_data(block[1]);
    cloud.add_point_data(0);
    for (const int point : encoded_points) cloud.add_point_data(point);
  }
  return cloud;
}

absl::StatusOr<PointCloud2> DecompressPointCloud(
    const proto::CompressedPointCloud& cloud) {
  PointCloud2 points;
  // Bounded by the data present, whatever size is claimed.
  points.reserve(static_cast<size_t>(
      std::clamp(cloud.num_points(), 0, cloud.point_data_size())));
  const int* value = cloud.point_data().data();
  const int* const end = value + cloud.point_data_size();
  while (value != end) {
    if (end - value < kBlockHeaderSize) {
      return absl::DataLossError("has a point cloud that ends too early");
    }
    const int* const header = value;
    value += kBlockHeaderSize;
    const absl::Status status = CheckBlockHeader(header, end - value);
    if (!status.ok()) return status;
    for (const int* const block_end = value + header[0]; value != block_end;
         ++value) {
      if (*value < 0 || *value >= kPointLimit) {
        return absl::DataLossError("has a point cloud with an invalid point");
      }
      points.emplace_back(Coordinate(header[1], *value & kCoordinateMask),
                          Coordinate(header[2], *value >> kBitsPerCoordinate &
                                                    kCoordinateMask));
    }
  }
  if (static_cast<int64_t>(points.size()) != cloud.num_points()) {
    return absl::DataLossError(
        absl::StrCat("has a point cloud of ", points.size(),
                     " points that claims to have ", cloud.num_points()));
  }
  return points;
}

}  // namespace cartographer_sdf
