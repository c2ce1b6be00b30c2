// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/panorama_file.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/localization/union_grid.h"
#include "cartographer_sdf/pbstream/record_stream.h"
#include "cartographer_sdf/place_index.pb.h"

namespace cartographer_sdf {
namespace {

using ProtoPanoramas = proto::place_index::Panoramas;

// Increment it with every change of the format or of what is made of a map.
constexpr int kPanoramaVersion = 1001;
constexpr size_t kNumCellPlanes = 5;
constexpr double kMaxStoredMapCoordinate = 1e7;  // [m]

void EncodeGrid(const OccupancyGrid& grid, ProtoPanoramas* const proto) {
  const CellGeometry& geometry = grid.geometry;
  proto->set_num_cells_x(geometry.size.x());
  proto->set_num_cells_y(geometry.size.y());
  proto->set_resolution(geometry.resolution);
  proto::place_index::Pose& pose = *proto->mutable_t_submap_grid();
  pose.set_x(geometry.T_submap_grid.translation().x());
  pose.set_y(geometry.T_submap_grid.translation().y());
  pose.set_rotation(geometry.T_submap_grid.rotation());
  const size_t n = static_cast<size_t>(grid.known.size());
  std::string& bytes = *proto->mutable_cells();
  bytes.resize(kNumCellPlanes * n);
  for (size_t k = 0; k < n; ++k) {
    uint32_t bits;
    std::memcpy(&bits, grid.probability.data() + k, sizeof(bits));
    for (size_t plane = 0; plane < sizeof(bits); ++plane) {
      bytes[plane * n + k] = static_cast<char>(bits >> (8 * plane) & 0xff);
    }
    bytes[4 * n + k] = static_cast<char>(grid.known.data()[k]);
  }
}

void EncodeViewpoints(const Viewpoints& viewpoints,
                      ProtoPanoramas* const proto) {
  proto->set_step(viewpoints.step);
  for (size_t k = 0; k < viewpoints.positions.size(); ++k) {
    // The middle of a cell.
    for (const double coordinate :
         {viewpoints.positions[k].x(), viewpoints.positions[k].y()}) {
      proto->add_viewpoints(static_cast<int>(std::floor(coordinate)));
    }
    const auto append = [](const uint8_t* const panorama,
                           std::string* const bytes) {
      bytes->append(panorama, panorama + kNumDirections);
    };
    append(viewpoints.RangesOf(k), proto->mutable_ranges());
    append(viewpoints.MasksOf(k), proto->mutable_masks());
  }
}

// Each returns the problem, or an empty string.
std::string DecodeGrid(const ProtoPanoramas& proto, OccupancyGrid* const grid) {
  const int64_t width = proto.num_cells_x(), height = proto.num_cells_y();
  if (width < 1 || height < 1 || width > UnionGrid::kMaxNumCells ||
      width * height > UnionGrid::kMaxNumCells) {
    return "has a grid of an impossible size";
  }
  const size_t n = static_cast<size_t>(width * height);
  const std::string& bytes = proto.cells();
  if (bytes.size() != kNumCellPlanes * n) {
    return "has a grid whose cells do not match its size";
  }
  const proto::place_index::Pose& pose = proto.t_submap_grid();
  if (!(proto.resolution() >= 1e-4 && proto.resolution() <= 100.) ||
      !(std::abs(pose.x()) <= kMaxStoredMapCoordinate) ||
      !(std::abs(pose.y()) <= kMaxStoredMapCoordinate) ||
      !(std::abs(pose.rotation()) <= M_PI)) {
    return "has a grid of an impossible resolution or pose";
  }
  CellGeometry geometry;
  geometry.size = {static_cast<int>(width), static_cast<int>(height)};
  geometry.resolution = proto.resolution();
  geometry.T_submap_grid = Rigid2(pose.x(), pose.y(), pose.rotation());
  *grid = UnknownGrid(geometry);
  for (size_t k = 0; k < n; ++k) {
    uint32_t bits = 0;
    for (size_t plane = 0; plane < sizeof(bits); ++plane) {
      bits |= static_cast<uint32_t>(static_cast<uint8_t>(bytes[plane * n + k]))
              << (8 * plane);
    }
    float probability;
    std::memcpy(&probability, &bits, sizeof(bits));
    if (!(probability > 0.f && probability < 1.f)) {
      return "has a cell with an impossible probability";
    }
    grid->probability.data()[k] = probability;
    grid->known.data()[k] = bytes[4 * n + k] != 0;
  }
  return "";
}

std::string DecodeViewpoints(const ProtoPanoramas& proto,
                             const CellGeometry& geometry,
                             Viewpoints* const viewpoints) {
  const size_t count = static_cast<size_t>(proto.viewpoints_size()) / 2;
  if (count == 0 || proto.viewpoints_size() % 2 != 0 ||
      proto.ranges().size() != kNumDirections * count ||
      proto.masks().size() != kNumDirections * count) {
    return "has panoramas that do not match its viewpoints";
  }
  if (!(proto.step() > 0. && proto.step() <= 1e4)) {
    return "has viewpoints at an impossible distance";
  }
  viewpoints->step = proto.step();
  for (size_t k = 0; k < count; ++k) {
    const Eigen::Array2i cell(proto.viewpoints(static_cast<int>(2 * k)),
                              proto.viewpoints(static_cast<int>(2 * k + 1)));
    if (!geometry.Contains(cell)) return "has a viewpoint outside of its grid";
    viewpoints->positions.push_back(cell.matrix().cast<double>().array() + 0.5);
    const auto append = [k](const std::string& bytes,
                            std::vector<uint8_t>* const panoramas) {
      // Twice in a row, see Viewpoints.
      for (int turn = 0; turn < 2; ++turn) {
        const auto begin =
            bytes.begin() + static_cast<std::ptrdiff_t>(kNumDirections * k);
        std::transform(begin, begin + kNumDirections,
                       std::back_inserter(*panoramas),
                       [](const char c) { return static_cast<uint8_t>(c); });
      }
    };
    append(proto.ranges(), &viewpoints->ranges);
    append(proto.masks(), &viewpoints->masks);
  }
  const bool are_masks =
      std::all_of(viewpoints->masks.begin(), viewpoints->masks.end(),
                  [](const uint8_t mask) { return mask == 0 || mask == 255; });
  return are_masks ? "" : "has an impossible mask";
}

absl::StatusOr<DrawnMap> DecodePanoramas(const RecordReader& reader,
                                         const std::string& record) {
  ProtoPanoramas proto;
  if (!proto.ParseFromString(record)) {
    return reader.Corrupted("has no panoramas");
  }
  OccupancyGrid grid;
  std::string problem = DecodeGrid(proto, &grid);
  if (!problem.empty()) return reader.Corrupted(problem);
  std::optional<RayMap> rays = MakeRayMap(grid);
  if (!rays) return reader.Corrupted("has a grid without walls");
  Viewpoints viewpoints;
  problem = DecodeViewpoints(proto, rays->geometry(), &viewpoints);
  if (!problem.empty()) return reader.Corrupted(problem);
  return DrawnMap{std::move(grid),
                  MakePanoramaMap(*std::move(rays), std::move(viewpoints))};
}

}  // namespace

PlaceFileKey MakeGridKey(const OccupancyGrid& grid,
                         const std::string& options) {
  ProtoPanoramas proto;
  EncodeGrid(grid, &proto);
  const std::string bytes = proto.SerializeAsString();
  PlaceFileKey key;
  key.options = options;
  key.map_size = static_cast<int64_t>(bytes.size());
  key.map_hash = 0xcbf29ce484222325u;  // FNV-1a, as of a file
  for (const char byte : bytes) {
    key.map_hash ^= static_cast<unsigned char>(byte);
    key.map_hash *= 0x100000001b3u;
  }
  return key;
}

std::string FormatPanoramaOptions(const ViewpointOptions& options) {
  return absl::StrFormat("panoramas: step %.17g, at most %d, clearance %.17g",
                         options.step_meters, options.max_num_viewpoints,
                         options.min_clearance_meters);
}

absl::Status WritePanoramas(const std::string& path, const PlaceFileKey& key,
                            const DrawnMap& map) {
  absl::StatusOr<RecordWriter> writer = RecordWriter::Open(path);
  if (!writer.ok()) return writer.status();
  ProtoPanoramas proto;
  EncodeGrid(map.grid, &proto);
  EncodeViewpoints(map.panoramas.viewpoints, &proto);
  absl::Status status =
      writer->Write(EncodePlaceFileHeader(key, kPanoramaVersion, 1));
  if (status.ok()) status = writer->Write(proto.SerializeAsString());
  return status.ok() ? writer->Commit() : status;
}

absl::StatusOr<DrawnMap> ReadPanoramas(const std::string& path,
                                       const PlaceFileKey& key) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    return absl::NotFoundError(absl::StrCat("there is no ", path));
  }
  absl::StatusOr<RecordReader> reader = RecordReader::Open(path);
  if (!reader.ok()) return reader.status();
  std::string record;
  absl::StatusOr<bool> has_record = reader->Read(&record);
  if (!has_record.ok()) return has_record.status();
  const absl::Status status = CheckPlaceFileHeader(
      path, key, kPanoramaVersion, *has_record ? record : std::string());
  if (!status.ok()) return status;
  has_record = reader->Read(&record);
  if (!has_record.ok()) return has_record.status();
  if (!*has_record) {
    return absl::DataLossError(absl::StrCat(path, " has no panoramas"));
  }
  absl::StatusOr<DrawnMap> map = DecodePanoramas(*reader, record);
  if (!map.ok()) return map;
  has_record = reader->Read(&record);
  if (!has_record.ok()) return has_record.status();
  if (*has_record) return reader->Corrupted("is one too many");
  return map;
}

}  // namespace cartographer_sdf
