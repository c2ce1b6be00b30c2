// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/matching/correspondence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Of the kinds in use. Where they may mix, all count as of the first kind.
std::array<std::vector<int>, kNumKeypointKinds> IndicesByKind(
    const CorrespondenceOptions& options, const FeatureSet& set) {
  std::array<std::vector<int>, kNumKeypointKinds> indices;
  for (size_t k = 0; k < set.features.size(); ++k) {
    const KeypointKind kind = set.features[k].keypoint.kind;
    if (!Contains(options.kinds, kind)) continue;
    indices[options.same_kind_only ? static_cast<int>(kind) : 0].push_back(
        static_cast<int>(k));
  }
  return indices;
}

Eigen::MatrixXf Select(const Eigen::MatrixXf& descriptors,
                       const std::vector<int>& indices) {
  Eigen::MatrixXf selected(descriptors.rows(),
                           static_cast<Eigen::Index>(indices.size()));
  for (size_t k = 0; k < indices.size(); ++k) {
    selected.col(static_cast<Eigen::Index>(k)) = descriptors.col(indices[k]);
  }
  return selected;
}

// Squared distance and index, so that ties go to the lower index.
using Neighbour = std::pair<float, int>;

// The ratio test compares places, not directions: the rival must be another
// keypoint.
bool IsAmbiguous(const CorrespondenceOptions& options,
                 const FeatureSet& reference,
                 const std::vector<Neighbour>& neighbours) {
  const auto position =
      [&reference](const Neighbour& neighbour) -> const Eigen::Vector2d& {
    return reference.features[neighbour.second].keypoint.position;
  };
  const auto best = std::min_element(neighbours.begin(), neighbours.end());
  const Neighbour* rival = nullptr;
  for (const Neighbour& other : neighbours) {
    if (position(other) != position(*best) &&
        (rival == nullptr || other < *rival)) {
      rival = &other;
    }
  }
  // Without a rival, nothing shows that the feature is distinctive.
  return rival == nullptr ||
         std::sqrt(best->first) > options.max_ratio * std::sqrt(rival->first);
}

// Appends the nearest references of each query feature, among those given by
// index.
void Correspond(const CorrespondenceOptions& options,
                const FeatureSet& reference, const FeatureSet& query,
                const std::vector<int>& rows, const std::vector<int>& columns,
                std::vector<Correspondence>* const correspondences) {
  const Eigen::MatrixXf references = Select(reference.descriptors, rows);
  const Eigen::MatrixXf queries = Select(query.descriptors, columns);
  const Eigen::VectorXf squared_norms = references.colwise().squaredNorm();
  // The dot products r . q of |r - q|^2, all at once.
  const Eigen::MatrixXf products = references.transpose() * queries;
  std::vector<Neighbour> neighbours;
  for (Eigen::Index k = 0; k < products.cols(); ++k) {
    const double clearance = query.features[columns[k]].keypoint.clearance;
    const float squared_norm = queries.col(k).squaredNorm();
    neighbours.clear();
    for (Eigen::Index r = 0; r < products.rows(); ++r) {
      if (std::abs(reference.features[rows[r]].keypoint.clearance - clearance) >
          options.max_clearance_difference_meters) {
        continue;
      }
      neighbours.emplace_back(
          std::max(0.f, squared_norms[r] - 2.f * products(r, k) + squared_norm),
          rows[r]);
    }
    if (options.use_ratio_test && IsAmbiguous(options, reference, neighbours)) {
      continue;
    }
    const size_t proposed = std::min(
        neighbours.size(), static_cast<size_t>(options.num_neighbours));
    std::partial_sort(neighbours.begin(), neighbours.begin() + proposed,
                      neighbours.end());
    for (size_t n = 0; n < proposed; ++n) {
      correspondences->push_back(
          {neighbours[n].second, columns[k], std::sqrt(neighbours[n].first)});
    }
  }
}

}  // namespace

std::string Validate(const CorrespondenceOptions& options) {
  if (options.num_neighbours < 1 || options.num_neighbours > 100) {
    return "num_neighbours must lie between 1 and 100";
  }
  if (!(options.max_ratio > 0. && options.max_ratio <= 1.)) {
    return "max_ratio must lie between 0 and 1";
  }
  if (!(options.max_clearance_difference_meters > 0.)) {
    return "max_clearance_difference_meters must be positive";
  }
  return Validate(options.kinds);
}

std::vector<Correspondence> FindCorrespondences(
    const CorrespondenceOptions& options, const FeatureSet& reference,
    const FeatureSet& query) {
  CHECK_EQ(Validate(options), "");
  std::vector<Correspondence> correspondences;
  if (reference.features.empty() || query.features.empty()) return {};
  CHECK_EQ(reference.descriptors.rows(), query.descriptors.rows());
  const auto reference_indices = IndicesByKind(options, reference);
  const auto query_indices = IndicesByKind(options, query);
  for (int kind = 0; kind < kNumKeypointKinds; ++kind) {
    if (reference_indices[kind].empty() || query_indices[kind].empty()) {
      continue;
    }
    Correspond(options, reference, query, reference_indices[kind],
               query_indices[kind], &correspondences);
  }
  return correspondences;
}

}  // namespace cartographer_sdf
