// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/place/field_memory.h"

#include "glog/logging.h"

namespace cartographer_sdf {

FieldMemory::FieldMemory(const PlaceOptions& options)
    : max_num_bytes_(static_cast<size_t>(1e6 * options.max_field_megabytes)) {
  CHECK_EQ(Validate(options), "");
}

void FieldMemory::Add(std::map<SubmapId, Place>* const places) {
  for (auto& [id, place] : *places) {
    SurfaceCells& cells = place.surface.cells;
    num_bytes_ += cells.NumBytes();
    if (memory_) {
      cells.Bound(memory_);
    } else {
      unbounded_.push_back(cells);
    }
  }
  if (memory_ || num_bytes_ <= max_num_bytes_) return;
  memory_ = std::make_shared<CellMemory>(max_num_bytes_);
  for (SurfaceCells& cells : unbounded_) cells.Bound(memory_);
  unbounded_.clear();
}

size_t FieldMemory::NumBytes() const {
  return memory_ ? memory_->NumBytes() : num_bytes_;
}

}  // namespace cartographer_sdf
