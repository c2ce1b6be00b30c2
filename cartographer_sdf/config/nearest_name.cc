// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/config/nearest_name.h"

#include <algorithm>
#include <numeric>

namespace cartographer_sdf {
namespace {

// Longer names are garbage, and computing the distance takes quadratic time.
constexpr size_t kMaxLength = 100;

size_t LevenshteinDistance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i + 1;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::optional<std::string> NearestName(
    const std::string& name, const std::vector<std::string>& candidates) {
  if (name.size() > kMaxLength) return std::nullopt;
  std::optional<std::string> nearest;
  size_t least = (name.size() + 2) / 3 + 1;
  for (const std::string& candidate : candidates) {
    const size_t distance = LevenshteinDistance(name, candidate);
    if (distance < least) {
      least = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace cartographer_sdf
