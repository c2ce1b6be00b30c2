// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/changes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/geometry/evenly_spaced.h"
#include "cartographer_sdf/place/surface_cell_lookup.h"

namespace cartographer_sdf {
namespace {

constexpr double kChangeCellSize = 0.1;
// A wall point this near to a wall of the other map is unchanged, and changed
// this far from all of them, in free space [m]. Between the two, it says
// nothing.
constexpr double kUnchangedDistance = 0.15;
constexpr double kChangedDistance = 0.3;
constexpr double kMinOccupied = 0.5;
constexpr double kMinFree = 0.5;
// Pieces nearer than this belong together [cells].
constexpr int kReach = 2;
// Of a box, with the cells that it begins: some 0.3 m of wall.
constexpr double kMinExtent = 0.35;
constexpr size_t kMaxNumChanges = 1000;
constexpr size_t kMaxNumChangePairs = 1000;

using ChangeCell = std::pair<int, int>;

ChangeCell ChangeCellOf(const Eigen::Vector2d& point) {
  return {static_cast<int>(std::floor(point.x() / kChangeCellSize)),
          static_cast<int>(std::floor(point.y() / kChangeCellSize))};
}

// What the pairs say of a cell that has wall in one of the two maps.
struct Opinion {
  int num_changed = 0;
  int num_unchanged = 0;
};
using Opinions = std::map<ChangeCell, Opinion>;

// The cells of the map frame in which one pair sees wall changed or unchanged.
struct Seen {
  std::set<ChangeCell> changed;
  std::set<ChangeCell> unchanged;
};

// Looks the wall points up in the model.
Seen Compare(const SurfaceModel& model, const SurfaceModel& points,
             const Rigid2& T_model_points, const Rigid2& T_map_points) {
  const SurfaceCellLookup lookup(model, T_model_points);
  Seen seen;
  for (const SurfacePoint& point : points.walls) {
    if (point.weight < kMinOccupied) continue;
    const SurfaceCell* const cell = lookup.Find(point.position);
    if (cell == nullptr) continue;
    const double distance = 1e-3 * std::abs(cell->distance);
    if (distance <= kUnchangedDistance) {
      seen.unchanged.insert(ChangeCellOf(T_map_points * point.position));
    } else if (cell->observed && cell->free >= 255. * kMinFree &&
               distance >= kChangedDistance) {
      seen.changed.insert(ChangeCellOf(T_map_points * point.position));
    }
  }
  return seen;
}

void Add(const Seen& seen, Opinions* const opinions) {
  for (const ChangeCell& cell : seen.changed) ++(*opinions)[cell].num_changed;
  for (const ChangeCell& cell : seen.unchanged) {
    ++(*opinions)[cell].num_unchanged;
  }
}

// Cells that more pairs see changed than see wall unchanged there or next to
// it.
std::set<ChangeCell> ChangedCells(const Opinions& opinions) {
  std::set<ChangeCell> changed;
  for (const auto& [cell, opinion] : opinions) {
    if (opinion.num_changed == 0) continue;
    int num_unchanged = 0;
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        const auto next = opinions.find({cell.first + dx, cell.second + dy});
        if (next == opinions.end()) continue;
        num_unchanged = std::max(num_unchanged, next->second.num_unchanged);
      }
    }
    if (opinion.num_changed > num_unchanged) changed.insert(cell);
  }
  return changed;
}

// Takes a connected piece out of the cells.
std::vector<ChangeCell> TakePiece(std::set<ChangeCell>* const cells) {
  std::vector<ChangeCell> piece = {*cells->begin()};
  cells->erase(cells->begin());
  for (size_t k = 0; k < piece.size(); ++k) {
    for (int dx = -kReach; dx <= kReach; ++dx) {
      for (int dy = -kReach; dy <= kReach; ++dy) {
        const auto next =
            cells->find({piece[k].first + dx, piece[k].second + dy});
        if (next == cells->end()) continue;
        piece.push_back(*next);
        cells->erase(next);
      }
    }
  }
  return piece;
}

