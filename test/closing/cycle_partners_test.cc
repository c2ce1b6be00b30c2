// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/cycle_partners.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::cycle_partners_test {
namespace {

// Trajectories that go round a circle of 50 m, again and again.
std::map<SubmapId, OdometryPose> Circles(const int num_trajectories,
                                         const int num_submaps,
                                         const double spacing) {
  const double radius = 50. / (2. * M_PI);
  std::map<SubmapId, OdometryPose> odometry;
  for (int trajectory = 0; trajectory < num_trajectories; ++trajectory) {
    for (int i = 0; i < num_submaps; ++i) {
      const double angle = spacing * i / radius;
      odometry[{trajectory, i}] = {
          Rigid2(radius * std::cos(angle), radius * std::sin(angle), angle),
          spacing * i};
    }
  }
  return odometry;
}

// Random pairs of submaps in random direction. Two thirds are true but for the
// noise, a third are false.
class Draws {
 public:
  int Index(const int size) {
    return static_cast<int>(
        (static_cast<uint64_t>(generator_()) * static_cast<uint64_t>(size)) >>
        32);
  }
  double Real(const double limit) {
    return limit * (2. * Index(1 << 20) / (1 << 20) - 1.);
  }

 private:
  std::mt19937 generator_{42};
};

std::vector<PairPose> RandomClosures(
    const std::map<SubmapId, OdometryPose>& odometry, const int count) {
  const std::vector<std::pair<SubmapId, OdometryPose>> submaps(odometry.begin(),
                                                               odometry.end());
  Draws draws;
  std::vector<PairPose> closures;
  for (int k = 0; k < count; ++k) {
    const auto& [reference, at] =
        submaps[draws.Index(static_cast<int>(submaps.size()))];
    const auto& [query, to] =
        submaps[draws.Index(static_cast<int>(submaps.size()))];
    const Rigid2 error =
        k % 3 == 0 ? Rigid2(draws.Real(8.), draws.Real(8.), draws.Real(1.))
                   : Rigid2(draws.Real(0.2), draws.Real(0.2), draws.Real(0.02));
    closures.push_back({reference, query,
                        at.T_local_submap.Inverse() * to.T_local_submap * error,
                        4. + draws.Real(6.)});
  }
  return closures;
}

TEST(DrivenReachTest, OneMoreMetreTellsNothing) {
  const ConsistencyOptions options;
  const double reach = DrivenReach(options);
  // 1 = 2 * 0.15^2 + (0.01 d)^2 + (0.01 d)^2 d / 3.
  EXPECT_NEAR(reach, 29.64, 0.01);
  const double sigma = std::hypot(options.closure_translation_sigma_meters,
                                  options.closure_translation_sigma_meters);
  EXPECT_NEAR(std::hypot(sigma, DriftSigma(options, reach)),
              options.max_cycle_sigma_meters, 1e-5);
}

TEST(DrivenReachTest, OdometryWithoutErrorReachesEverywhere) {
  ConsistencyOptions options;
  options.rotation_sigma_per_sqrt_meter = 0.;
  options.translation_sigma_per_meter = 0.;
  EXPECT_EQ(DrivenReach(options), std::numeric_limits<double>::infinity());
}

TEST(DrivenReachTest, ZeroWhereClosuresAloneAreTooUncertain) {
  ConsistencyOptions options;
  options.max_cycle_sigma_meters = 0.2;
  EXPECT_EQ(DrivenReach(options), 0.);
  const std::map<SubmapId, OdometryPose> odometry = Circles(1, 40, 5.);
  for (const auto& partners :
       FindCyclePartners(options, odometry, RandomClosures(odometry, 20))) {
    EXPECT_TRUE(partners.empty());
  }
}

TEST(FindCyclePartnersTest, MissesNoInformativeCycle) {
  for (const int num_trajectories : {1, 2, 3}) {
    const ConsistencyOptions options;
    const std::map<SubmapId, OdometryPose> odometry =
        Circles(num_trajectories, 60, 4.);
    const std::vector<PairPose> closures = RandomClosures(odometry, 300);
    const auto partners = FindCyclePartners(options, odometry, closures);
    int num_informative = 0, num_pairs = 0;
    for (size_t a = 0; a < closures.size(); ++a) {
      num_pairs += static_cast<int>(partners[a].size());
      for (size_t b = 0; b < closures.size(); ++b) {
        if (a == b || CheckCycle(options, odometry, closures[a], closures[b]) ==
                          CycleVerdict::kUninformative) {
          continue;
        }
        ++num_informative;
        EXPECT_TRUE(
            std::binary_search(partners[a].begin(), partners[a].end(), b))
            << a << " " << b;
      }
    }
    EXPECT_GT(num_informative, 500);
    EXPECT_LT(num_pairs, 0.8 * 300 * 299);
  }
}

// As the closures were selected when all pairs were looked at.
std::vector<SelectionResult> SelectByAllPairs(
    const ConsistencyOptions& options,
    const std::map<SubmapId, OdometryPose>& odometry,
    const std::vector<PairPose>& closures) {
  const VerdictTable table(closures, [&](const PairPose& a, const PairPose& b) {
    return CheckCycle(options, odometry, a, b);
  });
  std::vector<size_t> chosen;
  std::vector<SelectionResult> results(closures.size());
  for (const size_t k : table.InOrderOfWeight()) {
    results[k] = table.Weigh(k, chosen);
    if (results[k].contradiction > results[k].support) {
      results[k].selection = Selection::kInconsistent;
    } else {
      chosen.push_back(k);
    }
  }
  for (const size_t k : chosen) {
    results[k] = table.Weigh(k, chosen);
    if (results[k].support < options.min_support &&
        closures[k].score < options.min_unsupported_score) {
      results[k].selection = Selection::kUnsupported;
    }
  }
  return results;
}

TEST(FindCyclePartnersTest, SelectsAsAllPairsDoToTheLastBit) {
  for (const int num_trajectories : {1, 3}) {
    const ConsistencyOptions options;
    const std::map<SubmapId, OdometryPose> odometry =
        Circles(num_trajectories, 60, 4.);
    const std::vector<PairPose> closures = RandomClosures(odometry, 500);
    const std::vector<SelectionResult> expected =
        SelectByAllPairs(options, odometry, closures);
    const std::vector<SelectionResult> results =
        SelectConsistent(options, odometry, closures);
    int counts[3] = {0, 0, 0};
    for (size_t k = 0; k < closures.size(); ++k) {
      ++counts[static_cast<int>(results[k].selection)];
      EXPECT_EQ(results[k].selection, expected[k].selection) << k;
      EXPECT_EQ(results[k].support, expected[k].support) << k;
      EXPECT_EQ(results[k].contradiction, expected[k].contradiction) << k;
    }
    EXPECT_GT(*std::min_element(counts, counts + 2), 100);
  }
}

// A robot that stays in a room: 600 closures, all within reach of each other.
TEST(FindCyclePartnersTest, ACrowdedPlaceIsBoundedAndSelectsTheSame) {
  const ConsistencyOptions options;
  const std::map<SubmapId, OdometryPose> odometry = Circles(2, 60, 0.1);
  const std::vector<PairPose> closures = RandomClosures(odometry, 900);
  size_t num_pairs = 0;
  for (const std::vector<size_t>& partners :
       FindCyclePartners(options, odometry, closures)) {
    num_pairs += partners.size();
  }
  // Three pairs of trajectories, of which each has the weightiest on one cell.
  EXPECT_LE(num_pairs, 2 * kMaxNumClosuresPerCell * closures.size());
  const std::vector<SelectionResult> expected =
      SelectByAllPairs(options, odometry, closures);
  const std::vector<SelectionResult> results =
      SelectConsistent(options, odometry, closures);
  int num_different = 0;
  for (size_t k = 0; k < closures.size(); ++k) {
    num_different += results[k].selection != expected[k].selection;
  }
  EXPECT_EQ(num_different, 0);
}

}  // namespace
}  // namespace cartographer_sdf::cycle_partners_test
