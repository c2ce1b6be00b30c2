// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The records of a places file, behind their compression, and what an index
// makes of them.

#include <cmath>
#include <string>
#include <vector>

#include "cartographer_sdf/matching/place_index.h"
#include "cartographer_sdf/place_store/place_file.h"
#include "glog/logging.h"
#include "test/fuzz/fuzz_target.h"
#include "test/testing/rectangular_room.h"

namespace cartographer_sdf::fuzz {

std::vector<std::string> Seeds() {
  CellGeometry geometry;
  geometry.size = {60, 40};
  geometry.resolution = 0.1;
  geometry.T_submap_grid = Rigid2(-3., -2., 0.);
  const std::optional<Place> place = DescribePlace(
      PlaceOptions(), SubmapId{1, 2}, RectangularRoom(5., 3., 0.2, geometry));
  CHECK(place.has_value());
  return {EncodePlace(*place)};
}

}  // namespace cartographer_sdf::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* const data,
                                      const size_t size) {
  using namespace cartographer_sdf;  // NOLINT
  const absl::StatusOr<Place> place =
      DecodePlace(std::string(reinterpret_cast<const char*>(data), size));
  if (!place.ok()) return 0;
  // Exactly what was decoded, once it is encoded by us.
  const std::string encoded = EncodePlace(*place);
  const absl::StatusOr<Place> again = DecodePlace(encoded);
  CHECK(again.ok()) << again.status();
  CHECK(EncodePlace(*again) == encoded);
  constexpr size_t kSmallField = 1 << 22;
  if (place->surface.cells.NumBytes() < kSmallField) {
    CHECK(SurfaceCells(PackCells(*place->surface.cells.Pin(),
                                 place->surface.geometry.resolution))
              .Pack()
              .size.prod() > 0);
  }
  PlaceIndex index((RetrievalOptions()));
  index.Add(place->id, place->features);
  const auto none = [](const SubmapId&) { return false; };
  for (const RetrievalCandidate& candidate :
       index.Query(again->features, none)) {
    CHECK(std::isfinite(candidate.score));
    for (const Rigid2& pose : candidate.T_reference_query) {
      CHECK(pose.translation().allFinite());
    }
  }
  CHECK(index.Remove(place->id));
  return 0;
}
