// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Bounds the memory of the distance fields of a map
// (PlaceOptions::max_field_megabytes). No result depends on the bound.

#ifndef CARTOGRAPHER_SDF_PLACE_FIELD_MEMORY_H_
#define CARTOGRAPHER_SDF_PLACE_FIELD_MEMORY_H_

#include <cstddef>
#include <map>
#include <memory>
#include <vector>

#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/place/place.h"

namespace cartographer_sdf {

// As long as all fields fit, they are as they were: nothing is dropped, and
// looking at them takes no lock.
class FieldMemory {
 public:
  explicit FieldMemory(const PlaceOptions& options);

  // Counts the fields of these places, too. No other thread may look at them.
  void Add(std::map<SubmapId, Place>* places);

  // Of the fields that are in memory now.
  [[nodiscard]] size_t NumBytes() const;

 private:
  const size_t max_num_bytes_;
  size_t num_bytes_ = 0;
  // Those that were given as long as they fitted, then none.
  std::vector<SurfaceCells> unbounded_;
  std::shared_ptr<CellMemory> memory_;  // null as long as they fit
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PLACE_FIELD_MEMORY_H_
