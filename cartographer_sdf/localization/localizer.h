// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Where does a query, a map or the beginning of a drive, lie in a map? No pose
// prior. The one localizer of relocalize, merge and the live searcher: matches
// vote for placements, the best placement is confirmed where it should hold,
// and the answer is a pose that is certain, or none with a reason.

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
#include "cartographer_sdf/localization/confirmation.h"
#include "cartographer_sdf/localization/placement.h"
#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/recognition/match.h"

namespace cartographer_sdf {

struct LocalizationOptions {
  PlacementOptions placement;
  // Whether matches vote that show too little to be accepted, but are more
  // likely right than wrong. One vote at least must be accepted in any case.
  bool count_likely_matches = false;
  // Places of the query, evenly spaced, that are matched at first; twice as
  // many in all each time that leaves the answer uncertain. Larger: slower
  // where few are enough.
  int num_first_places = 2;
  // Pairs of submaps that are verified where the answer lays them over each
  // other. Larger: more agreeing and contradicting matches, slower.
  int max_num_confirmed_pairs = 50;
};
[[nodiscard]] std::string Validate(const LocalizationOptions& options);

enum class LocalizationVerdict {
  kLocalized,
  kTooLittleSeen,
  kNothingAlike,
  kUncertain,     // something is alike, but could be so by chance
  kAmbiguous,     // several places are alike
  kContradicted,  // much of what should be there is not
  // Only beside a live Cartographer.
  kNoMap,     // nothing is loaded, or nothing with walls is left of it
  kFinished,  // the trajectory ended before it was localised
};
// "localized", ...
[[nodiscard]] const char* LocalizationVerdictName(LocalizationVerdict verdict);

struct Localization {
  LocalizationVerdict verdict = LocalizationVerdict::kNothingAlike;
  // For people; a refusal names the places and numbers it is about.
  std::string reason;
  // The pose of the query's map frame in the map's frame; none unless
  // localized.
  std::optional<Rigid2> T_map_query;
  // Log-odds: of the best placement, and of the best one that it excludes. None
  // where there is none.
  std::optional<double> score;
  std::optional<double> runner_up_score;
  // All matches that vote (references in the map), and the placements that they
  // vote for: the best first, localized or not.
  std::vector<Match> matches;
  std::vector<Placement> placements;
  // Votes for the best placement, and votes that it
  // excludes; and pairs of submaps that it would lay over each other and that
  // contradict each other there.
  int num_agreeing = 0;
  int num_contradicting = 0;
  std::vector<Match> contradictions;
  std::vector<std::pair<std::string, double>> stage_seconds;
};

// The matches of query places with the places of the map, whatever their
// verdict: with all of them, or with those that an index proposes.
using PlaceMatcher = std::function<std::vector<Match>(
    const std::map<SubmapId, Place>& queries, const ProgressCallback&)>;

// The query's places and the map's may have the same ids. Deterministic.
[[nodiscard]] Localization Localize(
    const LocalizationOptions& options, const ConsistencyOptions& consistency,
    const MatchOptions& match_options, const PlacedMap& map,
    const PlacedMap& query, const PlaceMatcher& match_places,
    const Executor& executor, const StageCallback& on_stage = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_LOCALIZER_H_
