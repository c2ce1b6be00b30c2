// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Whether local SLAM tore a submap: slipped while it was built, so that walls
// that were seen before and after stand in it twice. The scans are cut into
// parts by their order; where two parts see the same walls but contradict each
// other as placed, and agree once one of them is moved, the submap is torn.
//
// A heuristic, made to be right when it speaks. What no two parts have seen
// can't contradict: a submap that is bent evenly, or whose scans before and
// after the slip share no walls, counts as whole.

#ifndef CARTOGRAPHER_SDF_VERIFICATION_TEAR_H_
#define CARTOGRAPHER_SDF_VERIFICATION_TEAR_H_

#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/scan.h"

namespace cartographer_sdf {

// Agreement is the ratio of hits less twice that of contradictions
// (agreement.h), as ranking counts: 1 where all walls coincide.
struct TearOptions {
  // Parts of equally many scans. More: finds slips near the ends, but fewer
  // walls are seen by two parts.
  int num_parts = 6;
  // Cells of the grids that the parts are drawn into [m].
  double resolution_meters = 0.1;
  // Points farther from the robot are left out [m].
  double max_range_meters = 30.;
  // Wall cells of two parts that lie where the other has observed; fewer say
  // nothing.
  int min_num_points = 50;
  // By how much a better pose must raise the agreement of two parts, and to
  // what at least. Lower: finds smaller tears, and takes moved doors and
  // people for some.
  double min_gain = 0.6;
  double min_agreement = 0.7;
  // The pose must differ by one of these from what local SLAM says [m], [rad].
  double min_translation_meters = 0.2;
  double min_rotation = 0.035;
};
[[nodiscard]] std::string Validate(const TearOptions& options);

struct Tear {
  // The two parts, counted from 0, `first` seen before `second`.
  int first_part;
  int second_part;
  // Takes the second part's walls, as placed in the submap, to where the first
  // part has them.
  Rigid2 T_first_second;
  // By how much that moves the middle of what both have seen [m].
  double translation;
  double agreement_as_placed;
  double agreement_as_registered;
  // Wall cells that were compared as placed.
  double num_points;
};

// `scans` in the order in which they were inserted. The clearest tear; none
// where no two parts give reason to believe in one. Tens of milliseconds.
[[nodiscard]] std::optional<Tear> FindTear(
    const TearOptions& options, const std::vector<PlacedScan>& scans);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_VERIFICATION_TEAR_H_
