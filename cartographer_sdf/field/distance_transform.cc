// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/field/distance_transform.h"

#include <algorithm>
#include <vector>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr int kMaxSide = 32767;
// Distance along one axis where a line holds no site: farther than any real
// one. All squared distances fit 32 bits.
constexpr int kNoSite = kMaxSide + 1;

// Returns the distance along each row to the nearest true cell; processes whole
// columns at a time, as they are contiguous.
Eigen::ArrayXXi RowDistances(const BoolArray& sites) {
  const Eigen::Index rows = sites.rows(), cols = sites.cols();
  Eigen::ArrayXXi distances(rows, cols);
  for (Eigen::Index i = 0; i < rows; ++i) {
    distances(i, 0) = sites(i, 0) ? 0 : kNoSite;
  }
  for (Eigen::Index j = 1; j < cols; ++j) {
    const bool* const site = &sites(0, j);
    const int* const before = &distances(0, j - 1);
    int* const distance = &distances(0, j);
    for (Eigen::Index i = 0; i < rows; ++i) {
      distance[i] = site[i] ? 0 : std::min(before[i] + 1, kNoSite);
    }
  }
  for (Eigen::Index j = cols - 2; j >= 0; --j) {
    distances.col(j) = distances.col(j).min(distances.col(j + 1) + 1);
  }
  return distances;
}

// Lower envelope of the parabolas (x - k)^2 + g[k]^2 for one line g.
class LowerEnvelope {
 public:
  explicit LowerEnvelope(const int size)
      : g_(size), vertex_(size), begin_(size) {}

  // Replaces g, the line, by the envelope's value at each of its cells. No
  // parabola reaches across a site, so each stretch between two sites is
  // evaluated separately.
  void Evaluate(int* const line) {
    const int n = static_cast<int>(g_.size());
    std::copy(line, line + n, g_.begin());
    for (int first = 0; first < n;) {
      int last = first + 1;
      while (last < n && g_[last] != 0) ++last;
      if (last == first + 1 && g_[first] == 0) {
        line[first] = 0;
      } else {
        EvaluateStretch(first, std::min(last + 1, n), line);
      }
      first = last;
    }
  }

 private:
  void EvaluateStretch(const int first, const int end, int* const values) {
    int top = -1;
    for (int k = first; k < end; ++k) {
      if (g_[k] >= kNoSite) continue;
      while (top >= 0 &&
             Value(vertex_[top], begin_[top]) > Value(k, begin_[top])) {
        --top;
      }
      const int begin = top < 0 ? first : FirstBelow(vertex_[top], k);
      if (begin < end) {
        vertex_[++top] = k;
        begin_[top] = begin;
      }
    }
    for (int x_end = end; top >= 0; --top) {
      const int k = vertex_[top], across = g_[k] * g_[k];
      for (int x = begin_[top]; x < x_end; ++x) {
        values[x] = (x - k) * (x - k) + across;
      }
      x_end = begin_[top];
    }
  }

  int Value(const int k, const int x) const {
    return (x - k) * (x - k) + g_[k] * g_[k];
  }

  // The first cell where the parabola of `right` lies below that of `left`.
  int FirstBelow(const int left, const int right) const {
    const int numerator = right * right - left * left + g_[right] * g_[right] -
                          g_[left] * g_[left];
    // Not negative: the caller removed all parabolas that lie above that of
    // `right` where they begin.
    return numerator / (2 * (right - left)) + 1;
  }

  std::vector<int> g_;
  std::vector<int> vertex_;
  std::vector<int> begin_;
};

}  // namespace

Eigen::ArrayXXi SquaredDistanceTransform(const BoolArray& sites) {
  CHECK_LE(sites.rows(), kMaxSide);
  CHECK_LE(sites.cols(), kMaxSide);
  CHECK(sites.any()) << "the distance to nothing is undefined";
  Eigen::ArrayXXi squared = RowDistances(sites);
  LowerEnvelope envelope(static_cast<int>(sites.rows()));
  for (Eigen::Index j = 0; j < sites.cols(); ++j) {
    envelope.Evaluate(&squared(0, j));
  }
  return squared;
}

}  // namespace cartographer_sdf
