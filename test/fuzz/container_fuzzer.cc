// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The container of maps and places: any bytes as a file.

#include <string>
#include <vector>

#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/place_store/place_file.h"
#include "test/fuzz/fuzz_target.h"
#include "test/testing/small_map.h"

namespace cartographer_sdf::fuzz {

std::vector<std::string> Seeds() {
  return {testing::Container(testing::SmallMap().Records()),
          testing::Container({"a record", ""}), testing::MagicNumber()};
}

}  // namespace cartographer_sdf::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* const data,
                                      const size_t size) {
  using namespace cartographer_sdf;  // NOLINT
  const std::string path = fuzz::WriteInput(
      "file", std::string(reinterpret_cast<const char*>(data), size));
  (void)ReadMap(path);
  (void)ReadTrajectories(path);
  (void)ReadPlaces(path, PlaceFileKey());
  (void)IsPlaceFile(path);
  return 0;
}
