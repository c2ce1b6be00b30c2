// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Options of the searcher beside a live Cartographer. They have a Lua file and
// a table of their own, SDF_LIVE, because Cartographer aborts on keys in its
// tables that it does not know.

#ifndef CARTOGRAPHER_SDF_LIVE_LIVE_OPTIONS_H_
#define CARTOGRAPHER_SDF_LIVE_LIVE_OPTIONS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/closing/consistency.h"
#include "cartographer_sdf/closing/constraint_generation.h"
#include "cartographer_sdf/localization/localizer.h"
#include "cartographer_sdf/matching/place_index.h"
#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/neighbourhood.h"

namespace cartographer_sdf {

// A young query is one place, which sees too little for most of its matches to
// be certain: all matches that may be right add up, and must be more in return.
[[nodiscard]] LocalizationOptions LocalizerOfYoungQueries();

// Localisation of a new trajectory in a loaded map: the localiser is queried
// repeatedly with what the robot has seen lately, long before the first submap
// is finished.
struct LiveLocalizationOptions {
  // Whether new trajectories are localised by themselves once a map is loaded.
  bool enabled = true;
  // The first query, and each that follows, after so much driving [m].
  double query_interval_meters = 0.5;
  // Scans of so much driving make the query [m]. Longer: more of the building,
  // but local SLAM bends.
  double window_meters = 15.;
  // Cells of the query's grid [m].
  double resolution_meters = 0.05;
  // The best so many submaps of the map are matched with the query, which shows
  // less than a submap does. Larger: found sooner, more CPU time.
  int max_num_candidates = 50;
  LocalizationOptions localizer = LocalizerOfYoungQueries();
  // So many queries in a row, each after more driving, must say the same.
  int min_num_queries = 2;
  // Poses nearer than this are the same pose [m], [rad].
  double max_translation_difference_meters = 0.5;
  double max_rotation_difference = 0.1;
};
[[nodiscard]] std::string Validate(const LiveLocalizationOptions& options);

struct LiveOptions {
  // false: CreateMapBuilder returns the host as it is.
  bool enabled = true;
  // Whether closures become constraints; false: they are reported only.
  bool inject_constraints = true;
  // One line for each closure.
  bool log_closures = true;
  // Whether places of a loaded map are taken from MAP.pbstream.places, and left
  // there; `relocalize --places` shares the file.
  bool use_place_files = true;
  // Submaps of one trajectory are matched from this difference of their indices
  // on; nearer ones share scans.
  int min_index_gap = 3;
  PlaceOptions place;
  MatchOptions match;
  RetrievalOptions retrieval;
  // Whether matches are verified together with the neighbours of both submaps.
  bool verify_neighbourhoods = false;
  NeighbourhoodOptions neighbourhood;
  ConsistencyOptions consistency;
  ConstraintOptions constraints;
  LiveLocalizationOptions localization;

  LiveOptions() { retrieval.max_num_candidates = 15; }
};
[[nodiscard]] std::string Validate(const LiveOptions& options);

// Looks for the file and what it includes in the directories, in their order.
[[nodiscard]] absl::StatusOr<LiveOptions> LoadLiveOptions(
    const std::vector<std::string>& directories, const std::string& basename);

// As Lua that LoadLiveOptions would read.
[[nodiscard]] std::string FormatLiveOptions(const LiveOptions& options);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_LIVE_OPTIONS_H_
