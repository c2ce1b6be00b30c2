// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Localises a query, a map or the beginning of a drive, in a map, without a
// pose prior, for relocalize, merge and the live searcher. Matches vote for
// placements, the best placement is confirmed where it should hold, and the
// answer is either a certain pose or a refusal with a reason.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_LOCALIZER_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_LOCALIZER_H_

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/closing/consistency.h"
#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/execution/stage_clock.h"
#include "cartographer_sdf/localization/changes.h"
#include "cartographer_sdf/localization/confirmation.h"
#include "cartographer_sdf/localization/placement.h"
#include "cartographer_sdf/localization/query_parts.h"
#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/recognition/match.h"

namespace cartographer_sdf {

struct LocalizationOptions {
  PlacementOptions placement;
  // Whether matches that show too little to be accepted, but are more likely
  // right than wrong, also vote. At least one vote must be accepted in any
  // case.
  bool count_likely_matches = false;
  // Places of the query, evenly spaced, that are matched at first. While the
  // answer is uncertain, the number doubles, and those that are new are
  // matched. Smaller: faster, but look-alikes elsewhere may go unnoticed.
  int num_first_places = 64;
  // Largest number of pairs of submaps that are verified to confirm the answer.
  // Larger: more agreeing and contradicting matches, slower.
  int max_num_confirmed_pairs = 50;
};
[[nodiscard]] std::string Validate(const LocalizationOptions& options);

enum class LocalizationVerdict {
  kLocalized,
  kTooLittleSeen,
  kNothingAlike,
  kUncertain,     // something matches, but possibly by chance
  kAmbiguous,     // several places match
  kContradicted,  // much of what should be there is missing
  // Only beside a live Cartographer.
  kNoMap,     // no map is loaded, or nothing with walls is left of it
  kFinished,  // the trajectory ended before it was localised
};
// "localized", ...
[[nodiscard]] const char* LocalizationVerdictName(LocalizationVerdict verdict);

struct Localization {
  LocalizationVerdict verdict = LocalizationVerdict::kNothingAlike;
  // Human-readable; a refusal names the places and numbers concerned.
  std::string reason;
  // The pose of the query's map frame in the map's frame; empty unless
  // localised.
  std::optional<Rigid2> T_map_query;
  // Log-odds of the best placement, and of the best one that it excludes; empty
  // if there is none.
  std::optional<double> score;
  std::optional<double> runner_up_score;
  // All matches that vote (references in the map), and the placements that they
  // vote for, best first, whether localised or not.
  std::vector<Match> matches;
  std::vector<Placement> placements;
  // The parts of the query that lie at poses of their own, if localised: one,
  // whose pose is T_map_query, unless the query drifted or jumped.
  QueryParts parts;
  // Number of votes for the best placement, and number of votes that it
  // excludes plus contradictions: pairs of submaps that it makes overlap and
  // that contradict each other there.
  int num_agreeing = 0;
  int num_contradicting = 0;
  std::vector<Match> contradictions;
  // Among so many pairs that it makes overlap; 0 if it was not confirmed.
  size_t num_compared = 0;
  std::vector<CrossingWall> crossing_walls;
  // What changed since the map was made. Filled in by LocalizeIn
  // (apps/session.h), if localised.
  std::vector<Change> changes;
  std::vector<std::pair<std::string, double>> stage_seconds;
};

// Returns the matches of these places of the query, and of all that were given
// in earlier calls, with places of the map, whatever their verdict.
using PlaceMatcher = std::function<std::vector<Match>(
    const std::map<SubmapId, Place>& queries, const ProgressCallback&)>;

// Places of the query and of the map may have the same ids. Deterministic.
[[nodiscard]] Localization Localize(
    const LocalizationOptions& options, const ConsistencyOptions& consistency,
    const MatchOptions& match_options, const PlacedMap& map,
    const PlacedMap& query, const PlaceMatcher& match_places,
    const Executor& executor, const StageCallback& on_stage = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_LOCALIZER_H_
