// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Places in a file beside their map, so that it need not be described again.
// The container is that of .pbstream: compressed records with a CRC-32 each
// (record_stream.h), written to a temporary file that is renamed when whole.
// What is read is what was written, bit by bit, or an error in one line.

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

// What a file of places belongs to: another map, or other options, and it is
// worth nothing.
struct PlaceFileKey {
  uint64_t map_hash = 0;  // FNV-1a of all bytes: of mistakes, not of forgery
  int64_t map_size = 0;   // [bytes]
  // All options that places depend on, as text.
  std::string options;
};

// Reads the whole map; fails where it cannot.
[[nodiscard]] absl::StatusOr<PlaceFileKey> MakePlaceFileKey(
    const std::string& map_path, const std::string& options);

[[nodiscard]] absl::Status WritePlaces(const std::string& path,
                                       const PlaceFileKey& key,
                                       const std::map<SubmapId, Place>& places);

// Not found where there is no such file, failed precondition where it is of
// another map, other options or another version, data loss where it is broken.
[[nodiscard]] absl::StatusOr<std::map<SubmapId, Place>> ReadPlaces(
    const std::string& path, const PlaceFileKey& key);

// A record of such a file: a serialized proto::place_index::Place.
[[nodiscard]] std::string EncodePlace(const Place& place);

// Exactly what was encoded. Any bytes give a place that the rest of the program
// can work with (sizes that fit, finite numbers, ...) or an error, a predicate
// ("has no walls") for callers to put a subject before.
[[nodiscard]] absl::StatusOr<Place> DecodePlace(const std::string& bytes);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PLACE_STORE_PLACE_FILE_H_
