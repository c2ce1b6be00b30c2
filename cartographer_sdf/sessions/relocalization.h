// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Where does a query, a map or the beginning of a drive, lie in a saved map?
// No pose prior. The answer is a pose that is certain, or none with a reason.

#ifndef CARTOGRAPHER_SDF_SESSIONS_RELOCALIZATION_H_
#define CARTOGRAPHER_SDF_SESSIONS_RELOCALIZATION_H_

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/loop_closing/described_map.h"
#include "cartographer_sdf/loop_closing/loop_closing.h"
#include "cartographer_sdf/sessions/placement.h"
#include "cartographer_sdf/sessions/scan_places.h"

namespace cartographer_sdf {

struct RelocalizationOptions {
  PlacementOptions placement;
  // Of queries that are made from scans.
  ScanPlaceOptions scan_places;
  // Places of the query, evenly spaced, that are searched at first; twice as
  // many in all each time that leaves the answer uncertain. Larger: slower
  // where few are enough.
  int num_first_places = 2;
  // Pairs of submaps that are verified where the answer lays them over each
  // other. Larger: more agreeing and contradicting matches, slower.
  int max_num_confirmed_pairs = 50;
};
[[nodiscard]] std::string Validate(const RelocalizationOptions& options);

enum class RelocalizationVerdict {
  kLocalized,
  kTooLittleSeen,
  kNothingAlike,
  kUncertain,     // something is alike, but could be so by chance
  kAmbiguous,     // several places are alike
  kContradicted,  // much of what should be there is not
};
// "localized", ...
[[nodiscard]] const char* RelocalizationVerdictName(
    RelocalizationVerdict verdict);

struct Relocalization {
  RelocalizationVerdict verdict = RelocalizationVerdict::kNothingAlike;
  // For people; of a refusal with the places and numbers it is about.
  std::string reason;
  // The pose of the query's map frame in the map's frame; none unless
  // localized.
  std::optional<Rigid2> T_map_query;
  // Log-odds: of the best placement, and of the best one that it excludes. None
  // where there is none.
  std::optional<double> score;
  std::optional<double> runner_up_score;
  // All accepted matches (references in the map), and the placements that they
  // vote for: the best first, localized or not.
  std::vector<Match> matches;
  std::vector<Placement> placements;
  // Of accepted matches: votes for the best placement, and votes that it
  // excludes; and pairs of submaps that it would put onto each other and that
  // contradict each other there.
  int num_agreeing = 0;
  int num_contradicting = 0;
  std::vector<Match> contradictions;
  std::vector<std::pair<std::string, double>> stage_seconds;
};

// The query's places and the map's may have the same ids. Deterministic. The
// options' other stages are those of close_loops.
[[nodiscard]] Relocalization Relocalize(const RelocalizationOptions& options,
                                        const LoopClosingOptions& stages,
                                        const DescribedMap& map,
                                        const DescribedMap& query,
                                        const Executor& executor,
                                        const StageCallback& on_stage = {});

// A saved map, or a stretch of one, that takes part. Ids are those of its file.
struct Session {
  std::string path;
  DescribedMap map;
  // Of the submaps that are not in the file but were made of scans.
  std::map<SubmapId, OccupancyGrid> scan_grids;
};

// All submaps that a file holds, and places made of the scans of trajectories
// of which it holds none; with a window, places made of the scans in it alone.
// See scan_places.h. Fails as ReadMap does.
[[nodiscard]] absl::StatusOr<Session> DescribeSession(
    const RelocalizationOptions& options, const LoopClosingOptions& stages,
    const std::string& path, const std::optional<TimeWindow>& window,
    const Executor& executor, const ProgressCallback& on_progress = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_SESSIONS_RELOCALIZATION_H_
