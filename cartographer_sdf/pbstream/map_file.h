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
#include <utility>
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

// What to make of submaps and nodes of the pose graph that have no record of
// their own. The pose graph is at the beginning of a file: a file that was cut
// at the border of a record has all poses, but no data of what comes later.
enum class MissingRecords {
  kRefuse,  // an error that says how many
  kDrop,    // the pose graph lacks them, and their constraints
  kKeep,    // the pose graph has them: to look at a map, not to change it
};

// Whether a map is read and written with its odometry, or as if it had none.
// The host weighs odometry as its own configuration says, which no file can
// change: a map that is better than its odometry keeps its shape without it.
enum class OdometryRecords { kKeep, kDrop };

// A map to read. A path alone is one that must be whole.
struct MapSource {
  MapSource(std::string path,  // NOLINT: a path is a map
            const MissingRecords missing_records = MissingRecords::kRefuse,
            const OdometryRecords odometry_records = OdometryRecords::kKeep)
      : path(std::move(path)),
        missing_records(missing_records),
        odometry_records(odometry_records) {}
  MapSource(const char* const path)  // NOLINT: as above
      : MapSource(std::string(path)) {}

  std::string path;
  MissingRecords missing_records;
  OdometryRecords odometry_records;
};

struct MapState {
  int format_version = 0;
  PoseGraph pose_graph;
  std::map<SubmapId, SubmapSummary> submaps;
  // Ids, in file order.
  std::vector<int> trajectories;
  // Number of records of each kind, by the name of the SerializedData field
  // ("submap", "node", "imu_data", ..., "unknown").
  std::map<std::string, int> num_records;
  // Without a record of their own, whatever was made of them.
  int num_unrecorded_submaps = 0;
  int num_unrecorded_nodes = 0;
  // How it was read; without odometry, its records are not among num_records.
  OdometryRecords odometry_records = OdometryRecords::kKeep;
  int num_dropped_odometry_records = 0;
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
    const MapSource& source, const MapVisitor& visitor = {},
    const ProgressCallback& on_progress = {});

// Reads the beginning of the file only: the ids of its trajectories, in file
// order.
[[nodiscard]] absl::StatusOr<std::vector<int>> ReadTrajectories(
    const std::string& path);

// Returns an error unless the map has each of these trajectories. Reads nothing
// if there are none, else the beginning of the file.
[[nodiscard]] absl::Status CheckHasTrajectories(
    const std::string& path, const std::set<int>& trajectories);

// Returns the filtered range data of the given nodes, without nodes that have
// none. Reads the whole map: a caller that reads it anyway should pass a
// visitor to ReadMap() instead.
[[nodiscard]] absl::StatusOr<std::map<NodeId, PointCloud2>> ReadPointClouds(
    const MapSource& source, const std::set<NodeId>& nodes,
    const ProgressCallback& on_progress = {});

// Copies `input` to `output` with the constraints and the poses of submaps,
// nodes and landmarks of `pose_graph`. Every other record is copied byte for
// byte in its compressed form, and so is the pose graph if it equals that of
// ReadMap(input). Unknown fields are preserved everywhere.
//
// - Poses that differ are written as the host writes optimised ones. Others
//   stay unchanged, as do elements that `pose_graph` lacks.
// - Submaps and nodes without a record of their own, and their constraints, are
//   left out of the output; by default, an input that has such is refused.
// - Constraints become those of `pose_graph`, in its order. The k-th constraint
//   of a submap, node and tag corresponds to the k-th one in the input and
//   keeps every unchanged value, above all its pose in space. Surplus
//   constraints of the input are dropped; surplus ones of `pose_graph` are new.
// - Odometry is left out if the source says so.
//
// The output appears complete or not at all, and may be the input. Fails if
// the input cannot be read, or if `pose_graph` has elements that the input
// lacks or non-finite numbers. Relative odometry of nodes is not written.
// Before it appears, the output is read with all checks of ReadMap(), scans
// included: what the host would not load is never written.
//
// Decompresses the input once, or twice if `pose_graph` lacks nodes or has
// other gravity alignments than the input, see map_reader.h.
[[nodiscard]] absl::Status WriteMap(const MapSource& input,
                                    const std::string& output,
                                    const PoseGraph& pose_graph,
                                    const ProgressCallback& on_progress = {});

// WriteMap() in two steps, for callers that have work to do before the commit
// or want to visit the content of the input as it passes. The map appears only
// with Commit() of the result; without it, nothing is left behind.
[[nodiscard]] absl::StatusOr<RecordWriter> PrepareMap(
    const MapSource& input, const std::string& output,
    const PoseGraph& pose_graph, const MapVisitor& visitor = {},
    const ProgressCallback& on_progress = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_MAP_FILE_H_
