// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A saved map with every submap made a place, and pairs of places matched.
// No pose of the map takes part.

#ifndef CARTOGRAPHER_SDF_LOOP_CLOSING_DESCRIBED_MAP_H_
#define CARTOGRAPHER_SDF_LOOP_CLOSING_DESCRIBED_MAP_H_

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/place.h"
#include "cartographer_sdf/retrieval/place_index.h"

namespace cartographer_sdf {

// Runs task(0), ..., task(n - 1), each once, in any order, perhaps at once, and
// returns when all are done.
using Executor =
    std::function<void(size_t n, const std::function<void(size_t)>& task)>;

struct DescribedMap {
  MapState state;
  // Submaps without a wall are no places.
  std::map<SubmapId, Place> places;
};

// Fails as ReadMap does. Holds a few grids at a time.
[[nodiscard]] absl::StatusOr<DescribedMap> DescribeMap(
    const PlaceOptions& place_options, const MatchOptions& match_options,
    const std::string& path, const Executor& executor,
    const ProgressCallback& on_progress = {});

struct RememberedMap {
  DescribedMap map;
  bool is_from_file = false;
  // Why the file of places could not be used although it was there, or not be
  // written: a line for the user, who need not do anything. Else empty.
  std::string complaint;
};

// As DescribeMap, but takes the places from a file (place_file.h) that an
// earlier run has left; else describes them and leaves one. `options_text` is
// all options as text; a file of other options is not used. Fails as
// DescribeMap does.
[[nodiscard]] absl::StatusOr<RememberedMap> RememberMap(
    const PlaceOptions& place_options, const MatchOptions& match_options,
    const std::string& options_text, const std::string& path,
    const std::string& places_path, const Executor& executor,
    const ProgressCallback& on_progress = {});

// Unordered pairs of one map, the lower id as the reference: every pair, or
// with `retrieval` those in which either submap is a candidate of the other.
// Submaps of one trajectory whose indices differ by less than `min_index_gap`
// are left out: they share scans, and local SLAM has related them already.
// Pairs without a pose worth reporting yield nothing; the order is that of the
// ids.
[[nodiscard]] std::vector<Match> MatchWithin(
    const MatchOptions& options,
    const std::optional<RetrievalOptions>& retrieval,
    const std::map<SubmapId, Place>& places, int min_index_gap,
    const Executor& executor, const ProgressCallback& on_progress = {});

// Pairs of a reference of one map and a query of another, in the same way.
[[nodiscard]] std::vector<Match> MatchBetween(
    const MatchOptions& options,
    const std::optional<RetrievalOptions>& retrieval,
    const std::map<SubmapId, Place>& references,
    const std::map<SubmapId, Place>& queries, const Executor& executor,
    const ProgressCallback& on_progress = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOOP_CLOSING_DESCRIBED_MAP_H_
