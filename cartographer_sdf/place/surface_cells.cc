// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/place/surface_cells.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "cartographer_sdf/field/distance_field.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr int kStateBits = 9;
constexpr uint16_t kStateMask = (1 << kStateBits) - 1;
constexpr uint16_t kUnknownState = 0;
constexpr uint16_t kOccupiedState = 1;
constexpr uint16_t kFreeState = 2;
constexpr uint16_t kNumStates = kFreeState + 256;
constexpr uint32_t kLongRun = 127;

uint16_t StateOf(const SurfaceCell& cell) {
  if (!cell.observed) return kUnknownState;
  if (cell.distance < 0) return kOccupiedState;
  return static_cast<uint16_t>(kFreeState + cell.free);
}

void AppendRun(const uint16_t state, const size_t length,
               std::vector<uint16_t>* const runs) {
  if (length < kLongRun) {
    runs->push_back(static_cast<uint16_t>(length << kStateBits | state));
    return;
  }
  runs->push_back(static_cast<uint16_t>(kLongRun << kStateBits | state));
  runs->push_back(static_cast<uint16_t>(length & 0xffff));
  runs->push_back(static_cast<uint16_t>(length >> 16));
}

size_t NumCells(const CellPack& pack) {
  return static_cast<size_t>(pack.size.x()) *
         static_cast<size_t>(pack.size.y());
}

// Calls visit(state, length) for each run; returns false where the runs end
// within one.
template <typename Visitor>
bool VisitRuns(const std::vector<uint16_t>& runs, const Visitor& visit) {
  for (size_t k = 0; k < runs.size(); ++k) {
    const uint16_t state = runs[k] & kStateMask;
    uint32_t length = static_cast<uint32_t>(runs[k]) >> kStateBits;
    if (length == kLongRun) {
      if (runs.size() - k < 3) return false;
      length = runs[k + 1] | static_cast<uint32_t>(runs[k + 2]) << 16;
      k += 2;
    }
    visit(state, length);
  }
  return true;
}

// As far as the distances depend on it.
OccupancyGrid GridOf(const CellPack& pack) {
  CellGeometry geometry;
  geometry.size = pack.size;
  geometry.resolution = pack.resolution;
  OccupancyGrid grid = UnknownGrid(geometry);
  Eigen::Index at = 0;
  VisitRuns(pack.runs, [&](const uint16_t state, const uint32_t length) {
    if (state != kUnknownState) {
      std::fill_n(grid.known.data() + at, length, true);
      std::fill_n(grid.probability.data() + at, length,
                  state == kOccupiedState ? 1.f : 0.f);
    }
    at += length;
  });
  return grid;
}

}  // namespace

CellPack PackCells(const SurfaceCellArray& cells, const double resolution) {
  CellPack pack;
  pack.size = {static_cast<int>(cells.rows()), static_cast<int>(cells.cols())};
  pack.resolution = resolution;
  const size_t size = static_cast<size_t>(cells.size());
  const SurfaceCell* const data = cells.data();
  for (size_t begin = 0; begin < size;) {
    const uint16_t state = StateOf(data[begin]);
    size_t end = begin + 1;
    while (end < size && StateOf(data[end]) == state) ++end;
    AppendRun(state, end - begin, &pack.runs);
    begin = end;
  }
  return pack;
}

bool IsValid(const CellPack& pack) {
  if ((pack.size < 1).any()) return false;
  size_t num_cells = 0;
  bool has_occupied = false;
  bool are_states = true;
  const bool is_whole =
      VisitRuns(pack.runs, [&](const uint16_t state, const uint32_t length) {
        num_cells += length;
        has_occupied = has_occupied || (state == kOccupiedState && length > 0);
        are_states = are_states && state < kNumStates;
      });
  return is_whole && are_states && has_occupied && num_cells == NumCells(pack);
}

SurfaceCellArray UnpackCells(const CellPack& pack) {
  const OccupancyGrid grid = GridOf(pack);
  const std::optional<DistanceField> field =
      MakeDistanceField({0.5, /*padding_meters=*/0.}, grid);
  CHECK(field.has_value());
  SurfaceCellArray cells(pack.size.x(), pack.size.y());
  const float* const distance = field->distance.data();
  Eigen::Index at = 0;
  VisitRuns(pack.runs, [&](const uint16_t state, const uint32_t length) {
    const bool is_observed = state != kUnknownState;
    const auto free =
        static_cast<uint8_t>(state < kFreeState ? 0 : state - kFreeState);
    for (const Eigen::Index end = at + length; at < end; ++at) {
      cells.data()[at] = {DistanceInMillimetres(distance[at]), free,
                          is_observed};
    }
  });
  return cells;
}

