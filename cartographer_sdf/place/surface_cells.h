// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The cells of a surface model: nearly all of the memory of a place. They can
// be dropped and made again, exactly as they were, from runs of equal cells
// that take a twentieth of it: walls and what is free determine the distances.

#ifndef CARTOGRAPHER_SDF_PLACE_SURFACE_CELLS_H_
#define CARTOGRAPHER_SDF_PLACE_SURFACE_CELLS_H_

#include <Eigen/Core>
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

namespace cartographer_sdf {

// One cell of the distance field, in four bytes: verification is bound by
// memory.
struct SurfaceCell {
  int16_t distance;  // signed distance to the nearest wall [mm], saturated
  // Certainty that the cell is free, 0 (occupied or unknown) to 255.
  uint8_t free;
  bool observed;
};

using SurfaceCellArray =
    Eigen::Array<SurfaceCell, Eigen::Dynamic, Eigen::Dynamic>;

// To the nearest integer, halves away from zero; as std::lround, but of whole
// columns at once. The number must fit an integer.
[[nodiscard]] inline int RoundHalfAway(const float number) {
  const int towards_zero = static_cast<int>(number);
  const float rest = number - static_cast<float>(towards_zero);
  return towards_zero + (rest >= 0.5f ? 1 : 0) - (rest <= -0.5f ? 1 : 0);
}

// As SurfaceCell::distance. Stays negative inside walls, however fine the grid.
[[nodiscard]] inline int16_t DistanceInMillimetres(const float meters) {
  constexpr float kLimit = 32767.f;
  const int rounded =
      RoundHalfAway(std::clamp(1000.f * meters, -kLimit, kLimit));
  return static_cast<int16_t>(meters < 0.f ? std::min(rounded, -1) : rounded);
}

// The same cells as runs, x running fastest. A run is a word: in the lower 9
// bits what each of its cells is (0: unknown, 1: occupied, from 2 on: free,
// with that certainty); above them its length, up to 126, or 127 if the length
// is in the two words that follow, the lower one first.
struct CellPack {
  Eigen::Array2i size = {0, 0};
  double resolution = 0.;  // [m]
  std::vector<uint16_t> runs;
};

// `cells` must be as UnpackCells makes them: occupied where the distance is
// negative, and with the distances of these.
[[nodiscard]] CellPack PackCells(const SurfaceCellArray& cells,
                                 double resolution);
// Whether the runs have the right number of cells, and an occupied one.
[[nodiscard]] bool IsValid(const CellPack& pack);
// `pack` must be valid. Some milliseconds for a large submap.
[[nodiscard]] SurfaceCellArray UnpackCells(const CellPack& pack);

class SurfaceCells;

// Bounds the memory of many arrays of cells: drops those that were not looked
// at for longest. What is made again is what was dropped, so that no result
// depends on the bound. Thread-safe.
class CellMemory {
 public:
  // Arrays in use, and the one that was looked at last, may exceed the bound.
  explicit CellMemory(size_t max_num_bytes) : max_num_bytes_(max_num_bytes) {}
  CellMemory(const CellMemory&) = delete;
  CellMemory& operator=(const CellMemory&) = delete;

  [[nodiscard]] size_t NumBytes() const;

 private:
  friend class SurfaceCells;
  struct Entry;

  void Add(Entry* entry);
  void Remove(Entry* entry);
  [[nodiscard]] std::shared_ptr<const SurfaceCellArray> Restore(Entry* entry);
  void DropBeyondBound(const Entry* kept);

  const size_t max_num_bytes_;
  std::atomic<uint64_t> clock_{0};
  mutable std::mutex mutex_;
  // Those that have an array.
  std::set<Entry*> resident_;
  size_t num_bytes_ = 0;
};

// Cells that stay in memory as long as it lives.
class PinnedCells {
 public:
  explicit PinnedCells(const SurfaceCellArray* const cells) : cells_(cells) {}
  explicit PinnedCells(std::shared_ptr<const SurfaceCellArray> kept)
      : cells_(kept.get()), kept_(std::move(kept)) {}

  [[nodiscard]] const SurfaceCellArray& operator*() const { return *cells_; }
  [[nodiscard]] const SurfaceCellArray* operator->() const { return cells_; }

 private:
  const SurfaceCellArray* cells_;
  std::shared_ptr<const SurfaceCellArray> kept_;  // null where none is dropped
};

// An immutable array of cells. Copies share it. Pin is thread-safe.
class SurfaceCells {
 public:
  SurfaceCells() = default;
  // As PackCells requires.
  SurfaceCells(SurfaceCellArray cells, double resolution);
  // `pack` must be valid. The cells are made when they are looked at.
  explicit SurfaceCells(CellPack pack);

  // Does nothing without cells, or if their memory is bounded already. Not
  // thread-safe.
  void Bound(const std::shared_ptr<CellMemory>& memory);

  // The cells themselves; they must exist.
  [[nodiscard]] PinnedCells Pin() const;
  [[nodiscard]] CellPack Pack() const;
  // Of the array, whether or not it is in memory.
  [[nodiscard]] size_t NumBytes() const;

 private:
  std::shared_ptr<CellMemory::Entry> entry_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PLACE_SURFACE_CELLS_H_
