// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_GRID_SUBMAP_ID_H_
#define CARTOGRAPHER_SDF_GRID_SUBMAP_ID_H_

#include <ostream>
#include <tuple>

namespace cartographer_sdf {

// Cartographer's identifier of a submap: its trajectory and its index within
// the trajectory.
struct SubmapId {
  int trajectory = 0;
  int index = 0;

  friend bool operator==(const SubmapId& a, const SubmapId& b) {
    return a.trajectory == b.trajectory && a.index == b.index;
  }
  friend bool operator!=(const SubmapId& a, const SubmapId& b) {
    return !(a == b);
  }
  friend bool operator<(const SubmapId& a, const SubmapId& b) {
    return std::tie(a.trajectory, a.index) < std::tie(b.trajectory, b.index);
  }
  friend std::ostream& operator<<(std::ostream& out, const SubmapId& id) {
    return out << id.trajectory << "," << id.index;
  }
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_GRID_SUBMAP_ID_H_
