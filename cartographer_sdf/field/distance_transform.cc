// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/field/distance_transform.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

using Eigen::Index;

constexpr int kMaxSide = 32767;
// Of a row, at least: it holds no site. Counting on from it across the largest
// grid still fits 16 bits.
constexpr uint16_t kNoSite = kMaxSide;
// Of a row without a site: more than twice the square of any distance within a
// row, and within 31 bits.
constexpr int kNoSiteSquared = 46340 * 46340;

using Distances = Eigen::Array<uint16_t, Eigen::Dynamic, Eigen::Dynamic>;

// Returns the distance along each row to the nearest true cell, at least
// kNoSite where there is none. Passes over whole columns, as they are
// contiguous.
Distances RowDistances(const BoolArray& sites) {
  const Index rows = sites.rows(), cols = sites.cols();
  Distances distances(rows, cols);
  for (Index i = 0; i < rows; ++i) {
    distances(i, 0) = sites(i, 0) ? 0 : kNoSite;
  }
  for (Index j = 1; j < cols; ++j) {
    const bool* const site = &sites(0, j);
    const uint16_t* const before = &distances(0, j - 1);
    uint16_t* const distance = &distances(0, j);
    for (Index i = 0; i < rows; ++i) {
      // The mask has all bits, or none at a site; compilers do not make vector
      // code of a condition here.
      const int mask = static_cast<int>(site[i]) - 1;
      distance[i] = static_cast<uint16_t>((before[i] + 1) & mask);
    }
  }
  for (Index j = cols - 2; j >= 0; --j) {
    const uint16_t* const after = &distances(0, j + 1);
    uint16_t* const distance = &distances(0, j);
    for (Index i = 0; i < rows; ++i) {
      distance[i] = std::min(distance[i], static_cast<uint16_t>(after[i] + 1));
    }
  }
  return distances;
}

// The least (x - k)^2 + g[k]^2 for each x in one column g: the lower envelope
// of one parabola per row k. As they all have the shape of x^2, that of row k
// is a side of the envelope where (k, k^2 + g[k]^2) is a corner of the lower
// convex hull of all such points, found without any division.
class LowerEnvelope {
 public:
  explicit LowerEnvelope(const Index size)
      : size_(static_cast<int>(size)),
        squares_(size_ + 2 * kReach, kNoSiteSquared),
        may_count_(size_),
        hull_(size_ + 1),
        owners_(size_) {}

  // Writes the envelope of the column g, which has a site in some row. All
  // values but those of rows without a site must be less than kNoSite.
  void Evaluate(const uint16_t* const g, int* const values) {
    Square(g);
    FindHull();
    FindOwners();
    const int* const squares = squares_.data() + kReach;
    int owner = 0;
    for (int x = 0; x < size_; ++x) {
      owner = std::max(owner, owners_[x]);
      values[x] = (x - owner) * (x - owner) + squares[owner];
    }
  }

 private:
  // Leaves out, besides rows without a site, those above the middle of both
  // neighbours, or of both rows kReach away: they are no corners. What is left
  // takes most of the time.
  void Square(const uint16_t* const g) {
    int* const squares = squares_.data() + kReach;
    for (int k = 0; k < size_; ++k) {
      const int distance = g[k];
      squares[k] = distance >= kNoSite ? kNoSiteSquared : distance * distance;
    }
    for (int k = 0; k < size_; ++k) {
      const int at = squares[k];
      const bool is_corner = IsBelow(at, squares[k - 1], squares[k + 1], 1);
      const bool stands_out =
          IsBelow(at, squares[k - kReach], squares[k + kReach], kReach);
      // Without branches, so that compilers compute several at once.
      may_count_[k] = (at != kNoSiteSquared) & is_corner & stands_out;
    }
  }

  // Whether a point lies below the middle of those `step` rows before and
  // behind. Compares differences, as sums would not fit 32 bits.
  static bool IsBelow(const int at, const int before, const int behind,
                      const int step) {
    return at - before - step * step < behind - at + step * step;
  }

  int Height(const int k) const { return k * k + squares_[k + kReach]; }

  // Andrew's monotone chain ([Andrew1979]).
  void FindHull() {
    int num_candidates = 0;
    for (int k = 0; k < size_; ++k) {
      hull_[num_candidates] = k;
      num_candidates += may_count_[k];
    }
    num_corners_ = 0;
    for (int n = 0; n < num_candidates; ++n) {
      const int k = hull_[n];
      while (num_corners_ >= 2 &&
             IsAbove(hull_[num_corners_ - 2], hull_[num_corners_ - 1], k)) {
        --num_corners_;
      }
      hull_[num_corners_++] = k;
    }
  }

  // Whether the point of `middle` does not lie below the line between the
  // others.
  bool IsAbove(const int left, const int middle, const int right) const {
    const int64_t height = Height(middle);
    return (height - Height(left)) * (right - middle) >=
           (Height(right) - height) * (middle - left);
  }

  // Notes each corner where its parabola begins to be the lowest.
  void FindOwners() {
    std::fill(owners_.begin(), owners_.end(), 0);
    owners_[0] = hull_[0];
    for (int n = 1; n < num_corners_; ++n) {
      const int left = hull_[n - 1], right = hull_[n];
      const int rise = Height(right) - Height(left);
      const int begin = rise < 0 ? 0 : rise / (2 * (right - left)) + 1;
      if (begin >= size_) break;
      owners_[begin] = right;
    }
  }

  static constexpr int kReach = 4;

  const int size_;
  // Of g, with kReach rows more on either side.
  std::vector<int> squares_;
  std::vector<uint8_t> may_count_;
  // Rows, in ascending order.
  std::vector<int> hull_;
  int num_corners_ = 0;
  // At the first cell of each corner's side its row, elsewhere 0.
  std::vector<int> owners_;
};

}  // namespace

void VisitSquaredDistances(const BoolArray& sites,
                           const SquaredDistancesVisitor& visit) {
  CHECK_LE(sites.rows(), kMaxSide);
  CHECK_LE(sites.cols(), kMaxSide);
  CHECK(sites.any()) << "the distance to nothing is undefined";
  const Distances distances = RowDistances(sites);
  LowerEnvelope envelope(sites.rows());
  std::vector<int> squared(sites.rows());
  for (Index j = 0; j < sites.cols(); ++j) {
    envelope.Evaluate(&distances(0, j), squared.data());
    visit(j, squared.data());
  }
}

Eigen::ArrayXXi SquaredDistanceTransform(const BoolArray& sites) {
  Eigen::ArrayXXi result(sites.rows(), sites.cols());
  VisitSquaredDistances(sites, [&](const Index j, const int* const squared) {
    std::copy_n(squared, sites.rows(), &result(0, j));
  });
  return result;
}

}  // namespace cartographer_sdf
