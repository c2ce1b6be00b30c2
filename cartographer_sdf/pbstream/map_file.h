// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Reads Cartographer's serialized state (.pbstream; 2D, format versions 1 and
// 2) as far as the core needs it, and writes a corrected copy that keeps every
// other record unchanged. Files are streamed: memory holds the pose graph and
// one record at a time, never the grids or the sensor data of the whole file.
//
// Any input yields a map or a one-sentence error, never a crash. A file that
// the host would not load is an error: ids that do not match, odometry out of
// order, ...

#ifndef CARTOGRAPHER_SDF_PBSTREAM_MAP_FILE_H_
#define CARTOGRAPHER_SDF_PBSTREAM_MAP_FILE_H_

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_sdf/execution/progress.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/pbstream/record_stream.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

// Content of a submap's record.
struct SubmapSummary {
  bool finished = false;
  int num_range_data = 0;
  Rigid2 T_local_submap;
  bool is_tsdf = false;
  // Size and resolution of the stored grid.
  CellGeometry geometry;
  int num_known_cells = 0;
};

struct MapState {
  int format_version = 0;
  // Submaps and nodes may lack a record of their own.
  PoseGraph pose_graph;
  std::map<SubmapId, SubmapSummary> submaps;
  // Ids, in file order.
  std::vector<int> trajectories;
  // Number of records of each kind, by the name of the SerializedData field
  // ("submap", "node", "imu_data", ..., "unknown").
  std::map<std::string, int> num_records;
};

// Called for each submap with a grid, to keep or to read. The grid is in the
// submap frame; the cells of a TSDF are converted to occupancy, see
// grid_conversion.h.
using SubmapCallback =
    std::function<void(const SubmapId&, const SubmapSummary&, OccupancyGrid)>;
// Called for each node with filtered range data.
using PointCloudCallback = std::function<void(const NodeId&, PointCloud2)>;

// Receives the content of a map that is too large to keep, in file order, while
// the file is read. Point clouds are decoded only if on_point_cloud is set.
struct MapVisitor {
  SubmapCallback on_submap = {};
  PointCloudCallback on_point_cloud = {};
};

// Decompresses the file once, with any visitor. Progress is the fraction of
// bytes read.
[[nodiscard]] absl::StatusOr<MapState> ReadMap(
    const std::string& path, const MapVisitor& visitor = {},
    const ProgressCallback& on_progress = {});

// Returns the filtered range data of the given nodes, without nodes that have
// none. Reads the whole map: a caller that reads it anyway should pass a
// visitor to ReadMap() instead.
[[nodiscard]] absl::StatusOr<std::map<NodeId, PointCloud2>> ReadPointClouds(
    const std::string& path, const std::set<NodeId>& nodes,
    const ProgressCallback& on_progress = {});

// Copies `input` to `output` with the constraints and the poses of submaps,
// nodes and landmarks of `pose_graph`. Every other record is copied byte for
// byte in its compressed form, and so is the pose graph if it equals that of
// ReadMap(input). Unknown fields are preserved everywhere.
//
// - Poses that differ are written as the host writes optimised ones. Others
//   stay unchanged, as do elements that `pose_graph` lacks.
// - Constraints become those of `pose_graph`, in its order. The k-th constraint
//   of a submap, node and tag corresponds to the k-th one in the input and
//   keeps every unchanged value, above all its pose in space. Surplus
//   constraints of the input are dropped; surplus ones of `pose_graph` are new.
//
// The output appears complete or not at all, and may be the input. Fails if
// ReadMap(input) fails, or if `pose_graph` has elements that the input lacks or
// non-finite numbers. Odometry is not written.
//
// Decompresses the input once, or twice if `pose_graph` lacks nodes or has
// other gravity alignments than the input, see map_reader.h.
[[nodiscard]] absl::Status WriteMap(const std::string& input,
                                    const std::string& output,
                                    const PoseGraph& pose_graph,
                                    const ProgressCallback& on_progress = {});

// WriteMap() in two steps, for callers that have work to do before the commit
// or want to visit the content of the input as it passes. The map appears only
// with Commit() of the result; without it, nothing is left behind.
[[nodiscard]] absl::StatusOr<RecordWriter> PrepareMap(
    const std::string& input, const std::string& output,
    const PoseGraph& pose_graph, const MapVisitor& visitor = {},
    const ProgressCallback& on_progress = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_MAP_FILE_H_
