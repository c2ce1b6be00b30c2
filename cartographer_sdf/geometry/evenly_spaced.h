// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_GEOMETRY_EVENLY_SPACED_H_
#define CARTOGRAPHER_SDF_GEOMETRY_EVENLY_SPACED_H_

#include <algorithm>
#include <cstddef>
#include <vector>

namespace cartographer_sdf {

// Returns ascending indices of at most `count` of `size` items: the centres of
// equal parts.
[[nodiscard]] inline std::vector<size_t> EvenlySpacedIndices(
    const size_t size, const size_t count) {
  const size_t num_chosen = std::min(size, count);
  std::vector<size_t> indices;
  for (size_t k = 0; k < num_chosen; ++k) {
    indices.push_back((2 * k + 1) * size / (2 * num_chosen));
  }
  return indices;
}

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_GEOMETRY_EVENLY_SPACED_H_
