// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/place_store/place_file.h"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/pbstream/record_stream.h"
#include "cartographer_sdf/place_index.pb.h"
#include "cartographer_sdf/place_store/place_codec.h"

namespace cartographer_sdf {
namespace {

constexpr char kKind[] = "cartographer_sdf places";
// To be raised with every change of the format *or of what describing a submap
// yields*.
constexpr int kVersion = 1;

std::string ToRecord(const PlaceFileKey& key, const size_t num_places) {
  proto::place_index::Header header;
  header.set_kind(kKind);
  header.set_version(kVersion);
  header.set_map_hash(key.map_hash);
  header.set_map_size(key.map_size);
  header.set_options(key.options);
  header.set_num_places(static_cast<int>(num_places));
  return header.SerializeAsString();
}

absl::Status CheckHeader(const std::string& path, const PlaceFileKey& key,
                         const proto::place_index::Header& header) {
  const auto refuse = [&path](const absl::string_view problem) {
    return absl::FailedPreconditionError(absl::StrCat(path, " ", problem));
  };
  if (header.kind() != kKind) return refuse("is no file of places");
  if (header.version() != kVersion) {
    return refuse(absl::StrCat("has places of version ", header.version(),
                               ", not ", kVersion));
  }
  if (header.map_hash() != key.map_hash || header.map_size() != key.map_size) {
    return refuse("has the places of another map");
  }
  if (header.options() != key.options) {
    return refuse("has places that were described with other options");
  }
  return absl::OkStatus();
}

absl::StatusOr<proto::place_index::Header> ReadHeader(
    RecordReader* const reader) {
  std::string record;
  const absl::StatusOr<bool> has_record = reader->Read(&record);
  if (!has_record.ok()) return has_record.status();
  proto::place_index::Header header;
  if (!*has_record || !header.ParseFromString(record)) {
    return reader->Corrupted("is no header of a file of places");
  }
  return header;
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
      return reader->Corrupted("has a place that was there before");
    }
  }
}

}  // namespace

absl::StatusOr<PlaceFileKey> MakePlaceFileKey(const std::string& map_path,
                                              const std::string& options) {
  errno = 0;
  std::ifstream file(map_path, std::ios::binary);
  PlaceFileKey key;
  key.options = options;
  key.map_hash = 0xcbf29ce484222325u;
  std::vector<char> buffer(1 << 16);
  while (file.good()) {
    file.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    for (std::streamsize k = 0; k < file.gcount(); ++k) {
      key.map_hash ^= static_cast<unsigned char>(buffer[k]);
      key.map_hash *= 0x100000001b3u;
    }
    key.map_size += file.gcount();
  }
  if (!file.eof()) {
    return absl::ErrnoToStatus(errno != 0 ? errno : EIO,
                               absl::StrCat("cannot read ", map_path));
  }
  return key;
}

absl::Status WritePlaces(const std::string& path, const PlaceFileKey& key,
                         const std::map<SubmapId, Place>& places) {
  absl::StatusOr<RecordWriter> writer = RecordWriter::Open(path);
  if (!writer.ok()) return writer.status();
  absl::Status status = writer->Write(ToRecord(key, places.size()));
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
  const absl::StatusOr<proto::place_index::Header> header =
      ReadHeader(&*reader);
  if (!header.ok()) return header.status();
  if (absl::Status status = CheckHeader(path, key, *header); !status.ok()) {
    return status;
  }
  absl::StatusOr<std::map<SubmapId, Place>> places = ReadRecords(&*reader);
  if (!places.ok()) return places.status();
  if (static_cast<int64_t>(places->size()) != header->num_places()) {
    return absl::DataLossError(absl::StrCat(path, " is corrupted: it has ",
                                            places->size(), " places of ",
                                            header->num_places()));
  }
  return places;
}

}  // namespace cartographer_sdf
