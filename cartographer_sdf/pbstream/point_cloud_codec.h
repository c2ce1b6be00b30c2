// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Encodes and decodes Cartographer's compressed point clouds: points rounded to
// millimetres and sorted into blocks of 1.024 m. A block holds its number of
// points, its three integer coordinates, and one integer of three times ten
// bits per point.

#ifndef CARTOGRAPHER_SDF_PBSTREAM_POINT_CLOUD_CODEC_H_
#define CARTOGRAPHER_SDF_PBSTREAM_POINT_CLOUD_CODEC_H_

#include "absl/status/statusor.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/serialized_state.pb.h"

namespace cartographer_sdf {

// Largest coordinate that the host or this code can encode [m].
constexpr float kMaxEncodedCoordinate = 8388.f;

// Blocks are ordered by their coordinates, points within a block as given; z is
// 0. Coordinates must lie within kMaxEncodedCoordinate.
[[nodiscard]] proto::CompressedPointCloud CompressPointCloud(
    const PointCloud2& points);

// Drops z. An error states the problem, not where it is.
[[nodiscard]] absl::StatusOr<PointCloud2> DecompressPointCloud(
    const proto::CompressedPointCloud& cloud);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_POINT_CLOUD_CODEC_H_
