// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/point_cloud_codec.h"

#include <cmath>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::point_cloud_codec_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

proto::CompressedPointCloud Cloud(const int num_points,
                                  const std::vector<int>& data) {
  proto::CompressedPointCloud cloud;
  cloud.set_num_points(num_points);
  for (const int value : data) cloud.add_point_data(value);
  return cloud;
}

std::string ErrorOf(const int num_points, const std::vector<int>& data) {
  return std::string(
      DecompressPointCloud(Cloud(num_points, data)).status().message());
}

// Values worked out by hand: blocks of 1024 mm, x in the lowest ten bits.
TEST(PointCloudCodecTest, HandMadeCloud) {
  const PointCloud2 points = {
      {0.f, 0.f}, {1.025f, 0.002f}, {-0.001f, -1.025f}, {0.003f, 1.023f}};
  const proto::CompressedPointCloud cloud = CompressPointCloud(points);
  EXPECT_EQ(cloud.num_points(), 4);
  EXPECT_THAT(cloud.point_data(),
              ElementsAre(1, -1, -2, 0, 1023 * 1024 + 1023,  //
                          2, 0, 0, 0, 0, 1023 * 1024 + 3,    //
                          1, 1, 0, 0, 2 * 1024 + 1));
  const absl::StatusOr<PointCloud2> decompressed = DecompressPointCloud(cloud);
  ASSERT_TRUE(decompressed.ok());
  const PointCloud2 sorted = {points[2], points[0], points[3], points[1]};
  ASSERT_EQ(decompressed->size(), sorted.size());
  for (size_t i = 0; i < sorted.size(); ++i) {
    EXPECT_LE(((*decompressed)[i] - sorted[i]).norm(), 1e-6f) << i;
  }
}

TEST(PointCloudCodecTest, PointsOfOneBlockKeepTheirOrderAndDuplicates) {
  const PointCloud2 points = {{0.5f, 0.f}, {0.1f, 0.f}, {0.5f, 0.f}};
  EXPECT_EQ(*DecompressPointCloud(CompressPointCloud(points)), points);
}

TEST(PointCloudCodecTest, RoundsToMillimetres) {
  constexpr float kRounding = 0.0005f;
  // Of a float of tens of metres.
  constexpr float kFloatError = 4e-6f;
  for (int k = 0; k < 1000; ++k) {
    const Eigen::Vector2f point(40.f * std::sin(1.7f * static_cast<float>(k)),
                                40.f * std::cos(2.9f * static_cast<float>(k)));
    const absl::StatusOr<PointCloud2> decompressed =
        DecompressPointCloud(CompressPointCloud({point}));
    ASSERT_TRUE(decompressed.ok());
    ASSERT_EQ(decompressed->size(), 1u);
    EXPECT_LE((decompressed->front() - point).cwiseAbs().maxCoeff(),
              kRounding + kFloatError);
  }
}

TEST(PointCloudCodecTest, FarthestPoints) {
  const PointCloud2 points = {{-kMaxEncodedCoordinate, kMaxEncodedCoordinate}};
  const absl::StatusOr<PointCloud2> decompressed =
      DecompressPointCloud(CompressPointCloud(points));
  ASSERT_TRUE(decompressed.ok());
  // Of a float of kilometres.
  EXPECT_LE(((*decompressed)[0] - points[0]).cwiseAbs().maxCoeff(), 1e-3f);
  EXPECT_DEATH((void)CompressPointCloud({{9000.f, 0.f}}), "");
  EXPECT_DEATH((void)CompressPointCloud({{NAN, 0.f}}), "");
}

TEST(PointCloudCodecTest, EmptyCloud) {
  EXPECT_THAT(CompressPointCloud({}).point_data(), IsEmpty());
  EXPECT_THAT(*DecompressPointCloud(Cloud(0, {})), IsEmpty());
}

TEST(PointCloudCodecTest, DropsHeight) {
  EXPECT_THAT(*DecompressPointCloud(Cloud(1, {1, 0, 0, 3, (7 << 20) + 4})),
              ElementsAre(Eigen::Vector2f(0.004f, 0.f)));
}

TEST(PointCloudCodecTest, RefusesMalformedData) {
  constexpr int kMax = 0x7fffffff;
  EXPECT_THAT(ErrorOf(1, {}), HasSubstr("claims to have 1"));
  EXPECT_THAT(ErrorOf(2, {1, 0, 0, 0, 5}), HasSubstr("claims to have 2"));
  EXPECT_THAT(ErrorOf(-1, {}), HasSubstr("claims to have -1"));
  EXPECT_THAT(ErrorOf(1, {1, 0, 0}), HasSubstr("ends too early"));
  EXPECT_THAT(ErrorOf(1, {1, 0, 0, 0}), HasSubstr("block of 1 points"));
  EXPECT_THAT(ErrorOf(1, {kMax, 0, 0, 0, 5}), HasSubstr("block of 2147483647"));
  EXPECT_THAT(ErrorOf(0, {0, 0, 0, 0}), HasSubstr("block of 0 points"));
  EXPECT_THAT(ErrorOf(1, {-1, 0, 0, 0, 5}), HasSubstr("block of -1 points"));
  EXPECT_THAT(ErrorOf(1, {1, kMax, 0, 0, 5}), HasSubstr("too large"));
  EXPECT_THAT(ErrorOf(1, {1, 0, -kMax - 1, 0, 5}), HasSubstr("too large"));
  EXPECT_THAT(ErrorOf(1, {1, 0, 0, 0, -5}), HasSubstr("invalid point"));
  EXPECT_THAT(ErrorOf(1, {1, 0, 0, 0, kMax}), HasSubstr("invalid point"));
}

}  // namespace
}  // namespace cartographer_sdf::point_cloud_codec_test
