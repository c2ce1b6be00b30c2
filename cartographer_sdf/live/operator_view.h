// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What the operator of a robot sees of the searcher, without the types of any
// middleware: the nodes in ros/ turn it into messages.

#ifndef CARTOGRAPHER_SDF_LIVE_OPERATOR_VIEW_H_
#define CARTOGRAPHER_SDF_LIVE_OPERATOR_VIEW_H_

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/live/map_builder.h"

namespace cartographer_sdf {

// In [0, 1] each.
struct Color {
  float red = 0.f;
  float green = 0.f;
  float blue = 0.f;
  float alpha = 1.f;
};

// In the map frame [m].
struct Segment {
  Eigen::Vector2d begin;
  Eigen::Vector2d end;
};

// Segments that look the same.
struct SegmentGroup {
  std::string name;
  Color color;
  double width = 0.;  // [m]
  std::vector<Segment> segments;
};

// Returns a group for each status of a closure, named after it, and one for
// "refused" candidates: always all of them, in the same order, so that what is
// shown of an empty group disappears. A segment goes from the reference to the
// query; to where the match puts it, if the query is not in the pose graph. A
// closure whose reference is gone has none.
[[nodiscard]] std::vector<SegmentGroup> DrawMatches(
    const std::vector<ClosureRecord>& closures,
    const std::vector<RefusedMatch>& refused,
    const std::map<SubmapId, Rigid2>& T_map_submap);

// Of the best placement and of its runner-up being right, where each excludes
// the other and both may be wrong; 0 where there is none.
struct Probabilities {
  double best = 0.;
  double runner_up = 0.;
};
[[nodiscard]] Probabilities ProbabilitiesOf(const LocalizationResult& result);

enum class SearchState {
  kMapping,    // no map is loaded, or the trajectory is not searched for
  kSearching,  // its pose in the map is unknown
  kLocated,
  kLost,  // it had been localised and is searched for again
};
// "mapping", ...
[[nodiscard]] const char* SearchStateName(SearchState state);

// `localization` is of the trajectory that is shown; none if there is none.
[[nodiscard]] SearchState StateOf(
    const std::optional<LocalizationResult>& localization);

// One line of state, and names and values for a table.
struct NodeStatus {
  bool is_fine = true;  // false: the pose is not known
  std::string message;
  std::vector<std::pair<std::string, std::string>> values;
};

// `cpu_share` is the worker's, of one core.
[[nodiscard]] NodeStatus DescribeStatus(
    const LiveSummary& summary,
    const std::optional<LocalizationResult>& localization, double cpu_share);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_OPERATOR_VIEW_H_
