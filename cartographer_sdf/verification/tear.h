// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Detects whether local SLAM tore a submap: slipped while building it, so that
// walls seen before and after the slip appear in it twice. The scans are split
// into parts by their order; if two parts see the same walls but contradict
// each other as placed, and agree once one of them is moved, the submap is
// torn.
//
// A heuristic that favours precision. Only parts that share walls can
// contradict each other: a submap that is bent evenly, or whose scans before
// and after the slip share no walls, counts as intact.

#ifndef CARTOGRAPHER_SDF_VERIFICATION_TEAR_H_
#define CARTOGRAPHER_SDF_VERIFICATION_TEAR_H_

#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/scan.h"

namespace cartographer_sdf {

// Agreement is the ratio of hits minus twice that of contradictions
// (agreement.h), as in the ranking: 1 if all walls coincide.
struct TearOptions {
  // Number of parts with equally many scans. More: finds slips near the ends,
  // but fewer walls are seen by two parts.
  int num_parts = 6;
  // Cell size of the grids that the parts are drawn into [m].
  double resolution_meters = 0.1;
  // Points farther from the robot are ignored [m].
  double max_range_meters = 30.;
  // Least number of wall cells of two parts that lie where the other has
  // observed; fewer are inconclusive.
  int min_num_points = 50;
  // Least gain in agreement of two parts by a better pose, and least agreement
  // there. Lower: finds smaller tears, and mistakes moved doors and people for
  // tears.
  double min_gain = 0.6;
  double min_agreement = 0.7;
  // The pose must differ from that of local SLAM by one of these [m], [rad].
  double min_translation_meters = 0.2;
  double min_rotation = 0.035;
};
[[nodiscard]] std::string Validate(const TearOptions& options);

struct Tear {
  // The two parts, counted from 0, `first` seen before `second`.
  int first_part;
  int second_part;
  // Moves the second part's walls, as placed in the submap, to their position
  // in the first part.
  Rigid2 T_first_second;
  // How far it moves the middle of the area seen by both [m].
  double translation;
  double agreement_as_placed;
  double agreement_as_registered;
  // Number of wall cells compared as placed.
  double num_points;
};

// Returns the clearest tear, or none if no two parts indicate one. `scans` are
// in the order in which they were inserted.
[[nodiscard]] std::optional<Tear> FindTear(
    const TearOptions& options, const std::vector<PlacedScan>& scans);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_VERIFICATION_TEAR_H_
