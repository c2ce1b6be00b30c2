// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Maps whose records are damaged behind their compression. An input is a list
// of records, each after its length in four bytes: what is mutated are
// protocol buffers, not gzip.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cartographer_sdf/pbstream/map_file.h"
#include "glog/logging.h"
#include "test/fuzz/fuzz_target.h"
#include "test/testing/small_map.h"

namespace cartographer_sdf {
namespace fuzz {
namespace {

constexpr size_t kLengthSize = 4;

std::string Packed(const std::vector<std::string>& records) {
  std::string bytes;
  for (const std::string& record : records) {
    bytes += testing::LittleEndian(record.size()).substr(0, kLengthSize);
    bytes += record;
  }
  return bytes;
}

std::vector<std::string> Unpacked(std::string bytes) {
  std::vector<std::string> records;
  while (bytes.size() >= kLengthSize) {
    size_t length = 0;
    for (size_t k = kLengthSize; k-- > 0;) {
      length = length << 8 | static_cast<unsigned char>(bytes[k]);
    }
    records.push_back(bytes.substr(kLengthSize, length));
    bytes.erase(0, kLengthSize + std::min(length, bytes.size() - kLengthSize));
  }
  return records;
}

}  // namespace

std::vector<std::string> Seeds() {
  testing::SmallMap tsdf;
  proto::Grid2D& grid = *tsdf.submaps[0].mutable_submap_2d()->mutable_grid();
  grid.clear_probability_grid_2d();
  grid.mutable_tsdf_2d()->set_truncation_distance(0.3f);
  grid.mutable_tsdf_2d()->set_max_weight(10.f);
  for (int k = 0; k < grid.cells_size(); ++k) {
    grid.mutable_tsdf_2d()->add_weight_cells(100 * k);
  }
  testing::SmallMap cut;
  cut.nodes.resize(2);
  return {Packed(testing::SmallMap().Records()), Packed(tsdf.Records()),
          Packed(cut.Records())};
}

}  // namespace fuzz

namespace {

// What was read is fit for use, and so is what is written from it.
void CheckMap(const std::string& path, const MissingRecords missing_records) {
  const auto check_cloud = [](const NodeId&, const PointCloud2& cloud) {
    for (const Eigen::Vector2f& point : cloud) CHECK(point.allFinite());
  };
  const auto check_grid = [](const SubmapId&, const SubmapSummary&,
                             const OccupancyGrid& grid) {
    CHECK(grid.probability.isFinite().all());
  };
  const absl::StatusOr<MapState> state =
      ReadMap({path, missing_records}, {check_grid, check_cloud});
  if (!state.ok()) {
    CHECK(!state.status().message().empty());
    return;
  }
  PoseGraph graph = state->pose_graph;
  for (auto& [id, node] : graph.nodes) {
    CHECK(node.T_map_node.translation().allFinite());
    CHECK(std::isfinite(node.T_map_node.rotation()));
    node.T_map_node = Rigid2(1., 0., 0.1) * node.T_map_node;
  }
  const std::string output = path + ".out";
  const absl::Status status = WriteMap({path, missing_records}, output, graph);
  if (missing_records == MissingRecords::kKeep) return;
  // Moved out of range, at most.
  if (!status.ok()) return;
  CHECK(ReadMap(output).ok());
}

}  // namespace
}  // namespace cartographer_sdf

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* const data,
                                      const size_t size) {
  using namespace cartographer_sdf;  // NOLINT
  const std::string path = fuzz::WriteInput(
      "map.pbstream", testing::Container(fuzz::Unpacked(std::string(
                          reinterpret_cast<const char*>(data), size))));
  CheckMap(path, MissingRecords::kRefuse);
  CheckMap(path, MissingRecords::kDrop);
  CheckMap(path, MissingRecords::kKeep);
  return 0;
}
