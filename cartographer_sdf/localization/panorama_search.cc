// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/panorama_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <queue>
#include <tuple>

namespace cartographer_sdf {
namespace {

// Most that one beam costs, and what it costs where the map is unknown, in
// units of a panorama.
constexpr uint8_t kMaxBeamCost = 15;
constexpr uint8_t kUnknownCost = 6;
// So many beams fit into the sums of bytes.
constexpr int kSearchBlockSize = 255 / kMaxBeamCost;
// Poses that are kept for each that is returned: neighbours are near each
// other.
constexpr size_t kNumKeptPerPose = 10;

struct SearchBeam {
  int direction;
  uint8_t range;
};

struct PoseCost {
  int cost;
  int viewpoint;
  int turn;  // of the robot's x axis, in directions

  friend bool operator<(const PoseCost& a, const PoseCost& b) {
    return std::tie(a.cost, a.viewpoint, a.turn) <
           std::tie(b.cost, b.viewpoint, b.turn);
  }
};

using TurnCosts = std::array<uint16_t, kNumDirections>;

// In an order in which the first ones spread over all directions.
std::vector<SearchBeam> SearchBeams(const Sweep& sweep) {
  std::array<int, kNumDirections> beam_of;
  beam_of.fill(-1);
  for (size_t k = 0; k < sweep.beams.size(); ++k) {
    const Eigen::Vector2d offset = sweep.beams[k].end - sweep.centre;
    const double turns = std::atan2(offset.y(), offset.x()) / (2. * M_PI);
    const int direction =
        static_cast<int>((turns - std::floor(turns)) * kNumDirections);
    beam_of[direction % kNumDirections] = static_cast<int>(k);
  }
  std::vector<SearchBeam> beams;
  constexpr int kStride = 37;  // has no factor in common with the number
  for (int k = 0; k < kNumDirections; ++k) {
    const int direction = k * kStride % kNumDirections;
    if (beam_of[direction] < 0) continue;
    const RobotBeam& beam = sweep.beams[beam_of[direction]];
    // It may have met glass or a dark wall.
    if (!beam.has_echo) continue;
    const uint8_t range = static_cast<uint8_t>(std::min(
        255., std::round((beam.end - sweep.centre).norm() / kPanoramaUnit)));
    beams.push_back({direction, range});
  }
  return beams;
}

// Adds what a beam costs for each turn. A loop over bytes, of which compilers
// make vector code as long as they know that the arrays are distinct, which GCC
// forgets where it makes the function part of its caller.
__attribute__((noinline)) void AddBeam(const SearchBeam& beam,
                                       const uint8_t* const ranges,
                                       const uint8_t* const masks,
                                       uint8_t* __restrict const sums) {
  const uint8_t* __restrict const range = ranges + beam.direction;
  const uint8_t* __restrict const mask = masks + beam.direction;
  const uint8_t seen = beam.range;
  for (int turn = 0; turn < kNumDirections; ++turn) {
    const uint8_t expected = range[turn];
    const uint8_t difference = static_cast<uint8_t>(std::max(expected, seen) -
                                                    std::min(expected, seen));
    const uint8_t cost =
        std::min<uint8_t>(difference, kMaxBeamCost) & mask[turn];
    // The mask has all bits, or none where the map is unknown.
    const uint8_t unknown_cost =
        kUnknownCost & static_cast<uint8_t>(~mask[turn]);
    sums[turn] = static_cast<uint8_t>(sums[turn] + (cost | unknown_cost));
  }
}

// Computes the cost of each turn at a viewpoint; returns false as soon as none
// can be below `bound`.
bool ComputeCosts(const std::vector<SearchBeam>& beams,
                  const uint8_t* const ranges, const uint8_t* const masks,
                  const int bound, TurnCosts* const costs) {
  costs->fill(0);
  std::array<uint8_t, kNumDirections> sums;
  for (size_t begin = 0; begin < beams.size(); begin += kSearchBlockSize) {
    const size_t end = std::min(begin + kSearchBlockSize, beams.size());
    sums.fill(0);
    for (size_t k = begin; k < end; ++k) {
      AddBeam(beams[k], ranges, masks, sums.data());
    }
    uint16_t least = UINT16_MAX;
    for (int turn = 0; turn < kNumDirections; ++turn) {
      (*costs)[turn] = static_cast<uint16_t>((*costs)[turn] + sums[turn]);
      least = std::min(least, (*costs)[turn]);
    }
    if (least > bound) return false;
  }
  return true;
}

// The best poses over all viewpoints, of which each is the best among its own
// turns nearby.
std::vector<PoseCost> BestCosts(const Viewpoints& viewpoints,
                                const std::vector<SearchBeam>& beams,
                                const size_t max_num_costs) {
  std::priority_queue<PoseCost> kept;  // the worst on top
  const size_t size = viewpoints.positions.size();
  // Scattered, so that good poses come early and make the bound tight.
  size_t stride = size * 5 / 8 + 1;
  while (std::gcd(stride, size) != 1) ++stride;
  TurnCosts costs;
  for (size_t n = 0; n < size; ++n) {
    const size_t viewpoint = n * stride % size;
    const bool is_full = kept.size() >= max_num_costs;
    const int bound = is_full ? kept.top().cost : INT32_MAX;
    if (!ComputeCosts(beams, viewpoints.RangesOf(viewpoint),
                      viewpoints.MasksOf(viewpoint), bound, &costs)) {
      continue;
    }
    for (int turn = 0; turn < kNumDirections; ++turn) {
      const int cost = costs[turn];
      if (cost > bound || cost > costs[(turn + 1) % kNumDirections] ||
          cost >= costs[(turn + kNumDirections - 1) % kNumDirections]) {
        continue;
      }
      kept.push({cost, static_cast<int>(viewpoint), turn});
      if (kept.size() > max_num_costs) kept.pop();
    }
  }
  std::vector<PoseCost> best;
  for (; !kept.empty(); kept.pop()) best.push_back(kept.top());
  std::reverse(best.begin(), best.end());
  return best;
}

}  // namespace

std::vector<Rigid2> SearchPanoramas(const Viewpoints& viewpoints,
                                    const double resolution, const Sweep& sweep,
                                    const size_t max_num_poses) {
  const std::vector<SearchBeam> beams = SearchBeams(sweep);
  if (beams.empty() || viewpoints.positions.empty()) return {};
  const double same_distance = 1.5 * viewpoints.step / resolution;
  constexpr int kSameTurn = 3;
  std::vector<PoseCost> kept;
  std::vector<Rigid2> poses;
  for (const PoseCost& cost :
       BestCosts(viewpoints, beams, kNumKeptPerPose * max_num_poses)) {
    if (poses.size() >= max_num_poses) break;
    const Eigen::Vector2d& position = viewpoints.positions[cost.viewpoint];
    const bool is_known =
        std::any_of(kept.begin(), kept.end(), [&](const PoseCost& other) {
          const int turn = std::abs(cost.turn - other.turn);
          return std::min(turn, kNumDirections - turn) <= kSameTurn &&
                 (viewpoints.positions[other.viewpoint] - position)
                         .squaredNorm() < same_distance * same_distance;
        });
    if (is_known) continue;
    kept.push_back(cost);
    const Rigid2 turned(0., 0., 2. * M_PI * cost.turn / kNumDirections);
    poses.emplace_back(resolution * position - turned * sweep.centre,
                       turned.rotation());
  }
  return poses;
}

}  // namespace cartographer_sdf