Change MakeChange(const ChangeKind kind, const std::vector<ChangeCell>& piece) {
  Change change{
      kind,
      {},
      kChangeCellSize * kChangeCellSize * static_cast<double>(piece.size())};
  for (const auto& [x, y] : piece) {
    change.box.extend(kChangeCellSize * Eigen::Vector2d(x, y));
    change.box.extend(kChangeCellSize * Eigen::Vector2d(x + 1, y + 1));
  }
  return change;
}

void AddChanges(const ChangeKind kind, std::set<ChangeCell> cells,
                std::vector<Change>* const changes) {
  while (!cells.empty()) {
    const Change change = MakeChange(kind, TakePiece(&cells));
    if (change.box.sizes().maxCoeff() >= kMinExtent) {
      changes->push_back(change);
    }
  }
}

}  // namespace

const char* ChangeKindName(const ChangeKind kind) {
  return kind == ChangeKind::kAppeared ? "appeared" : "vanished";
}

std::vector<Change> FindChanges(const PlacedMap& map, const PlacedMap& query,
                                const std::vector<PairPose>& agreeing,
                                const Executor& executor) {
  const std::vector<size_t> chosen = EvenlySpacedIndices(
      agreeing.size(), std::min(agreeing.size(), kMaxNumChangePairs));
  std::vector<Seen> appeared(chosen.size()), vanished(chosen.size());
  executor(chosen.size(), [&](const size_t k) {
    const PairPose& pair = agreeing[chosen[k]];
    const SurfaceModel& reference = map.places->at(pair.reference).surface;
    const SurfaceModel& other = query.places->at(pair.query).surface;
    const Rigid2& T_map_reference = map.layout->T_map_submap.at(pair.reference);
    appeared[k] = Compare(reference, other, pair.T_reference_query,
                          T_map_reference * pair.T_reference_query);
    vanished[k] = Compare(other, reference, pair.T_reference_query.Inverse(),
                          T_map_reference);
  });
  std::vector<Change> changes;
  for (const auto& [kind, seen] :
       {std::pair(ChangeKind::kAppeared, &appeared),
        std::pair(ChangeKind::kVanished, &vanished)}) {
    Opinions opinions;
    for (const Seen& of_pair : *seen) Add(of_pair, &opinions);
    AddChanges(kind, ChangedCells(opinions), &changes);
  }
  std::stable_sort(changes.begin(), changes.end(),
                   [](const Change& a, const Change& b) {
                     return a.wall_area > b.wall_area;
                   });
  if (changes.size() > kMaxNumChanges) {
    changes.erase(changes.begin() + kMaxNumChanges, changes.end());
  }
  return changes;
}

double ChangedArea(const std::vector<Change>& changes) {
  std::set<ChangeCell> cells;
  for (const Change& change : changes) {
    const ChangeCell last = ChangeCellOf(
        change.box.max() - Eigen::Vector2d::Constant(0.5 * kChangeCellSize));
    const ChangeCell first = ChangeCellOf(
        change.box.min() + Eigen::Vector2d::Constant(0.5 * kChangeCellSize));
    for (int x = first.first; x <= last.first; ++x) {
      for (int y = first.second; y <= last.second; ++y) cells.emplace(x, y);
    }
  }
  return kChangeCellSize * kChangeCellSize * static_cast<double>(cells.size());
}

std::string DescribeChanges(const std::vector<Change>& changes) {
  if (changes.empty()) return "nothing has changed";
  const auto num_appeared =
      std::count_if(changes.begin(), changes.end(), [](const Change& change) {
        return change.kind == ChangeKind::kAppeared;
      });
  const Change& largest = changes.front();
  const Eigen::Vector2d size = largest.box.sizes();
  const Eigen::Vector2d middle = largest.box.center();
  return absl::StrFormat(
      "%d objects have appeared and %d vanished, %.1f m2 together; the "
      "largest, %.1f m x %.1f m at (%.1f, %.1f) m, has %s",
      num_appeared, static_cast<int64_t>(changes.size()) - num_appeared,
      ChangedArea(changes), size.x(), size.y(), middle.x(), middle.y(),
      ChangeKindName(largest.kind));
}

}  // namespace cartographer_sdf
