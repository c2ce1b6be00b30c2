// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Which submaps the host's pose graph has in a round, and which it had before
// and has no more. Trimmers run before the searcher does, so that a submap may
// enter the graph and be trimmed before any round shows it; and a submap that a
// round does not show may still be waiting in the host's queue. The indices
// tell the two apart: submaps of a trajectory enter in their order, so that
// those before one that was seen have entered as well.

#ifndef CARTOGRAPHER_SDF_LIVE_GRAPH_SUBMAPS_H_
#define CARTOGRAPHER_SDF_LIVE_GRAPH_SUBMAPS_H_

#include <cstddef>
#include <map>
#include <set>
#include <vector>

#include "cartographer_sdf/grid/submap_id.h"

namespace cartographer_sdf {

// Thread-compatible.
class GraphSubmaps {
 public:
  // `indices`: of all submaps of the trajectory that the graph has now. Those
  // below `num_entered` have entered the graph, now or before. Returns the
  // indices of submaps that are gone, each once.
  [[nodiscard]] std::vector<int> Update(int trajectory,
                                        const std::vector<int>& indices,
                                        int num_entered);
  // Whether an update with so many submaps would change nothing, provided that
  // no submap enters any more.
  [[nodiscard]] bool IsUpToDate(int trajectory, size_t num_submaps,
                                int num_entered) const;
  // Whether the submap was there in the last update.
  [[nodiscard]] bool Contains(const SubmapId& id) const;

 private:
  struct Trajectory {
    std::set<int> indices;
    int num_entered = 0;
    std::set<int> gone_before;  // of later indices than num_entered
  };
  std::map<int, Trajectory> trajectories_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_GRAPH_SUBMAPS_H_
