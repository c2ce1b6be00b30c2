// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Features of as many submaps as one likes, made of those of a few: each has
// half of the keypoints of two of them, each half in other dimensions and
// somewhat displaced, so that they stand for submaps of many buildings, no two
// alike. Without descriptors, as the index does not look at them.

#ifndef TEST_BENCHMARK_RECOMBINED_SUBMAPS_H_
#define TEST_BENCHMARK_RECOMBINED_SUBMAPS_H_

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "cartographer_sdf/feature/descriptor.h"
#include "test/testing/feature_sets.h"

namespace cartographer_sdf::benchmarks {

class RecombinedSubmaps {
 public:
  // Without any features to combine, submaps are random: keypoints without
  // structure, few votes for a pose.
  explicit RecombinedSubmaps(std::vector<std::vector<Feature>> real)
      : real_(std::move(real)) {}

  [[nodiscard]] FeatureSet Make(const int number) const {
    std::mt19937 engine(static_cast<uint32_t>(number));
    if (real_.empty()) return testing::RandomFeatures(200, 20., 1, &engine);
    FeatureSet set;
    for (int half = 0; half < 2; ++half) AddHalf(&engine, &set);
    return set;
  }

  // The submap of that number as it is seen another time: turned, somewhat
  // different, and one of four keypoints missing.
  [[nodiscard]] FeatureSet SeeAgain(const int number) const {
    std::mt19937 engine(static_cast<uint32_t>(number) + 1000000000u);
    FeatureSet seen;
    for (Feature feature : Make(number).features) {
      if (testing::UniformInt(4, &engine) == 0) continue;
      Displace(kNoiseOfView, &engine, &feature);
      seen.features.push_back(feature);
    }
    return testing::Moved(
        Rigid2({3., -2.}, testing::Uniform(-M_PI, M_PI, &engine)),
        std::move(seen));
  }

 private:
  // How far keypoints are displaced at most, and their clearances [m], [rad].
  struct Noise {
    double position;
    double clearance;
    double orientation;
  };
  static constexpr Noise kNoiseOfBuilding{0.2, 0.1, 0.2};
  static constexpr Noise kNoiseOfView{0.05, 0.05, 0.1};

  static void Displace(const Noise& noise, std::mt19937* const engine,
                       Feature* const feature) {
    const auto displaced = [engine](const double value, const double most) {
      return value + testing::Uniform(-most, most, engine);
    };
    Keypoint& keypoint = feature->keypoint;
    keypoint.position.x() = displaced(keypoint.position.x(), noise.position);
    keypoint.position.y() = displaced(keypoint.position.y(), noise.position);
    keypoint.clearance = displaced(keypoint.clearance, noise.clearance);
    feature->orientation =
        NormalizeAngle(displaced(feature->orientation, noise.orientation));
  }

  // Adds half of the features of a real submap, in other dimensions, turned and
  // shifted.
  void AddHalf(std::mt19937* const engine, FeatureSet* const set) const {
    const std::vector<Feature>& features =
        real_[testing::UniformInt(static_cast<int>(real_.size()), engine)];
    const double scale = testing::Uniform(0.8, 1.25, engine);
    const Rigid2 T_new_old(
        {testing::Uniform(-5., 5., engine), testing::Uniform(-5., 5., engine)},
        testing::Uniform(-M_PI, M_PI, engine));
    for (Feature feature : features) {
      if (testing::UniformInt(2, engine) == 0) continue;
      feature.keypoint.position =
          T_new_old * Eigen::Vector2d(scale * feature.keypoint.position);
      feature.keypoint.clearance *= scale;
      feature.orientation += T_new_old.rotation();
      Displace(kNoiseOfBuilding, engine, &feature);
      set->features.push_back(feature);
    }
  }

  const std::vector<std::vector<Feature>> real_;
};

}  // namespace cartographer_sdf::benchmarks

#endif  // TEST_BENCHMARK_RECOMBINED_SUBMAPS_H_
