// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/trajectory_links.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

bool IsBroken(const TrajectoryLinkOptions& options,
              const VerificationOptions& verification,
              const SurfaceModel& first, const SurfaceModel& second,
              const Rigid2& T_first_second) {
  if (!OverlapsBy(options.min_overlap_area, first, second, T_first_second)) {
    return false;
  }
  const std::optional<MeasuredPose> measured =
      RegisterAndMeasure(verification, first, second, T_first_second);
  return measured &&
         measured->evidence.overlap_area >= options.min_overlap_area &&
         measured->evidence.MeanContradictionRatio() >
             options.max_contradiction_ratio;
}

}  // namespace

std::string Validate(const TrajectoryLinkOptions& options) {
  if (options.index_step < 1 || options.index_step > 100) {
    return "index_step must lie between 1 and 100";
  }
  if (!(options.max_contradiction_ratio >= 0. &&
        options.min_overlap_area >= 0.)) {
    return "max_contradiction_ratio and min_overlap_area must not be negative";
  }
  return "";
}

TrajectoryLinks::TrajectoryLinks(const TrajectoryLinkOptions& options,
                                 const VerificationOptions& verification,
                                 const TrajectoryPlaces& map,
                                 const Executor& executor)
    : index_step_(options.index_step) {
  CHECK_EQ(Validate(options), "");
  std::vector<const Place*> places;
  for (const auto& [id, place] : *map.places) places.push_back(&place);
  std::vector<char> broken(places.size(), 0);
  executor(places.size(), [&](const size_t k) {
    const SubmapId& first = places[k]->id;
    if (first.index > std::numeric_limits<int>::max() - index_step_) return;
    const SubmapId second{first.trajectory, first.index + index_step_};
    const auto place = map.places->find(second);
    if (place == map.places->end()) return;
    const Rigid2 T_first_second =
        map.odometry->at(first).T_local_submap.Inverse() *
        map.odometry->at(second).T_local_submap;
    broken[k] = IsBroken(options, verification, places[k]->surface,
                         place->second.surface, T_first_second);
  });
  for (size_t k = 0; k < places.size(); ++k) {
    if (broken[k] != 0) broken_.insert(places[k]->id);
  }
}

bool TrajectoryLinks::IsBrokenBetween(const SubmapId& a,
                                      const SubmapId& b) const {
  if (a.trajectory != b.trajectory) return false;
  const SubmapId first = std::min(a, b);
  const SubmapId last = std::max(a, b);
  const auto link = broken_.lower_bound(first);
  return link != broken_.end() && link->trajectory == first.trajectory &&
         link->index <= last.index - index_step_;
}

}  // namespace cartographer_sdf
