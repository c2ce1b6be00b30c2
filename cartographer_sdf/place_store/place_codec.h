// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_PLACE_STORE_PLACE_CODEC_H_
#define CARTOGRAPHER_SDF_PLACE_STORE_PLACE_CODEC_H_

#include <string>

#include "absl/status/statusor.h"
#include "cartographer_sdf/place/place.h"

namespace cartographer_sdf {

// A serialized proto::place_index::Place.
[[nodiscard]] std::string EncodePlace(const Place& place);

// Exactly what was encoded. Any bytes give a place that the rest of the program
// can work with (sizes that fit, finite numbers, ...) or an error, a predicate
// ("has no walls") for callers to put a subject before.
[[nodiscard]] absl::StatusOr<Place> DecodePlace(const std::string& bytes);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PLACE_STORE_PLACE_CODEC_H_
