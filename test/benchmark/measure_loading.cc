// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What a program does with a saved map before it recognises anything, one
// thread, as a CSV of stage,seconds (of CPU).
//
// usage: measure_loading MAP.pbstream PLACES
//   PLACES  file that --places of the same version has left, or will be made

#include <cstdlib>
#include <ctime>
#include <functional>
#include <iostream>
#include <map>
#include <string>

#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/matching/place_index.h"
#include "cartographer_sdf/place/field_memory.h"
#include "cartographer_sdf/place_store/described_map.h"
#include "cartographer_sdf/place_store/place_file.h"
#include "cartographer_sdf/tools/subcommand.h"

namespace cartographer_sdf {
namespace {

void Run(const std::string& stage, const std::function<void()>& work) {
  const std::clock_t begin = std::clock();
  work();
  std::cout << stage << ","
            << static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC
            << "\n";
}

int Measure(const std::string& path, const std::string& places_path) {
  const PlaceOptions options;
  const MatchOptions match;
  const std::string text = FormatPlaceOptions(options, match);
  const auto key = MakePlaceFileKey(path, text);
  auto places = key.ok() ? ReadPlaces(places_path, *key) : key.status();
  if (!places.ok()) {
    const auto made =
        RememberMap(options, match, text, path, places_path, MakeExecutor(1));
    if (!made.ok()) {
      std::cerr << "measure_loading: " << made.status().message() << "\n";
      return EXIT_FAILURE;
    }
  }
  std::cout << "stage,seconds\n";
  Run("checksums of the map",
      [&] { (void)MakePlaceFileKey(path, text).status(); });
  Run("read places", [&] { places = ReadPlaces(places_path, *key); });
  Run("read the map", [&] { (void)ReadMap(path, {}).status(); });
  Run("read the map with its scans",
      [&] { (void)ReadMapWithScans(path).status(); });
  Run("read and describe the map with its scans instead", [&] {
    (void)DescribeMap(options, match, path, MakeExecutor(1), {},
                      PointClouds::kKeep)
        .status();
  });
  if (!places.ok()) return EXIT_FAILURE;
  Run("bound the memory of fields",
      [&] { FieldMemory(options).Add(&*places); });
  PlaceIndex index{RetrievalOptions()};
  Run("fill the index", [&] {
    for (const auto& [id, place] : *places) index.Add(id, place.features);
  });
  std::cerr << places->size() << " places\n";
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace cartographer_sdf

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: measure_loading MAP.pbstream PLACES\n";
    return 2;
  }
  cartographer_sdf::KeepFreedMemory();
  return cartographer_sdf::Measure(argv[1], argv[2]);
}
