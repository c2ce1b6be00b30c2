// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_REPORT_MATCH_TABLE_H_
#define CARTOGRAPHER_SDF_REPORT_MATCH_TABLE_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/recognition/match.h"

namespace cartographer_sdf {

// One row of the table that `match` and `close_loops` write: the best pose
// hypothesis for a pair of submaps, and the evidence for it.
struct MatchRow {
  SubmapId reference;
  SubmapId query;
  bool accepted = false;
  // Higher is more certain; comparable across pairs and maps.
  double score = 0.;
  Rigid2 T_reference_query;
  // One word, without commas.
  std::string verdict;
  int inliers = 0;
  double overlap = 0.;
  double hit_ratio = 0.;
  double contradiction_ratio = 0.;
};

[[nodiscard]] MatchRow ToRow(const Match& match, bool accepted,
                             const std::string& verdict);

// CSV with the columns reference_trajectory, reference_index, query_trajectory,
// query_index, accepted (0 or 1), score, x, y, yaw (of T_reference_query; m, m,
// rad), verdict, inliers, overlap, hit_ratio, contradiction_ratio. Rows keep
// their order.
[[nodiscard]] absl::StatusOr<std::vector<MatchRow>> ReadMatches(
    const std::string& path);

// Numbers have six decimals.
[[nodiscard]] absl::Status WriteMatches(const std::string& path,
                                        const std::vector<MatchRow>& matches);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_MATCH_TABLE_H_
