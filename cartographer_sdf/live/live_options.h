// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Options of the searcher beside a live Cartographer. They have a separate Lua
// file and table, SDF_LIVE, because Cartographer aborts on unknown keys in its
// tables.

#ifndef CARTOGRAPHER_SDF_LIVE_LIVE_OPTIONS_H_
#define CARTOGRAPHER_SDF_LIVE_LIVE_OPTIONS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/closing/consistency.h"
#include "cartographer_sdf/closing/constraint_generation.h"
#include "cartographer_sdf/localization/localizer.h"
#include "cartographer_sdf/localization/scan_localizer.h"
#include "cartographer_sdf/localization/scan_session.h"
#include "cartographer_sdf/matching/place_index.h"
#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/neighbourhood.h"
#include "cartographer_sdf/report/report_options.h"

namespace cartographer_sdf {

// Returns the localiser's options for a query that is a single place, as live
// ones are. It sees too little for most of its matches to be certain, so
// matches with further submaps of the map count in part, and the least score is
// higher in return. Values: docs/results/live.md.
[[nodiscard]] LocalizationOptions SinglePlaceLocalizationOptions();

// Localisation of a new trajectory in a loaded map: the localiser is queried
// repeatedly with the robot's recent scans, long before the first submap is
// finished.
struct LiveLocalizationOptions {
  // Whether new trajectories are localised automatically once a map is loaded.
  bool enabled = true;
  // Distance driven before the first query and between queries [m].
  double query_interval_meters = 0.5;
  // Distance driven whose scans make up the query [m]. Longer: more of the
  // building, but more drift of local SLAM.
  double window_meters = 15.;
  // Cell size of the query's grid [m].
  double resolution_meters = 0.05;
  // Number of best submaps of the map that are matched with the query, which
  // shows less than a submap does. Larger: found sooner, more CPU time.
  int max_num_candidates = 50;
  LocalizationOptions localizer = SinglePlaceLocalizationOptions();
  // Number of consecutive queries, each after more driving, that must agree.
  int min_num_queries = 2;
  // Poses nearer than this are the same pose [m], [rad].
  double max_translation_difference_meters = 0.5;
  double max_rotation_difference = 0.1;
  // Whether each scan by itself is compared with the whole map, too: robots are
  // found sooner, and noticed to be lost. Takes more CPU time, and up to 30 MB
  // for a large map.
  bool compare_scans = false;
  ScanLocalizationOptions scan_localization;
  ScanSessionOptions scan_session;
};
[[nodiscard]] std::string Validate(const LiveLocalizationOptions& options);

struct LiveOptions {
  // false: CreateMapBuilder returns the host as it is.
  bool enabled = true;
  // Whether closures become constraints; false: they are only reported.
  bool inject_constraints = true;
  // One line for each closure.
  bool log_closures = true;
  // Whether places of a loaded map are read from and written to
  // MAP.pbstream.places, a file shared with `relocalize --places`.
  bool use_place_files = true;
  // Least difference of the indices of two submaps of one trajectory that are
  // matched; nearer ones share scans.
  int min_index_gap = 3;
  PlaceOptions place;
  MatchOptions match;
  RetrievalOptions retrieval;
  // Whether matches are verified together with both submaps' neighbours: by
  // their walls alone, as what pairs found by themselves is not kept.
  bool verify_neighbourhoods = false;
  NeighbourhoodOptions neighbourhood;
  ConsistencyOptions consistency;
  ConstraintOptions constraints;
  LiveLocalizationOptions localization;

  LiveOptions() { retrieval.max_num_candidates = 15; }
};
[[nodiscard]] std::string Validate(const LiveOptions& options);

// Searches the directories in order for the file and its includes.
[[nodiscard]] absl::StatusOr<LiveOptions> LoadLiveOptions(
    const std::vector<std::string>& directories, const std::string& basename);

// Formats the options as Lua that LoadLiveOptions can read.
[[nodiscard]] std::string FormatLiveOptions(const LiveOptions& options);

// Those that differ from their defaults.
[[nodiscard]] std::vector<ChangedOption> ChangedLiveOptions(
    const LiveOptions& options);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_LIVE_OPTIONS_H_