struct CellMemory::Entry {
  ~Entry() {
    if (memory) memory->Remove(this);
  }

  // Null while it is dropped. Accessed atomically where the memory is bounded.
  std::shared_ptr<const SurfaceCellArray> cells;
  size_t num_bytes = 0;
  double resolution = 0.;
  CellPack pack;  // without runs before the cells are first dropped
  std::shared_ptr<CellMemory> memory;  // null: they are never dropped
  std::atomic<uint64_t> last_used{0};
};

size_t CellMemory::NumBytes() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return num_bytes_;
}

void CellMemory::Add(Entry* const entry) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (entry->cells == nullptr || !resident_.insert(entry).second) return;
  entry->last_used = ++clock_;
  num_bytes_ += entry->num_bytes;
  DropBeyondBound(entry);
}

void CellMemory::Remove(Entry* const entry) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (resident_.erase(entry) > 0) num_bytes_ -= entry->num_bytes;
}

std::shared_ptr<const SurfaceCellArray> CellMemory::Restore(
    Entry* const entry) {
  std::shared_ptr<const SurfaceCellArray> cells =
      std::make_shared<const SurfaceCellArray>(UnpackCells(entry->pack));
  const std::lock_guard<std::mutex> lock(mutex_);
  // Another thread may have been faster.
  if (!resident_.insert(entry).second) return std::atomic_load(&entry->cells);
  std::atomic_store(&entry->cells, cells);
  entry->last_used = ++clock_;
  num_bytes_ += entry->num_bytes;
  DropBeyondBound(entry);
  return cells;
}

void CellMemory::DropBeyondBound(const Entry* const kept) {
  while (num_bytes_ > max_num_bytes_ && resident_.size() > 1) {
    Entry* oldest = nullptr;
    for (Entry* const entry : resident_) {
      if (entry != kept &&
          (oldest == nullptr || entry->last_used < oldest->last_used)) {
        oldest = entry;
      }
    }
    if (oldest->pack.runs.empty()) {
      oldest->pack = PackCells(*oldest->cells, oldest->resolution);
    }
    std::atomic_store(&oldest->cells,
                      std::shared_ptr<const SurfaceCellArray>());
    resident_.erase(oldest);
    num_bytes_ -= oldest->num_bytes;
  }
}

SurfaceCells::SurfaceCells(SurfaceCellArray cells, const double resolution)
    : entry_(std::make_shared<CellMemory::Entry>()) {
  entry_->num_bytes = sizeof(SurfaceCell) * static_cast<size_t>(cells.size());
  entry_->resolution = resolution;
  entry_->cells = std::make_shared<const SurfaceCellArray>(std::move(cells));
}

SurfaceCells::SurfaceCells(CellPack pack)
    : entry_(std::make_shared<CellMemory::Entry>()) {
  CHECK(IsValid(pack));
  entry_->num_bytes = sizeof(SurfaceCell) * NumCells(pack);
  entry_->resolution = pack.resolution;
  entry_->pack = std::move(pack);
  entry_->memory =
      std::make_shared<CellMemory>(std::numeric_limits<size_t>::max());
}

void SurfaceCells::Bound(const std::shared_ptr<CellMemory>& memory) {
  if (!entry_) return;
  if (entry_->memory) entry_->memory->Remove(entry_.get());
  entry_->memory = memory;
  memory->Add(entry_.get());
}

PinnedCells SurfaceCells::Pin() const {
  CHECK(entry_);
  CellMemory::Entry* const entry = entry_.get();
  if (!entry->memory) return PinnedCells(entry->cells.get());
  std::shared_ptr<const SurfaceCellArray> cells =
      std::atomic_load(&entry->cells);
  if (cells == nullptr) return PinnedCells(entry->memory->Restore(entry));
  entry->last_used.store(++entry->memory->clock_, std::memory_order_relaxed);
  return PinnedCells(std::move(cells));
}

CellPack SurfaceCells::Pack() const {
  if (entry_->memory) {
    const std::lock_guard<std::mutex> lock(entry_->memory->mutex_);
    if (!entry_->pack.runs.empty()) return entry_->pack;
  }
  return PackCells(*Pin(), entry_->resolution);
}

size_t SurfaceCells::NumBytes() const { return entry_ ? entry_->num_bytes : 0; }

}  // namespace cartographer_sdf
