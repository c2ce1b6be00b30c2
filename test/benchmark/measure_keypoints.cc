// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// How many keypoints are found again in submaps that saw the same place, as a
// CSV of subject,quantity,value.
//
// usage: measure_keypoints MAP.pbstream TRUTH.csv CONFIGURATION_DIRECTORY
//        [CONFIGURATION_BASENAME [SUBMAP_INDEX PICTURE.png]]

#include <cstdlib>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/evaluation/match_score.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/report/feature_pictures.h"
#include "cartographer_sdf/simulation/truth.h"
#include "test/testing/keypoint_repeatability.h"

namespace cartographer_sdf {
namespace {

// As the rules of the scores.
constexpr double kPositivePairOverlap = 0.5;

void Print(const std::string& subject,
           const testing::KeypointRepeatability::OfKind& count) {
  const std::string line = "keypoints" + subject;
  std::cout << line << ",judged," << count.num_judged << "\n"
            << line << ",found," << count.num_found << "\n"
            << line << ",oriented," << count.num_oriented << "\n"
            << line << ",judged_by_chance," << count.num_judged_by_chance
            << "\n"
            << line << ",found_by_chance," << count.num_found_by_chance << "\n";
}

// The distance field and the keypoints of a place.
absl::Status Draw(const Place& place, const std::string& path) {
  const SurfaceModel& surface = place.surface;
  const PinnedCells cells = surface.cells.Pin();
  Eigen::ArrayXXf distance(cells->rows(), cells->cols());
  BoolArray observed(cells->rows(), cells->cols());
  for (Eigen::Index k = 0; k != cells->size(); ++k) {
    distance(k) = 1e-3f * static_cast<float>((*cells)(k).distance);
    observed(k) = (*cells)(k).observed;
  }
  const Picture picture = DrawDistanceField(
      {surface.geometry, distance, observed}, place.features.features, 500);
  return WriteWholeFile(path, picture.EncodePng());
}

absl::Status Measure(const std::string& map_path, const std::string& truth_path,
                     const std::string& directory, const std::string& basename,
                     const int drawn_index, const std::string& picture_path) {
  const absl::StatusOr<Options> options = LoadOptions({directory}, basename);
  if (!options.ok()) return options.status();
  const absl::StatusOr<Truth> truth = ReadTruth(truth_path);
  if (!truth.ok()) return truth.status();
  std::map<SubmapId, ObservedPoints> observed;
  std::map<SubmapId, Place> places;
  size_t num_features = 0;
  const absl::StatusOr<MapState> state =
      ReadMap(map_path, {[&](const SubmapId& id, const SubmapSummary&,
                             const OccupancyGrid& grid) {
                observed[id] = ThinnedObservedPoints(grid);
                std::optional<Place> place =
                    DescribePlace(options->loop_closing.place, id, grid);
                if (!place) return;
                num_features += place->features.features.size();
                places[id] = *std::move(place);
              }});
  if (!state.ok()) return state.status();
  if (!picture_path.empty()) {
    const auto drawn = places.find({0, drawn_index});
    if (drawn == places.end()) {
      return absl::InvalidArgumentError("there is no such submap");
    }
    const absl::Status status = Draw(drawn->second, picture_path);
    if (!status.ok()) return status;
  }
  testing::KeypointRepeatability repeatability;
  int num_pairs = 0;
  for (const auto& [ids, pair] : ComputePairTruths(observed, *truth)) {
    const auto reference = places.find(ids.first);
    const auto query = places.find(ids.second);
    if (pair.overlap < kPositivePairOverlap || reference == places.end() ||
        query == places.end()) {
      continue;
    }
    ++num_pairs;
    testing::AddKeypointRepeatability(
        reference->second, query->second,
        truth->T_world_submap.at(ids.first).Inverse() *
            truth->T_world_submap.at(ids.second),
        &repeatability);
  }
  std::cout << "subject,quantity,value\n"
            << "keypoints,submaps," << places.size() << "\n"
            << "keypoints,features," << num_features << "\n"
            << "keypoints,pairs," << num_pairs << "\n";
  Print("", repeatability.Total());
  Print(" maximum", repeatability.kinds[0]);
  Print(" minimum", repeatability.kinds[1]);
  Print(" saddle", repeatability.kinds[2]);
  return absl::OkStatus();
}

}  // namespace
}  // namespace cartographer_sdf

int main(const int argc, char** const argv) {
  if (argc != 4 && argc != 5 && argc != 7) {
    std::cerr << "usage: measure_keypoints MAP.pbstream TRUTH.csv "
                 "CONFIGURATION_DIRECTORY [CONFIGURATION_BASENAME "
                 "[SUBMAP_INDEX PICTURE.png]]\n";
    return 2;
  }
  const absl::Status status = cartographer_sdf::Measure(
      argv[1], argv[2], argv[3],
      argc >= 5 ? argv[4] : "sdf_global_constraints.lua",
      argc == 7 ? std::atoi(argv[5]) : 0, argc == 7 ? argv[6] : "");
  if (status.ok()) return 0;
  std::cerr << status.message() << "\n";
  return 1;
}
