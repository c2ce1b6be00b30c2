// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/client_guard.h"

#include <limits>
#include <memory>
#include <string>

#include "cartographer/io/proto_stream.h"
#include "cartographer/io/proto_stream_interface.h"
#include "cartographer/mapping/map_builder.h"
#include "cartographer/transform/transform.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/live/host.h"
#include "test/live/small_room.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::client_guard_test {
namespace {

namespace mapping = cartographer::mapping;
namespace sensor = cartographer::sensor;
using testing::FeedScanOfARoom;
using ::testing::IsEmpty;
using ::testing::IsNull;
using ::testing::SizeIs;
using testing::TimeOf;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

// Cartographer ends the process at each of the faults that it is not spared.
class ClientGuardTest : public ::testing::Test {
 protected:
  int Start() {
    return guarded_->AddTrajectoryBuilder(testing::SensorIds(),
                                          stock_.trajectory_builder, nullptr);
  }
  void Drive(const int id, const int begin, const int end) {
    for (int k = begin; k < end; ++k)
      FeedScanOfARoom(guarded_.get(), id, 0., k);
  }
  mapping::TrajectoryBuilderInterface* Builder(const int id) {
    return guarded_->GetTrajectoryBuilder(id);
  }
  int Finish(const int id) {
    guarded_->FinishTrajectory(id);
    guarded_->pose_graph()->RunFinalOptimization();
    return static_cast<int>(
        guarded_->pose_graph()->GetTrajectoryNodePoses().SizeOfTrajectoryOrZero(
            id));
  }
  std::string WriteMap() {
    const int id = Start();
    Drive(id, 0, 20);
    Finish(id);
    const std::string path = directory_.File("map.pbstream");
    CHECK(guarded_->SerializeStateToFile(true, path));
    return path;
  }

  testing::TemporaryDirectory directory_;
  testing::StockOptions stock_ =
      testing::MakeStockOptions(testing::SmallSubmapsLua(3));
  std::unique_ptr<mapping::MapBuilderInterface> guarded_ =
      GuardAgainstClients(mapping::CreateMapBuilder(stock_.map_builder));
};

TEST_F(ClientGuardTest, SoundDataPassAsTheyAre) {
  const int id = Start();
  Drive(id, 0, 20);
  const int plain = guarded_->num_trajectory_builders();
  EXPECT_EQ(plain, 1);
  const auto host = mapping::CreateMapBuilder(stock_.map_builder);
  const int host_id = host->AddTrajectoryBuilder(
      testing::SensorIds(), stock_.trajectory_builder, nullptr);
  for (int k = 0; k < 20; ++k) FeedScanOfARoom(host.get(), host_id, 0., k);
  host->FinishTrajectory(host_id);
  host->pose_graph()->RunFinalOptimization();
  EXPECT_EQ(
      Finish(id),
      static_cast<int>(
          host->pose_graph()->GetTrajectoryNodePoses().SizeOfTrajectoryOrZero(
              host_id)));
}

TEST_F(ClientGuardTest, DropsWhatIsOutOfOrder) {
  const int id = Start();
  Drive(id, 10, 20);
  Drive(id, 0, 20);
  EXPECT_GE(Finish(id), 8);
}

TEST_F(ClientGuardTest, DropsWhatIsNoNumber) {
  const int id = Start();
  Drive(id, 0, 5);
  testing::FeedOdometry(guarded_.get(), id, 1.3, Rigid2(kNotANumber, 0., 0.));
  sensor::TimedPointCloudData scan;
  scan.time = TimeOf(1.3);
  scan.origin = Eigen::Vector3f::Zero();
  scan.ranges = {{{1.f, static_cast<float>(kNotANumber), 0.f}, 0.f}};
  Builder(id)->AddSensorData(testing::kRange, scan);
  // Of the future.
  scan.ranges = {{{1.f, 0.f, 0.f}, 5.f}};
  Builder(id)->AddSensorData(testing::kRange, scan);
  Drive(id, 5, 20);
  EXPECT_GE(Finish(id), 17);
}

TEST_F(ClientGuardTest, DropsDataOfSensorsThatItDoesNotHave) {
  const int id = Start();
  Drive(id, 0, 5);
  sensor::TimedPointCloudData scan;
  scan.time = TimeOf(1.3);
  scan.origin = Eigen::Vector3f::Zero();
  scan.ranges = {{{1.f, 0.f, 0.f}, 0.f}};
  Builder(id)->AddSensorData(testing::kOdometry, scan);
  Builder(id)->AddSensorData("other", scan);
  Builder(id)->AddSensorData(
      "imu", sensor::ImuData{TimeOf(1.3), Eigen::Vector3d(0., 0., 9.8),
                             Eigen::Vector3d::Zero()});
  Drive(id, 5, 20);
  EXPECT_GE(Finish(id), 17);
}

TEST_F(ClientGuardTest, AnEndThatIsNoneDoesNothing) {
  EXPECT_THAT(Builder(0), IsNull());
  guarded_->FinishTrajectory(0);
  const int id = Start();
  Drive(id, 0, 10);
  EXPECT_GE(Finish(id), 7);
  guarded_->FinishTrajectory(id);
  // Late data.
  Drive(id, 10, 12);
  EXPECT_EQ(Finish(id), Finish(id));
}

TEST_F(ClientGuardTest, StartsWithoutAPoseRelativeToNothing) {
  auto* const pose =
      stock_.trajectory_builder.mutable_initial_trajectory_pose();
  pose->set_to_trajectory_id(7);
  *pose->mutable_relative_pose() = cartographer::transform::ToProto(
      cartographer::transform::Rigid3d::Identity());
  pose->set_timestamp(0);
  const int id = Start();
  Drive(id, 0, 10);
  EXPECT_GE(Finish(id), 7);
}

TEST_F(ClientGuardTest, LoadsMapsAlone) {
  const std::string path = WriteMap();
  const std::string rubbish = directory_.Write("rubbish.pbstream", "rubbish");
  EXPECT_THAT(guarded_->LoadStateFromFile(rubbish, true), IsEmpty());
  EXPECT_THAT(guarded_->LoadStateFromFile(directory_.File("none"), true),
              IsEmpty());
  EXPECT_THAT(guarded_->LoadStateFromFile(path, true), SizeIs(1));
  cartographer::io::ProtoStreamReader reader(path);
  EXPECT_THAT(guarded_->LoadState(&reader, true), SizeIs(1));
  EXPECT_EQ(guarded_->num_trajectory_builders(), 3);
}

// Ends after so many messages.
class BrokenOff : public cartographer::io::ProtoStreamReaderInterface {
 public:
  BrokenOff(const std::string& path, const int count)
      : whole_(path), num_left_(count) {}
  bool ReadProto(google::protobuf::Message* const message) override {
    return num_left_-- > 0 && whole_.ReadProto(message);
  }
  [[nodiscard]] bool eof() const override {
    return num_left_ <= 0 || whole_.eof();
  }

 private:
  cartographer::io::ProtoStreamReader whole_;
  int num_left_;
};

TEST_F(ClientGuardTest, DropsAStateWhoseSenderDied) {
  const std::string path = WriteMap();
  for (const int count : {0, 1, 2, 5}) {
    BrokenOff broken_off(path, count);
    EXPECT_THAT(guarded_->LoadState(&broken_off, true), IsEmpty()) << count;
  }
  EXPECT_EQ(guarded_->num_trajectory_builders(), 1);
}

}  // namespace
}  // namespace cartographer_sdf::client_guard_test
