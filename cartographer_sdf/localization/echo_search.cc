// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/echo_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <queue>
#include <tuple>

#include "cartographer_sdf/geometry/evenly_spaced.h"

namespace cartographer_sdf {
namespace {

// Distances from the middle of a square to a wall, as fractions of its side:
// the least is half of it, as far as an echo may be from the middle.
constexpr double kScoreStep = 0.5;
// So many echoes are compared, evenly spaced among all: as many as make a sum
// of scores that fits into a byte.
constexpr size_t kMaxNumEchoes = 64;
static_assert(kMaxNumEchoes * EchoMap::kMaxScore <= UINT8_MAX);
// Nearer echoes are left out [m]: near any wall some of them fit, and among
// chairs they are most of all echoes.
constexpr double kMinRange = 1.2;
// In a map with room for more, squares are larger than viewpoints are apart, so
// that a search takes no more than some 12 ms.
constexpr double kMaxNumStandingSquares = 12000.;
// Poses that are kept for each that is returned: neighbours are near each
// other.
constexpr size_t kNumKeptPerEchoPose = 20;
// Poses are distinct if they differ by more [sides], [directions].
constexpr double kSameDistance = 1.5;
constexpr int kSameTurn = 3;

// So many squares of a row, from the first on, are compared at once.
constexpr int kBlockSize = 16;
struct Block {
  int x;
  int y;
};
using BlockSums = std::array<uint8_t, kBlockSize>;

struct ScoredPose {
  int score;
  int turn;  // of the robot's x axis, in directions
  int y;
  int x;

  // The best first.
  friend bool operator<(const ScoredPose& a, const ScoredPose& b) {
    return std::tuple(-a.score, a.turn, a.y, a.x) <
           std::tuple(-b.score, b.turn, b.y, b.x);
  }
};

// Those in which a robot can stand.
std::vector<Block> FindBlocks(const EchoMap& map) {
  std::vector<Block> blocks;
  for (int y = 0; y < map.standing.cols(); ++y) {
    for (int x = 0; x < map.standing.rows(); x += kBlockSize) {
      const Eigen::Index size =
          std::min<Eigen::Index>(kBlockSize, map.standing.rows() - x);
      if (map.standing.col(y).segment(x, size).any()) blocks.push_back({x, y});
    }
  }
  return blocks;
}

// The scores, with zeros all round, so that no echo of a sweep falls outside.
class PaddedScores {
 public:
  PaddedScores(const EchoMap& map, const std::vector<Eigen::Vector2d>& echoes) {
    double range = 0.;
    for (const Eigen::Vector2d& echo : echoes) {
      range = std::max(range, echo.norm());
    }
    padding_ = static_cast<Eigen::Index>(std::ceil(range / map.side)) + 1;
    scores_.setZero(map.scores.rows() + 2 * padding_ + kBlockSize,
                    map.scores.cols() + 2 * padding_);
    scores_.block(padding_, padding_, map.scores.rows(), map.scores.cols()) =
        map.scores;
  }

  // Of the square at the offset from another: how far it is from that.
  [[nodiscard]] std::ptrdiff_t Step(const Eigen::Vector2d& offset) const {
    return std::lround(offset.y()) * scores_.rows() + std::lround(offset.x());
  }

  // Adds up, for each square of the block, the scores of the squares so far
  // from it.
  [[nodiscard]] BlockSums Sum(const Block& block,
                              const std::vector<std::ptrdiff_t>& steps) const {
    const uint8_t* const first =
        &scores_(block.x + padding_, block.y + padding_);
    // Words of eight sums each: none of them carries into the next. In two
    // variables, which stay in registers.
    uint64_t low = 0, high = 0;
    for (const std::ptrdiff_t step : steps) {
      low += Word(first + step);
      high += Word(first + step + sizeof(uint64_t));
    }
    BlockSums sums;
    std::memcpy(sums.data(), &low, sizeof(low));
    std::memcpy(sums.data() + sizeof(low), &high, sizeof(high));
    return sums;
  }

 private:
  [[nodiscard]] static uint64_t Word(const uint8_t* const bytes) {
    uint64_t word;
    std::memcpy(&word, bytes, sizeof(word));
    return word;
  }

