// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// How far apart two submaps of a map are along what relates them: the way that
// was driven, cut short where a loop was closed. What is near in this sense is
// well known in relation to each other, however long ago it was; what is far
// may have drifted apart.

#ifndef CARTOGRAPHER_SDF_SESSIONS_DRIVEN_DISTANCES_H_
#define CARTOGRAPHER_SDF_SESSIONS_DRIVEN_DISTANCES_H_

#include <map>
#include <optional>
#include <vector>

#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/pbstream/map_file.h"

namespace cartographer_sdf {

class DrivenDistances {
 public:
  // Of the submaps of the pose graph. Shortest ways between all of them: n^2
  // numbers, some milliseconds for a hundred submaps.
  explicit DrivenDistances(const MapState& map);

  // [m]; none where nothing relates the two. Both must be in the map.
  [[nodiscard]] std::optional<double> Between(const SubmapId& a,
                                              const SubmapId& b) const;

 private:
  std::map<SubmapId, size_t> indices_;
  // Row by row; infinite where there is no way.
  std::vector<double> distances_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_SESSIONS_DRIVEN_DISTANCES_H_
