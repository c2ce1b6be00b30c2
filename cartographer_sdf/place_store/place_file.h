// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Stores places in a file beside their map, so that the map need not be
// described again. The container is that of .pbstream: compressed records with
// a CRC-32 each (record_stream.h), written to a temporary file that is renamed
// when complete. Reading returns exactly what was written, bit by bit, or a
// one-line error.

#ifndef CARTOGRAPHER_SDF_PLACE_STORE_PLACE_FILE_H_
#define CARTOGRAPHER_SDF_PLACE_STORE_PLACE_FILE_H_

#include <cstdint>
#include <map>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/place/place.h"

namespace cartographer_sdf {

// Whether a key covers the pose graph of a .pbstream.
enum class PoseGraphInKey {
  // Descriptions do not depend on poses: those of a map also serve the map that
  // close_loops or audit makes of it, whose other records are the same.
  kNo,
  kYes,
};

// Identifies the map and options of a place file; with others it is useless.
struct PlaceFileKey {
  // FNV-1a of the lengths and checksums of the records of a .pbstream, of all
  // bytes of another file: detects mistakes, not forgery.
  uint64_t map_hash = 0;
  int64_t map_size = 0;  // of what is covered [bytes]
  // All options that places depend on, as text.
  std::string options;
};

// Reads a few bytes of each record of the map; fails if it cannot.
[[nodiscard]] absl::StatusOr<PlaceFileKey> MakePlaceFileKey(
    const std::string& map_path, const std::string& options,
    PoseGraphInKey pose_graph = PoseGraphInKey::kNo);

// The first record of a file that belongs to a map, and its problem when it is
// read: FailedPrecondition as of ReadPlaces.
[[nodiscard]] std::string EncodePlaceFileHeader(const PlaceFileKey& key,
                                                int version, int num_records);
[[nodiscard]] absl::Status CheckPlaceFileHeader(const std::string& path,
                                                const PlaceFileKey& key,
                                                int version,
                                                const std::string& record);

// Whether it is a place file, of whatever map; false if it cannot be read.
[[nodiscard]] bool IsPlaceFile(const std::string& path);

[[nodiscard]] absl::Status WritePlaces(const std::string& path,
                                       const PlaceFileKey& key,
                                       const std::map<SubmapId, Place>& places);

// Returns NotFound if there is no such file, FailedPrecondition if it belongs
// to another map, other options or another version, DataLoss if it is
// corrupted.
[[nodiscard]] absl::StatusOr<std::map<SubmapId, Place>> ReadPlaces(
    const std::string& path, const PlaceFileKey& key);

// Returns a record of such a file: a serialized proto::place_index::Place.
[[nodiscard]] std::string EncodePlace(const Place& place);

// Returns exactly what was encoded. Any input yields a valid place (sizes that
// fit, finite numbers, ...) or an error whose message is a predicate ("has no
// walls"), to which callers prepend a subject.
[[nodiscard]] absl::StatusOr<Place> DecodePlace(const std::string& bytes);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PLACE_STORE_PLACE_FILE_H_
