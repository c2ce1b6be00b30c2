// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Whether walls confirm where local SLAM puts the submaps of a trajectory
// relative to each other. Submaps two indices apart share no scans and yet see
// much in common: where the walls of one stand in the free space of the other,
// local SLAM has slipped between them, and whatever is carried along the
// trajectory across that link is wrong.

#ifndef CARTOGRAPHER_SDF_RECOGNITION_TRAJECTORY_LINKS_H_
#define CARTOGRAPHER_SDF_RECOGNITION_TRAJECTORY_LINKS_H_

#include <set>
#include <string>

#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/place/trajectory_places.h"
#include "cartographer_sdf/verification/verification.h"

namespace cartographer_sdf {

struct TrajectoryLinkOptions {
  // Indices between the two submaps of a link. Consecutive submaps of
  // Cartographer share half of their scans, those two indices apart share none.
  int index_step = 2;
  // A link is broken where more of the walls (mean of both directions) stand in
  // the other's free space, at the registered pose.
  double max_contradiction_ratio = 0.05;
  // A link of a smaller common observed area says nothing [m^2].
  double min_overlap_area = 10.;
};
[[nodiscard]] std::string Validate(const TrajectoryLinkOptions& options);

class TrajectoryLinks {
 public:
  TrajectoryLinks(const TrajectoryLinkOptions& options,
                  const VerificationOptions& verification,
                  const TrajectoryPlaces& map, const Executor& executor);

  // Whether a link between the two submaps of one trajectory is broken. Links
  // that begin before the one or end behind the other do not count.
  [[nodiscard]] bool IsBrokenBetween(const SubmapId& a,
                                     const SubmapId& b) const;
  // The first submap of each broken link.
  [[nodiscard]] const std::set<SubmapId>& broken() const { return broken_; }

 private:
  const int index_step_;
  std::set<SubmapId> broken_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RECOGNITION_TRAJECTORY_LINKS_H_
