// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/query_parts.h"

#include <algorithm>
#include <set>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Less is a slip of local SLAM, which info --quality names [m].
constexpr double kMinJump = 3.;
// 99.99 % of true offsets lie within.
constexpr double kMaxSigmas = 4.3;

std::set<SubmapId> PlacesOf(const std::vector<PairPose>& votes,
                            const Placement& placement) {
  std::set<SubmapId> places;
  for (const size_t vote : placement.votes) places.insert(votes[vote].query);
  return places;
}

bool AnyIn(const std::set<SubmapId>& places, const std::set<SubmapId>& taken) {
  return std::any_of(
      places.begin(), places.end(),
      [&taken](const SubmapId& id) { return taken.count(id) > 0; });
}

// The strongest vote of the part on one of its places.
const PairPose& StrongestVote(const std::vector<PairPose>& votes,
                              const Placement& placement,
                              const SubmapId& place) {
  const PairPose* strongest = nullptr;
  for (const size_t vote : placement.votes) {
    const PairPose& pair = votes[vote];
    if (pair.query == place &&
        (strongest == nullptr || pair.score > strongest->score)) {
      strongest = &pair;
    }
  }
  return *CHECK_NOTNULL(strongest);
}

// Returns none where drift explains the offset between the two parts.
std::optional<Jump> FindJump(const ConsistencyOptions& consistency,
                             const MapPair& maps,
                             const std::vector<PairPose>& votes,
                             const QueryPart& first, const QueryPart& second) {
  if (first.last.trajectory != second.first.trajectory ||
      !(first.last < second.first)) {
    return std::nullopt;
  }
  const PairPose& before = StrongestVote(votes, first.placement, first.last);
  const PairPose& after = StrongestVote(votes, second.placement, second.first);
  const std::optional<double> in_query =
      maps.query->distances.Between(first.last, second.first);
  const std::optional<double> in_map =
      maps.map->distances.Between(before.reference, after.reference);
  if (!in_query || !in_map) return std::nullopt;
  const Eigen::Vector2d& centroid = maps.query->centroids.at(second.first);
  const double distance = (PlaceByVote(maps, before, second.first) * centroid -
                           PlaceByVote(maps, after, second.first) * centroid)
                              .norm();
  if (distance <=
      std::max(kMinJump,
               kMaxSigmas * DriftSigma(consistency, *in_query + *in_map))) {
    return std::nullopt;
  }
  return Jump{first.last, second.first, distance};
}

}  // namespace

QueryParts FindQueryParts(const PlacementOptions& options,
                          const ConsistencyOptions& consistency,
                          const MapPair& maps,
                          const std::vector<PairPose>& votes,
                          const std::vector<Placement>& placements) {
  QueryParts result;
  std::set<SubmapId> taken;
  for (const Placement& placement : placements) {
    const std::set<SubmapId> places = PlacesOf(votes, placement);
    const bool is_best = result.parts.empty();
    if (!is_best &&
        (placement.score < options.min_score || AnyIn(places, taken))) {
      continue;
    }
    taken.insert(places.begin(), places.end());
    result.parts.push_back({placement, *places.begin(), *places.rbegin()});
  }
  std::stable_sort(
      result.parts.begin(), result.parts.end(),
      [](const QueryPart& a, const QueryPart& b) { return a.first < b.first; });
  for (size_t k = 1; k < result.parts.size(); ++k) {
    const std::optional<Jump> jump = FindJump(
        consistency, maps, votes, result.parts[k - 1], result.parts[k]);
    if (jump) result.jumps.push_back(*jump);
  }
  return result;
}

std::string DescribeJumps(const std::vector<Jump>& jumps) {
  std::string text;
  for (const Jump& jump : jumps) {
    absl::StrAppend(
        &text, text.empty() ? "" : ", and ",
        absl::StrFormat("between its submaps %d,%d and %d,%d the query jumps "
                        "by %.1f m",
                        jump.before.trajectory, jump.before.index,
                        jump.after.trajectory, jump.after.index,
                        jump.distance));
  }
  if (text.empty()) return "";
  return absl::StrCat(text,
                      ": the robot was carried, or one of the maps is folded");
}

}  // namespace cartographer_sdf
