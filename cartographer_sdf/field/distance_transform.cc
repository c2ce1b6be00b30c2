// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/field/distance_transform.h"

#include <cstdint>
#include <vector>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr int kMaxSide = 32767;
// Distance along one axis where a line holds no site: farther than any real
// one, and its square plus another fits 64 bits.
constexpr int kNoSite = 1 << 20;

// Distance along each column to the nearest true cell.
Eigen::ArrayXXi ColumnDistances(const BoolArray& sites) {
  const Eigen::Index rows = sites.rows();
  Eigen::ArrayXXi distances(rows, sites.cols());
  for (Eigen::Index j = 0; j < sites.cols(); ++j) {
    int distance = kNoSite;
    for (Eigen::Index i = 0; i < rows; ++i) {
      distance = sites(i, j) ? 0 : std::min(distance + 1, kNoSite);
      distances(i, j) = distance;
    }
    for (Eigen::Index i = rows - 1; i >= 0; --i) {
      distance = std::min(distances(i, j), distance + 1);
      distances(i, j) = distance;
    }
  }
  return distances;
}

// Lower envelope of the parabolas (x - k)^2 + g[k]^2 for one line g.
class LowerEnvelope {
 public:
  explicit LowerEnvelope(const int size) : vertex_(size), begin_(size) {}

  // Replaces the line by the envelope's value at each of its cells.
  void Evaluate(const Eigen::Ref<const Eigen::ArrayXi>& g,
                Eigen::Ref<Eigen::ArrayXi> values) {
    const int n = static_cast<int>(g.size());
    int last = -1;
    for (int k = 0; k < n; ++k) {
      if (g[k] >= kNoSite) continue;
      while (last >= 0 && Value(g, vertex_[last], begin_[last]) >
                              Value(g, k, begin_[last])) {
        --last;
      }
      if (last < 0) {
        vertex_[++last] = k;
        begin_[last] = 0;
        continue;
      }
      const int begin = FirstBelow(g, vertex_[last], k);
      if (begin < n) {
        vertex_[++last] = k;
        begin_[last] = begin;
      }
    }
    for (int x = n - 1; x >= 0; --x) {
      while (last > 0 && x < begin_[last]) --last;
      values[x] = static_cast<int>(Value(g, vertex_[last], x));
    }
  }

 private:
  static int64_t Value(const Eigen::Ref<const Eigen::ArrayXi>& g, const int k,
                       const int x) {
    const int64_t along = x - k;
    const int64_t across = g[k];
    return along * along + across * across;
  }

  // The first cell where the parabola of `right` lies below that of `left`.
  static int FirstBelow(const Eigen::Ref<const Eigen::ArrayXi>& g,
                        const int left, const int right) {
    const int64_t gl = g[left], gr = g[right];
    const int64_t numerator = static_cast<int64_t>(right) * right -
                              static_cast<int64_t>(left) * left + gr * gr -
                              gl * gl;
    const int64_t denominator = 2 * static_cast<int64_t>(right - left);
    // Not negative: the caller dropped all that `right` beats at their begin.
    return static_cast<int>(numerator / denominator) + 1;
  }

  std::vector<int> vertex_;
  std::vector<int> begin_;
};

}  // namespace

Eigen::ArrayXXi SquaredDistanceTransform(const BoolArray& sites) {
  CHECK_LE(sites.rows(), kMaxSide);
  CHECK_LE(sites.cols(), kMaxSide);
  CHECK(sites.any()) << "the distance to nothing is undefined";
  // Transposed, so that the second pass runs along memory as well.
  const Eigen::ArrayXXi lines = ColumnDistances(sites).transpose();
  Eigen::ArrayXXi squared(lines.rows(), lines.cols());
  LowerEnvelope envelope(static_cast<int>(lines.rows()));
  for (Eigen::Index i = 0; i < lines.cols(); ++i) {
    envelope.Evaluate(lines.col(i), squared.col(i));
  }
  return squared.transpose();
}

}  // namespace cartographer_sdf
