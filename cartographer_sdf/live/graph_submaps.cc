// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/graph_submaps.h"

#include <algorithm>
#include <utility>

namespace cartographer_sdf {

std::vector<int> GraphSubmaps::Update(const int trajectory,
                                      const std::vector<int>& indices,
                                      const int num_entered) {
  Trajectory& known = trajectories_[trajectory];
  const std::set<int> now(indices.begin(), indices.end());
  std::set<int> seen;  // before, or known to have entered
  seen.swap(known.indices);
  for (int index = known.num_entered; index < num_entered; ++index) {
    if (known.gone_before.erase(index) == 0) seen.insert(index);
  }
  known.num_entered = std::max(known.num_entered, num_entered);
  std::vector<int> gone;
  for (const int index : seen) {
    if (now.count(index) > 0) continue;
    gone.push_back(index);
    if (index >= known.num_entered) known.gone_before.insert(index);
  }
  known.indices = now;
  return gone;
}

bool GraphSubmaps::IsUpToDate(const int trajectory, const size_t num_submaps,
                              const int num_entered) const {
  const auto known = trajectories_.find(trajectory);
  return known != trajectories_.end() &&
         known->second.indices.size() == num_submaps &&
         known->second.num_entered >= num_entered;
}

bool GraphSubmaps::Contains(const SubmapId& id) const {
  const auto known = trajectories_.find(id.trajectory);
  return known != trajectories_.end() &&
         known->second.indices.count(id.index) > 0;
}

}  // namespace cartographer_sdf