  Eigen::Index padding_;
  Eigen::Array<uint8_t, Eigen::Dynamic, Eigen::Dynamic> scores_;
};

// Those that can lie in the map.
std::vector<Eigen::Vector2d> EchoesFromCentre(const EchoMap& map,
                                              const Sweep& sweep) {
  const double max_range =
      map.side * std::hypot(map.scores.rows(), map.scores.cols());
  std::vector<Eigen::Vector2d> all;
  for (const RobotBeam& beam : sweep.beams) {
    const Eigen::Vector2d echo = beam.end - sweep.centre;
    const double range = echo.norm();
    if (beam.has_echo && range >= kMinRange && range <= max_range) {
      all.push_back(echo);
    }
  }
  std::vector<Eigen::Vector2d> echoes;
  for (const size_t k :
       EvenlySpacedIndices(all.size(), std::min(all.size(), kMaxNumEchoes))) {
    echoes.push_back(all[k]);
  }
  return echoes;
}

// The best poses of all directions, the best first.
std::vector<ScoredPose> BestPoses(const EchoMap& map,
                                  const std::vector<Eigen::Vector2d>& echoes,
                                  const size_t max_num_poses) {
  const std::vector<Block> blocks = FindBlocks(map);
  const PaddedScores scores(map, echoes);
  std::vector<std::ptrdiff_t> steps(echoes.size());
  std::priority_queue<ScoredPose> kept;  // the worst on top
  for (int turn = 0; turn < kNumDirections; ++turn) {
    const Rigid2 turned(0., 0., 2. * M_PI * turn / kNumDirections);
    for (size_t k = 0; k < echoes.size(); ++k) {
      steps[k] = scores.Step(turned * echoes[k] / map.side);
    }
    for (const Block& block : blocks) {
      const BlockSums sums = scores.Sum(block, steps);
      const bool is_full = kept.size() >= max_num_poses;
      if (is_full &&
          *std::max_element(sums.begin(), sums.end()) <= kept.top().score) {
        continue;
      }
      for (int k = 0; k < kBlockSize; ++k) {
        if (is_full && sums[k] <= kept.top().score) continue;
        const int x = block.x + k;
        if (x >= map.standing.rows() || !map.standing(x, block.y)) continue;
        kept.push({sums[k], turn, block.y, x});
        if (kept.size() > max_num_poses) kept.pop();
      }
    }
  }
  std::vector<ScoredPose> best;
  for (; !kept.empty(); kept.pop()) best.push_back(kept.top());
  std::reverse(best.begin(), best.end());
  return best;
}

bool IsSameSquare(const ScoredPose& a, const ScoredPose& b) {
  const int turn = std::abs(a.turn - b.turn);
  return std::min(turn, kNumDirections - turn) <= kSameTurn &&
         std::hypot(a.x - b.x, a.y - b.y) < kSameDistance;
}

}  // namespace

EchoMap MakeEchoMap(const RayMap& rays, const Viewpoints& viewpoints) {
  const CellGeometry& geometry = rays.geometry();
  const double growth =
      std::sqrt(std::max(1., static_cast<double>(viewpoints.positions.size()) /
                                 kMaxNumStandingSquares));
  const int side = static_cast<int>(std::lround(
      std::clamp<double>(growth * viewpoints.step / geometry.resolution, 1.,
                         geometry.size.maxCoeff())));
  EchoMap map;
  map.side = side * geometry.resolution;
  const Eigen::Array2i size = (geometry.size + side - 1) / side;
  map.scores.resize(size.x(), size.y());
  for (int y = 0; y < size.y(); ++y) {
    for (int x = 0; x < size.x(); ++x) {
      const Eigen::Array2i middle =
          (side * Eigen::Array2i(x, y) + side / 2).min(geometry.size - 1);
      const double distance =
          std::max(0.f, rays.field.distance(middle.x(), middle.y()));
      const double steps = std::floor(distance / (kScoreStep * map.side));
      map.scores(x, y) =
          static_cast<uint8_t>(std::max(0., EchoMap::kMaxScore - steps));
    }
  }
  map.standing.setConstant(size.x(), size.y(), false);
  for (const Eigen::Vector2d& position : viewpoints.positions) {
    const Eigen::Array2i square = position.array().cast<int>() / side;
    map.standing(square.x(), square.y()) = true;
  }
  return map;
}

std::vector<Rigid2> SearchEchoes(const EchoMap& map, const Sweep& sweep,
                                 const size_t max_num_poses) {
  const std::vector<Eigen::Vector2d> echoes = EchoesFromCentre(map, sweep);
  if (echoes.empty() || max_num_poses == 0) return {};
  std::vector<ScoredPose> kept;
  std::vector<Rigid2> poses;
  for (const ScoredPose& pose :
       BestPoses(map, echoes, kNumKeptPerEchoPose * max_num_poses)) {
    if (poses.size() >= max_num_poses) break;
    if (std::any_of(kept.begin(), kept.end(), [&pose](const ScoredPose& other) {
          return IsSameSquare(pose, other);
        })) {
      continue;
    }
    kept.push_back(pose);
    const Rigid2 turned(0., 0., 2. * M_PI * pose.turn / kNumDirections);
    poses.emplace_back(
        map.side * (Eigen::Vector2d(pose.x, pose.y).array() + 0.5).matrix() -
            turned * sweep.centre,
        turned.rotation());
  }
  return poses;
}

}  // namespace cartographer_sdf
