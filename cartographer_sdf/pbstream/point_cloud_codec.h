// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Cartographer's compressed point clouds: points rounded to millimetres, sorted
// into blocks of 1.024 m, each block its number of points, its three integer
// coordinates, and one integer of three times ten bits per point.

#ifndef CARTOGRAPHER_SDF_PBSTREAM_POINT_CLOUD_CODEC_H_
#define CARTOGRAPHER_SDF_PBSTREAM_POINT_CLOUD_CODEC_H_

#include "absl/status/statusor.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/serialized_state.pb.h"

namespace cartographer_sdf {

// Beyond it, neither the host nor we can encode a coordinate [m].
constexpr float kMaxEncodedCoordinate = 8388.f;

// Blocks are in the order of their coordinates, points within a block in the
// order given; z is 0. Coordinates must lie within kMaxEncodedCoordinate.
[[nodiscard]] proto::CompressedPointCloud CompressPointCloud(
    const PointCloud2& points);

// Drops z. The error says what is wrong, not where.
[[nodiscard]] absl::StatusOr<PointCloud2> DecompressPointCloud(
    const proto::CompressedPointCloud& cloud);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_POINT_CLOUD_CODEC_H_
