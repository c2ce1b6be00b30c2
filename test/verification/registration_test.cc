// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/registration.h"

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "cartographer_sdf/verification/evidence.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"

namespace cartographer_sdf::registration_test {
namespace {

using testing::IsPoseNear;

constexpr double kDegree = M_PI / 180.;

// The west room, seen from different viewpoints.
struct TwoViews {
  Rigid2 T_world_reference{3., 2., 0.4};
  Rigid2 T_world_query{4., 3., -1.};
  SurfaceModel reference = testing::SurfaceSeenFrom(
      testing::TwoRooms(), T_world_reference, testing::WestRoomViewpoints());
  SurfaceModel query =
      testing::SurfaceSeenFrom(testing::TwoRooms(), T_world_query,
                               {{2.2, 2.4}, {4.4, 3.2}, {6.3, 4.2}, {2., 1.}});
  Rigid2 truth = T_world_reference.Inverse() * T_world_query;
};

TEST(RegisterSubmapsTest, RecoversThePose) {
  const TwoViews views;
  for (int direction = 0; direction < 8; ++direction) {
    for (const double turn : {-5. * kDegree, 0., 5. * kDegree}) {
      const double angle = direction * M_PI / 4.;
      const Rigid2 guess(
          views.truth.translation() +
              0.4 * Eigen::Vector2d(std::cos(angle), std::sin(angle)),
          views.truth.rotation() + turn);
      const std::optional<Rigid2> registration = RegisterSubmaps(
          RegistrationOptions(), views.reference, views.query, guess);
      ASSERT_TRUE(registration.has_value());
      EXPECT_THAT(*registration, IsPoseNear(views.truth, 0.02, 0.3 * kDegree))
          << direction << " " << turn;
    }
  }
}

TEST(RegisterSubmapsTest, SwappingTheSubmapsInvertsThePose) {
  const TwoViews views;
  const Rigid2 guess = views.truth * Rigid2(0.2, -0.1, 0.05);
  RegistrationOptions options;
  options.num_iterations = 40;
  const std::optional<Rigid2> there =
      RegisterSubmaps(options, views.reference, views.query, guess);
  const std::optional<Rigid2> back =
      RegisterSubmaps(options, views.query, views.reference, guess.Inverse());
  ASSERT_TRUE(there.has_value() && back.has_value());
  EXPECT_THAT(back->Inverse(), IsPoseNear(*there, 1e-3, 2e-4));
}

// One way of the cost of the last iteration, written down once more: the
// distances of points to the middle of the walls, under a function of them.
struct WeightedDistance {
  double weight;
  double distance;
};
std::vector<std::optional<WeightedDistance>> Distances(
    const SurfaceModel& field, const std::vector<SurfacePoint>& points,
    const Rigid2& T_field_points) {
  std::vector<std::optional<WeightedDistance>> distances;
  for (size_t k = 0; k < points.size() && k < 300; ++k) {
    const std::optional<FieldSample> sample = SampleSurface(
        field.geometry, *field.cells.Pin(),
        field.geometry.GridToCells(field.geometry.T_submap_grid.Inverse() *
                                   (T_field_points * points[k].position)));
    distances.emplace_back();
    if (sample) {
      distances.back() = {points[k].weight, sample->distance + 0.025};
    }
  }
  return distances;
}
std::vector<std::optional<WeightedDistance>> BothWays(const TwoViews& views,
                                                      const Rigid2& pose) {
  std::vector<std::optional<WeightedDistance>> distances =
      Distances(views.reference, views.query.walls, pose);
  for (const auto& distance :
       Distances(views.query, views.reference.walls, pose.Inverse())) {
    distances.push_back(distance);
  }
  return distances;
}
// Geman-McClure.
double Cost(const TwoViews& views, const Rigid2& pose) {
  double cost = 0.;
  for (const auto& d : BothWays(views, pose)) {
    if (!d) continue;
    const double squared = d->distance * d->distance;
    cost += d->weight * squared / (1. + squared / (0.15 * 0.15));
  }
  return cost;
}
Rigid2 Perturb(const Rigid2& pose, const int parameter, const double step) {
  Eigen::Vector3d steps = Eigen::Vector3d::Zero();
  steps[parameter] = step;
  return Rigid2(pose.translation() + steps.head<2>(),
                pose.rotation() + steps.z());
}

TEST(RegisterSubmapsTest, EndsInAMinimumOfTheCost) {
  const TwoViews views;
  RegistrationOptions options;
  options.num_iterations = 60;
  const std::optional<Rigid2> registration =
      RegisterSubmaps(options, views.reference, views.query, views.truth);
  ASSERT_TRUE(registration.has_value());
  const Rigid2& pose = *registration;
  const double cost = Cost(views, pose);
  for (int parameter = 0; parameter < 3; ++parameter) {
    // The interpolated field has kinks at the centres of cells, so that there
    // may be shallow minima beside each other.
    for (const double step : {-4e-3, 4e-3}) {
      EXPECT_GT(Cost(views, Perturb(pose, parameter, step)), cost)
          << parameter << " " << step;
    }
  }
}

TEST(RegisterSubmapsTest, NormalScatterIsThatOfFiniteDifferences) {
  const TwoViews views;
  const std::optional<Rigid2> registration = RegisterSubmaps(
      RegistrationOptions(), views.reference, views.query, views.truth);
  ASSERT_TRUE(registration.has_value());
  const Rigid2& pose = *registration;
  constexpr double kStep = 1e-7;
  const auto at = BothWays(views, pose);
  Eigen::MatrixX2d jacobian(at.size(), 2);
  for (int parameter = 0; parameter < 2; ++parameter) {
    const auto lower = BothWays(views, Perturb(pose, parameter, -kStep));
    const auto upper = BothWays(views, Perturb(pose, parameter, kStep));
    for (size_t k = 0; k < at.size(); ++k) {
      jacobian(k, parameter) =
          at[k] ? (upper[k]->distance - lower[k]->distance) / (2. * kStep) : 0.;
    }
  }
  Eigen::Matrix2d expected = Eigen::Matrix2d::Zero();
  double sum_of_weights = 0.;
  for (size_t k = 0; k < at.size(); ++k) {
    if (!at[k]) continue;
    const double ratio = 1. + at[k]->distance * at[k]->distance / (0.15 * 0.15);
    const double weight = at[k]->weight / (ratio * ratio);
    sum_of_weights += weight;
    expected += weight * jacobian.row(k).transpose() * jacobian.row(k);
  }
  expected /= sum_of_weights;
  const Eigen::Matrix2d scatter =
      NormalScatter(RegistrationOptions(), views.reference, views.query, pose);
  EXPECT_LT((scatter - expected).norm(), 1e-4 * expected.norm())
      << scatter << "\n\n"
      << expected;
}

// Two views of a building around the origin, turned as given.
double MinScatterEigenvalue(const testing::Building& building,
                            const double reference_yaw,
                            const double query_yaw) {
  const SurfaceModel reference = testing::SurfaceSeenFrom(
      building, Rigid2(0., 0., reference_yaw), {{1., 0.3}});
  const SurfaceModel query = testing::SurfaceSeenFrom(
      building, Rigid2(0., 0., query_yaw), {{-1., 0.5}});
  const std::optional<Rigid2> registration =
      RegisterSubmaps(RegistrationOptions(), reference, query,
                      Rigid2(0., 0., query_yaw - reference_yaw));
  CHECK(registration.has_value());
  return MeasurePair(AgreementOptions(), RegistrationOptions(), reference,
                     query, *registration)
      .MinScatterEigenvalue();
}

TEST(RegisterSubmapsTest, TellsRoomsFromCorridors) {
  const testing::Building room = testing::BareRoom(6., 6.);
  // Its ends are out of sight.
  const testing::Building corridor = testing::BareRoom(40., 2.);
  EXPECT_NEAR(MinScatterEigenvalue(room, 0., 0.), 0.5, 0.01);
  EXPECT_NEAR(MinScatterEigenvalue(corridor, 0., 0.), 0., 0.01);
  // The steps of a slanting wall's cells face all ways.
  EXPECT_GT(MinScatterEigenvalue(room, 0.3, -0.2), 0.4);
  EXPECT_LT(MinScatterEigenvalue(corridor, 0.3, -0.2), 0.15);
}

TEST(RegisterSubmapsTest, NoneWhereNothingIsSeenByBoth) {
  const TwoViews views;
  EXPECT_FALSE(RegisterSubmaps(RegistrationOptions(), views.reference,
                               views.query, Rigid2(100., 0., 0.))
                   .has_value());
}

constexpr PosePrior kPrior{0.1, 0.02};

TEST(RegisterPointsTest, FindsTheScanInTheSubmap) {
  const TwoViews views;
  const Rigid2 T_world_node(3.4, 2.7, 1.2);
  const Rigid2 truth = views.T_world_reference.Inverse() * T_world_node;
  const std::vector<SurfacePoint> scan =
      testing::TakeScan(testing::TwoRooms(), T_world_node);
  for (const Rigid2& error :
       {Rigid2(0.1, 0.05, 0.02), Rigid2(-0.1, 0.1, -0.03)}) {
    const std::optional<Rigid2> registration = RegisterPoints(
        RegistrationOptions(), views.reference, scan, truth * error, kPrior);
    ASSERT_TRUE(registration.has_value());
    EXPECT_THAT(*registration, IsPoseNear(truth, 0.02, 0.3 * kDegree));
  }
}

TEST(RegisterPointsTest, StaysWhereACorridorLeavesItFree) {
  const testing::Building corridor = testing::BareRoom(40., 2.);
  const Rigid2 T_world_reference(0.2, 0.1, 0.);
  const SurfaceModel reference =
      testing::SurfaceSeenFrom(corridor, T_world_reference, {{0., 0.3}});
  const Rigid2 T_world_node(0.5, -0.2, 0.4);
  const Rigid2 truth = T_world_reference.Inverse() * T_world_node;
  // Along and across the corridor.
  const Rigid2 guess = Rigid2(0.25, 0.12, 0.) * truth;
  const std::optional<Rigid2> registration =
      RegisterPoints(RegistrationOptions(), reference,
                     testing::TakeScan(corridor, T_world_node), guess, kPrior);
  ASSERT_TRUE(registration.has_value());
  const Rigid2& pose = *registration;
  EXPECT_NEAR(pose.translation().x(), guess.translation().x(), 0.01);
  EXPECT_NEAR(pose.translation().y(), truth.translation().y(), 0.005);
  EXPECT_NEAR(pose.rotation(), truth.rotation(), 0.05 * kDegree);
}

TEST(RegisterPointsTest, NoneForFewPoints) {
  const TwoViews views;
  EXPECT_FALSE(RegisterPoints(RegistrationOptions(), views.reference, {},
                              Rigid2(), kPrior)
                   .has_value());
  EXPECT_FALSE(RegisterPoints(RegistrationOptions(), views.reference,
                              {{{100., 0.}, 1.}}, Rigid2(), kPrior)
                   .has_value());
}

TEST(RegistrationOptionsTest, AreValidated) {
  EXPECT_EQ(Validate(RegistrationOptions()), "");
  const auto error = [](const std::function<void(RegistrationOptions*)>& set) {
    RegistrationOptions options;
    set(&options);
    return Validate(options);
  };
  EXPECT_NE(error([](auto* o) { o->num_iterations = 0; }), "");
  EXPECT_NE(error([](auto* o) { o->final_kernel_scale_meters = 0.5; }), "");
  EXPECT_NE(error([](auto* o) { o->final_kernel_scale_meters = NAN; }), "");
  EXPECT_NE(error([](auto* o) { o->max_num_points = 1; }), "");
}

}  // namespace
}  // namespace cartographer_sdf::registration_test
