// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/place_store/place_file.h"

#include <array>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/pbstream/record_stream.h"
#include "cartographer_sdf/place_index.pb.h"

namespace cartographer_sdf {
namespace {

constexpr char kKind[] = "cartographer_sdf places";
// Increment it with every change of the format *or of the description of
// submaps*.
constexpr int kVersion = 3;

absl::Status CheckHeader(const std::string& path, const PlaceFileKey& key,
                         const int version,
                         const proto::place_index::Header& header) {
  const auto refuse = [&path](const absl::string_view problem) {
    return absl::FailedPreconditionError(absl::StrCat(path, " ", problem));
  };
  if (header.kind() != kKind) return refuse("is not a place file");
  if (header.version() != version) {
    return refuse(absl::StrCat("has places of version ", header.version(),
                               ", not ", version));
  }
  if (header.map_hash() != key.map_hash || header.map_size() != key.map_size) {
    return refuse("has the places of another map");
  }
  if (header.options() != key.options) {
    return refuse("has places that were described with other options");
  }
  return absl::OkStatus();
}

// All places after the header.
absl::StatusOr<std::map<SubmapId, Place>> ReadRecords(
    RecordReader* const reader) {
  std::map<SubmapId, Place> places;
  std::optional<Eigen::Index> descriptor_length;
  std::string record;
  while (true) {
    const absl::StatusOr<bool> has_record = reader->Read(&record);
    if (!has_record.ok()) return has_record.status();
    if (!*has_record) return places;
    absl::StatusOr<Place> place = DecodePlace(record);
    if (!place.ok()) return reader->Corrupted(place.status().message());
    if (!place->features.features.empty()) {
      const Eigen::Index length = place->features.descriptors.rows();
      if (length != descriptor_length.value_or(length)) {
        return reader->Corrupted("has descriptors of another length");
      }
      descriptor_length = length;
    }
    const SubmapId id = place->id;
    if (!places.emplace(id, *std::move(place)).second) {
      return reader->Corrupted("has a duplicate place");
    }
  }
}

constexpr uint64_t kHashOffset = 0xcbf29ce484222325u;  // FNV-1a
constexpr std::streamsize kHashedWordSize = 8;

uint64_t HashOn(const char* const bytes, const std::streamsize count,
                uint64_t hash) {
  for (std::streamsize k = 0; k < count; ++k) {
    hash ^= static_cast<unsigned char>(bytes[k]);
    hash *= 0x100000001b3u;
  }
  return hash;
}

// A pose graph is the second record, behind the header.
constexpr int kPoseGraphRecord = 1;

struct HashedMap {
  uint64_t hash;
  int64_t size;
};

// Of the length of each record and of the end of its gzip member, which has a
// checksum and the size of what it holds; none if the file is no container.
std::optional<HashedMap> HashOfRecords(const PoseGraphInKey pose_graph,
                                       const int64_t size,
                                       std::ifstream* const file) {
  std::array<char, kHashedWordSize> word;
  file->seekg(0);
  if (!file->read(word.data(), kHashedWordSize)) return std::nullopt;
  HashedMap map{HashOn(word.data(), kHashedWordSize, kHashOffset), size};
  int64_t at = kHashedWordSize;
  for (int record = 0; at < size; ++record) {
    if (!file->read(word.data(), kHashedWordSize)) return std::nullopt;
    const bool is_covered =
        record != kPoseGraphRecord || pose_graph == PoseGraphInKey::kYes;
    if (is_covered) map.hash = HashOn(word.data(), kHashedWordSize, map.hash);
    uint64_t length = 0;
    for (int k = kHashedWordSize - 1; k >= 0; --k) {
      length = length << 8 | static_cast<unsigned char>(word[k]);
    }
    at += kHashedWordSize;
    if (length < kHashedWordSize || length > static_cast<uint64_t>(size - at)) {
      return std::nullopt;
    }
    at += static_cast<int64_t>(length);
    if (!is_covered) map.size -= static_cast<int64_t>(length);
    file->seekg(at - kHashedWordSize);
    if (!file->read(word.data(), kHashedWordSize)) return std::nullopt;
    if (is_covered) map.hash = HashOn(word.data(), kHashedWordSize, map.hash);
  }
  return map;
}

std::optional<HashedMap> HashOfBytes(const int64_t size,
                                     std::ifstream* const file) {
  file->clear();
  file->seekg(0);
  uint64_t hash = kHashOffset;
  std::vector<char> buffer(1 << 16);
  while (file->good()) {
    file->read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    hash = HashOn(buffer.data(), file->gcount(), hash);
  }
  if (!file->eof()) return std::nullopt;
  return HashedMap{hash, size};
}

using ProtoPlace = proto::place_index::Place;

constexpr int kNumbersPerFeature = 5;
// Bound on the number of cells of a grid, as of those in maps.
constexpr int64_t kMaxNumCells = int64_t{1} << 26;
// Bound on coordinates within a submap [m].
constexpr double kMaxStoredCoordinate = 1e5;

bool IsCoordinate(const double value) {
  return std::abs(value) <= kMaxStoredCoordinate;  // false for NaN
}

proto::place_index::Pose PoseToProto(const Rigid2& pose) {
  proto::place_index::Pose proto;
  proto.set_x(pose.translation().x());
  proto.set_y(pose.translation().y());
  proto.set_rotation(pose.rotation());
  return proto;
}

bool FromProto(const proto::place_index::Pose& proto, Rigid2* const pose) {
  if (!IsCoordinate(proto.x()) || !IsCoordinate(proto.y()) ||
      !(std::abs(proto.rotation()) <= M_PI)) {
    return false;
  }
  *pose = Rigid2(proto.x(), proto.y(), proto.rotation());
  return true;
}

std::string EncodeRuns(const std::vector<uint16_t>& runs) {
  std::string bytes;
  bytes.reserve(2 * runs.size());
  for (const uint16_t word : runs) {
    bytes.push_back(static_cast<char>(word & 0xff));
    bytes.push_back(static_cast<char>(word >> 8));
  }
  return bytes;
}

void EncodeSurface(const SurfaceModel& surface, ProtoPlace* const proto) {
  // Fails to compile if a new member would be lost.
  const auto& [geometry, cells, walls, observed_points, area, poses] = surface;
  proto->set_num_cells_x(geometry.size.x());
  proto->set_num_cells_y(geometry.size.y());
  proto->set_resolution(geometry.resolution);
  *proto->mutable_t_submap_grid() = PoseToProto(geometry.T_submap_grid);
  proto->set_runs(EncodeRuns(cells.Pack().runs));
  for (const SurfacePoint& wall : walls) {
    proto->add_walls(wall.position.x());
    proto->add_walls(wall.position.y());
    proto->add_walls(wall.weight);
  }
  for (const Eigen::Vector2d& point : observed_points) {
    proto->add_observed_points(point.x());
    proto->add_observed_points(point.y());
  }
  proto->set_area_per_observed_point(area);
  for (const Rigid2& pose : poses) {
    *proto->add_self_similar_poses() = PoseToProto(pose);
  }
}

void EncodeFeatures(const FeatureSet& set, ProtoPlace* const proto) {
  for (const Feature& feature : set.features) {
    const auto& [keypoint, orientation] = feature;
    const auto& [position, clearance, kind, strength] = keypoint;
    for (const double number :
         {position.x(), position.y(), clearance, strength, orientation}) {
      proto->add_features(number);
    }
    proto->mutable_kinds()->push_back(static_cast<char>(kind));
  }
  proto->mutable_descriptors()->Add(
      set.descriptors.data(), set.descriptors.data() + set.descriptors.size());
}

// Each returns the problem, or an empty string.
std::string DecodeCells(const ProtoPlace& proto, SurfaceModel* const surface) {
  const int64_t width = proto.num_cells_x(), height = proto.num_cells_y();
  if (width < 1 || height < 1 || width > kMaxNumCells ||
      height > kMaxNumCells || width * height > kMaxNumCells) {
    return "has a grid of an impossible size";
  }
  CellGeometry& geometry = surface->geometry;
  geometry.size = {static_cast<int>(width), static_cast<int>(height)};
  geometry.resolution = proto.resolution();
  if (!(geometry.resolution >= 1e-4 && geometry.resolution <= 100.)) {
    return "has a grid of an impossible resolution";
  }
  if (!FromProto(proto.t_submap_grid(), &geometry.T_submap_grid)) {
    return "has a grid at an impossible pose";
  }
  CellPack pack;
  pack.size = geometry.size;
  pack.resolution = geometry.resolution;
  const std::string& bytes = proto.runs();
  for (size_t k = 0; k + 1 < bytes.size(); k += 2) {
    pack.runs.push_back(
        static_cast<uint16_t>(static_cast<uint8_t>(bytes[k]) |
                              static_cast<uint8_t>(bytes[k + 1]) << 8));
  }
  if (bytes.size() % 2 != 0 || !IsValid(pack)) {
    return "has a grid whose cells do not match its size, or show no wall";
  }
  surface->cells = SurfaceCells(std::move(pack));
  return "";
}

std::string DecodePoints(const ProtoPlace& proto, SurfaceModel* const surface) {
  if (proto.walls().empty() || proto.walls_size() % 3 != 0) {
    return "has no walls, or a part of one";
  }
  for (int k = 0; k < proto.walls_size(); k += 3) {
    const double x = proto.walls(k), y = proto.walls(k + 1);
    const double weight = proto.walls(k + 2);
    if (!IsCoordinate(x) || !IsCoordinate(y) ||
        !(weight > 0. && weight <= 1.)) {
      return "has an impossible wall";
    }
    surface->walls.push_back({{x, y}, weight});
  }
  if (proto.observed_points().empty() || proto.observed_points_size() % 2) {
    return "has no observed points, or a part of one";
  }
  for (int k = 0; k < proto.observed_points_size(); k += 2) {
    const double x = proto.observed_points(k);
    const double y = proto.observed_points(k + 1);
    if (!IsCoordinate(x) || !IsCoordinate(y)) {
      return "has an impossible observed point";
    }
    surface->observed_points.emplace_back(x, y);
  }
  surface->area_per_observed_point = proto.area_per_observed_point();
  if (!(surface->area_per_observed_point > 0. &&
        surface->area_per_observed_point <= 1e6)) {
    return "has observed points of an impossible area";
  }
  for (const proto::place_index::Pose& pose : proto.self_similar_poses()) {
    surface->self_similar_poses.emplace_back();
    if (!FromProto(pose, &surface->self_similar_poses.back())) {
      return "has an impossible self-similar pose";
    }
  }
  return "";
}

std::string DecodeFeatures(const ProtoPlace& proto, FeatureSet* const set) {
  const int count = static_cast<int>(proto.kinds().size());
  if (proto.features_size() % kNumbersPerFeature != 0 ||
      proto.features_size() / kNumbersPerFeature != count) {
    return "has features whose numbers do not match";
  }
  if (count == 0 ? proto.descriptors_size() != 0
                 : proto.descriptors_size() == 0 ||
                       proto.descriptors_size() % count != 0) {
    return "has descriptors that do not match the features";
  }
  for (int k = 0; k < count; ++k) {
    const double* const numbers =
        proto.features().data() + int64_t{kNumbersPerFeature} * k;
    const int kind = static_cast<uint8_t>(proto.kinds()[k]);
    if (kind >= kNumKeypointKinds || !IsCoordinate(numbers[0]) ||
        !IsCoordinate(numbers[1]) || !IsCoordinate(numbers[2]) ||
        !std::isfinite(numbers[3]) || !(std::abs(numbers[4]) <= 2. * M_PI)) {
      return "has an impossible feature";
    }
    set->features.push_back({{{numbers[0], numbers[1]},
                              numbers[2],
                              static_cast<KeypointKind>(kind),
                              numbers[3]},
                             numbers[4]});
  }
  if (count == 0) return "";
  set->descriptors = Eigen::Map<const Eigen::MatrixXf>(
      proto.descriptors().data(), proto.descriptors_size() / count, count);
  // Also keeps squares within range.
  if (!(set->descriptors.array().abs() <= 1e15f).all()) {
    return "has an impossible descriptor";
  }
  return "";
}

}  // namespace

absl::StatusOr<PlaceFileKey> MakePlaceFileKey(const std::string& map_path,
                                              const std::string& options,
                                              const PoseGraphInKey pose_graph) {
  errno = 0;
  std::ifstream file(map_path, std::ios::binary | std::ios::ate);
  const int64_t size = file ? static_cast<int64_t>(file.tellg()) : -1;
  std::optional<HashedMap> map;
  if (size >= 0) map = HashOfRecords(pose_graph, size, &file);
  if (size >= 0 && !map) map = HashOfBytes(size, &file);
  if (!map) {
    return absl::ErrnoToStatus(errno != 0 ? errno : EIO,
                               absl::StrCat("cannot read ", map_path));
  }
  return PlaceFileKey{map->hash, map->size, options};
}

std::string EncodePlaceFileHeader(const PlaceFileKey& key, const int version,
                                  const int num_records) {
  proto::place_index::Header header;
  header.set_kind(kKind);
  header.set_version(version);
  header.set_map_hash(key.map_hash);
  header.set_map_size(key.map_size);
  header.set_options(key.options);
  header.set_num_places(num_records);
  return header.SerializeAsString();
}

absl::Status CheckPlaceFileHeader(const std::string& path,
                                  const PlaceFileKey& key, const int version,
                                  const std::string& record) {
  proto::place_index::Header header;
  if (!header.ParseFromString(record)) {
    return absl::DataLossError(
        absl::StrCat(path, " is corrupted: it has no header of a place file"));
  }
  return CheckHeader(path, key, version, header);
}

bool IsPlaceFile(const std::string& path) {
  absl::StatusOr<RecordReader> reader = RecordReader::Open(path);
  std::string record;
  proto::place_index::Header header;
  return reader.ok() && reader->Read(&record).value_or(false) &&
         header.ParseFromString(record) && header.kind() == kKind;
}

absl::Status WritePlaces(const std::string& path, const PlaceFileKey& key,
                         const std::map<SubmapId, Place>& places) {
  absl::StatusOr<RecordWriter> writer = RecordWriter::Open(path);
  if (!writer.ok()) return writer.status();
  absl::Status status = writer->Write(
      EncodePlaceFileHeader(key, kVersion, static_cast<int>(places.size())));
  for (const auto& [id, place] : places) {
    if (status.ok()) status = writer->Write(EncodePlace(place));
  }
  return status.ok() ? writer->Commit() : status;
}

absl::StatusOr<std::map<SubmapId, Place>> ReadPlaces(const std::string& path,
                                                     const PlaceFileKey& key) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    return absl::NotFoundError(absl::StrCat("there is no ", path));
  }
  absl::StatusOr<RecordReader> reader = RecordReader::Open(path);
  if (!reader.ok()) return reader.status();
  std::string record;
  const absl::StatusOr<bool> has_record = reader->Read(&record);
  if (!has_record.ok()) return has_record.status();
  proto::place_index::Header header;
  if (!*has_record || !header.ParseFromString(record)) {
    return reader->Corrupted("is not the header of a place file");
  }
  const absl::Status status = CheckHeader(path, key, kVersion, header);
  if (!status.ok()) return status;
  absl::StatusOr<std::map<SubmapId, Place>> places = ReadRecords(&*reader);
  if (!places.ok()) return places.status();
  if (static_cast<int64_t>(places->size()) != header.num_places()) {
    return absl::DataLossError(absl::StrCat(path, " is corrupted: it has ",
                                            places->size(), " places of ",
                                            header.num_places()));
  }
  return places;
}

std::string EncodePlace(const Place& place) {
  const auto& [id, surface, features] = place;
  ProtoPlace proto;
  proto.set_trajectory(id.trajectory);
  proto.set_index(id.index);
  EncodeSurface(surface, &proto);
  EncodeFeatures(features, &proto);
  return proto.SerializeAsString();
}

absl::StatusOr<Place> DecodePlace(const std::string& bytes) {
  ProtoPlace proto;
  if (!proto.ParseFromString(bytes)) {
    return absl::DataLossError("is not a place");
  }
  if (proto.trajectory() < 0 || proto.index() < 0) {
    return absl::DataLossError("has a place with a negative number");
  }
  Place place;
  place.id = {proto.trajectory(), proto.index()};
  std::string problem = DecodeCells(proto, &place.surface);
  if (problem.empty()) problem = DecodePoints(proto, &place.surface);
  if (problem.empty()) problem = DecodeFeatures(proto, &place.features);
  if (!problem.empty()) return absl::DataLossError(problem);
  return place;
}

}  // namespace cartographer_sdf
