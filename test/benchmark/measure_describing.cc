// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What the stages of describing a submap cost, one thread, as a CSV of
// stage,milliseconds (of CPU; means over the submaps of a map).
//
// usage: measure_describing MAP.pbstream [give_back]
//   give_back  leaves the allocator as it is, see tools/subcommand.h

#include <cstdlib>
#include <ctime>
#include <functional>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/feature/descriptor.h"
#include "cartographer_sdf/feature/keypoint.h"
#include "cartographer_sdf/field/distance_field.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/tools/subcommand.h"

namespace cartographer_sdf {
namespace {

class StageTimes {
 public:
  void Run(const std::string& stage, const std::function<void()>& work) {
    const std::clock_t begin = std::clock();
    work();
    milliseconds_[stage] +=
        1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  }
  void Print(const int num_submaps) const {
    std::cout << "stage,milliseconds\n";
    for (const auto& [stage, sum] : milliseconds_) {
      std::cout << stage << "," << sum / num_submaps << "\n";
    }
  }

 private:
  std::map<std::string, double> milliseconds_;
};

int Measure(const std::string& map) {
  const PlaceOptions options;
  StageTimes times;
  int num_submaps = 0;
  const auto describe = [&](const SubmapId&, const SubmapSummary&,
                            const OccupancyGrid& grid) {
    std::optional<DistanceField> field;
    times.Run("field", [&] { field = MakeDistanceField(options.field, grid); });
    if (!field) return;
    ++num_submaps;
    Eigen::ArrayXXf smoothed;
    std::vector<Keypoint> keypoints;
    times.Run("smooth and detect", [&] {
      smoothed = SmoothFieldForPlace(options, *field);
      keypoints = DetectKeypoints(options.keypoint, *field, smoothed);
    });
    times.Run("describe", [&] {
      const FeatureSet features =
          DescribeKeypoints(options.descriptor, *field, smoothed, keypoints);
    });
  };
  const absl::StatusOr<MapState> state = ReadMap(map, {describe});
  if (!state.ok()) {
    std::cerr << "measure_describing: " << state.status().message() << "\n";
    return EXIT_FAILURE;
  }
  if (num_submaps == 0) {
    std::cerr << "measure_describing: " << map << " has no submap with walls\n";
    return EXIT_FAILURE;
  }
  times.Print(num_submaps);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace cartographer_sdf

int main(int argc, char** argv) {
  const bool gives_back = argc == 3 && std::string(argv[2]) == "give_back";
  if (argc != 2 && !gives_back) {
    std::cerr << "usage: measure_describing MAP.pbstream [give_back]\n";
    return 2;
  }
  if (!gives_back) cartographer_sdf::KeepFreedMemory();
  return cartographer_sdf::Measure(argv[1]);
}
