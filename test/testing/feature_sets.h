// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Features without a grid, for matching.

#ifndef TEST_TESTING_FEATURE_SETS_H_
#define TEST_TESTING_FEATURE_SETS_H_

#include <random>
#include <vector>

#include "cartographer_sdf/matching/correspondence.h"
#include "test/testing/random_number.h"

namespace cartographer_sdf::testing {

// Keypoints anywhere in a square of that side around the origin, with random
// kinds, clearances of 0 to 2 m, orientations and descriptors of that length.
inline FeatureSet RandomFeatures(const int count, const double side,
                                 const int descriptor_length,
                                 std::mt19937* const engine) {
  FeatureSet set;
  set.descriptors.resize(descriptor_length, count);
  for (int k = 0; k < count; ++k) {
    const double x = Uniform(-0.5 * side, 0.5 * side, engine);
    const double y = Uniform(-0.5 * side, 0.5 * side, engine);
    const double clearance = Uniform(0., 2., engine);
    const auto kind = static_cast<KeypointKind>(UniformInt(3, engine));
    set.features.push_back(
        {{{x, y}, clearance, kind, 1.}, Uniform(-M_PI, M_PI, engine)});
    for (int d = 0; d < descriptor_length; ++d) {
      set.descriptors(d, k) = static_cast<float>(Uniform(0., 1., engine));
    }
  }
  return set;
}

// The same features in another frame.
inline FeatureSet Moved(const Rigid2& T_new_old, FeatureSet set) {
  for (Feature& feature : set.features) {
    feature.keypoint.position = T_new_old * feature.keypoint.position;
    feature.orientation =
        NormalizeAngle(feature.orientation + T_new_old.rotation());
  }
  return set;
}

// Each with the one of the same number.
inline std::vector<Correspondence> Identity(const int count) {
  std::vector<Correspondence> correspondences;
  for (int k = 0; k < count; ++k) correspondences.push_back({k, k, 0.1f});
  return correspondences;
}

// Random ones that are wrong in sets that correspond by number, with descriptor
// distances in [0.1, 0.2).
inline void AddOutliers(const int count, const int num_features,
                        std::mt19937* const engine,
                        std::vector<Correspondence>* const correspondences) {
  for (int k = 0; k < count; ++k) {
    const int reference = UniformInt(num_features, engine);
    const int offset = 1 + UniformInt(num_features - 1, engine);
    correspondences->push_back({reference, (reference + offset) % num_features,
                                static_cast<float>(Uniform(0.1, 0.2, engine))});
  }
}

struct MatchingProblem {
  FeatureSet reference, query;
  std::vector<Correspondence> correspondences;
};

// Correspondence k < num_inliers is true, all others are false. `noise` [m] of
// positions, and as many radians of orientations.
inline MatchingProblem MakeMatchingProblem(const Rigid2& T_reference_query,
                                           const int num_inliers,
                                           const int num_outliers,
                                           const double noise = 0.) {
  std::mt19937 engine(42);
  MatchingProblem problem;
  problem.query = RandomFeatures(num_inliers, 20., 1, &engine);
  problem.reference = Moved(T_reference_query, problem.query);
  for (Feature& feature : problem.reference.features) {
    feature.keypoint.position.x() += Uniform(-noise, noise, &engine);
    feature.keypoint.position.y() += Uniform(-noise, noise, &engine);
    feature.orientation =
        NormalizeAngle(feature.orientation + Uniform(-noise, noise, &engine));
  }
  problem.correspondences = Identity(num_inliers);
  AddOutliers(num_outliers, num_inliers, &engine, &problem.correspondences);
  return problem;
}

template <typename T>
void Shuffle(std::vector<T>* const items, std::mt19937* const engine) {
  for (int k = static_cast<int>(items->size()); k > 1; --k) {
    std::swap((*items)[k - 1], (*items)[UniformInt(k, engine)]);
  }
}

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_FEATURE_SETS_H_
