// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Cartographer's serialized state (.pbstream), 2D, format versions 1 and 2:
// read what the core needs, and write a corrected copy that keeps every other
// record as it is. Files are streamed: memory holds the pose graph and one
// record at a time, never the grids or the sensor data of the whole file.
//
// Any bytes give a map or one clear sentence, never a crash. What the host
// would not load is an error: ids that do not match, odometry out of order, ...

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

// What the file says of a submap, beside its pose in the pose graph.
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
  // A submap or node may be here without a record of its own.
  PoseGraph pose_graph;
  std::map<SubmapId, SubmapSummary> submaps;
  // Ids, in the order of the file.
  std::vector<int> trajectories;
  // Number of records of each kind, by the name of the field of
  // SerializedData ("submap", "node", "imu_data", ..., "unknown").
  std::map<std::string, int> num_records;
};

// Called for each submap with a grid. The grid is in the submap frame; a TSDF's
// cells become the occupancy that its distance implies, see grid_conversion.h.
using SubmapCallback = std::function<void(const SubmapId&, const SubmapSummary&,
                                          const OccupancyGrid&)>;
// Called for each node with filtered range data.
using PointCloudCallback = std::function<void(const NodeId&, PointCloud2)>;

// Gets the content of a map that is too large to be kept, in file order, while
// the file is read. Point clouds are decoded where somebody wants them alone.
struct MapVisitor {
  SubmapCallback on_submap = {};
  PointCloudCallback on_point_cloud = {};
};

// Decompresses the file once, whatever is visited. Progress is that of bytes.
[[nodiscard]] absl::StatusOr<MapState> ReadMap(
    const std::string& path, const MapVisitor& visitor = {},
    const ProgressCallback& on_progress = {});

// The filtered range data of the given nodes; a node without data is absent.
// ReadMap() with a visitor: who reads the map anyway is better off with one.
[[nodiscard]] absl::StatusOr<std::map<NodeId, PointCloud2>> ReadPointClouds(
    const std::string& path, const std::set<NodeId>& nodes,
    const ProgressCallback& on_progress = {});

// Copies `input` to `output` with the poses of submaps, nodes and landmarks and
// the constraints of `pose_graph`; every other record is copied byte for byte,
// compressed as it is, and so is the pose graph if nothing differs from
// ReadMap(input). Unknown fields survive everywhere.
//
// - Poses that differ are written as the host writes optimised ones, others
//   stay as they are, as do elements that `pose_graph` lacks.
// - Constraints become those of `pose_graph`, in its order: the k-th of a
//   submap, node and tag is the k-th that the input has of them, and keeps what
//   does not differ, its pose in space above all; what the input has beyond
//   that is dropped, what `pose_graph` has beyond that is new.
//
// The output appears when it is whole or not at all, and may be the input. An
// error too if `pose_graph` has elements that the input lacks, or numbers that
// are not finite, or where ReadMap(input) fails. Odometry is not written.
//
// Decompresses the input once, and twice where `pose_graph` lacks nodes or has
// other gravity alignments than the input, see map_reader.h.
[[nodiscard]] absl::Status WriteMap(const std::string& input,
                                    const std::string& output,
                                    const PoseGraph& pose_graph,
                                    const ProgressCallback& on_progress = {});

// WriteMap() in two steps, for those who have something to do between, and who
// want to see the content of the input as it passes. The map does not appear
// before Commit() of the result; without it, it leaves nothing behind.
[[nodiscard]] absl::StatusOr<RecordWriter> PrepareMap(
    const std::string& input, const std::string& output,
    const PoseGraph& pose_graph, const MapVisitor& visitor = {},
    const ProgressCallback& on_progress = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_MAP_FILE_H_
