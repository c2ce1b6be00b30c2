// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <arpa/inet.h>
#include <netinet/in.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "cartographer/cloud/client/map_builder_stub.h"
#include "cartographer/mapping/pose_graph_interface.h"
#include "cartographer_sdf/live/host_conversion.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "gmock/gmock.h"
#include "grpcpp/generic/generic_stub.h"
#include "grpcpp/grpcpp.h"
#include "gtest/gtest.h"
#include "test/live/office_robot.h"
#include "test/live/small_room.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::fleet_test {
namespace {

namespace mapping = cartographer::mapping;
using cartographer::cloud::MapBuilderStub;
using cartographer::common::Time;
using ::testing::SizeIs;
using testing::TheDrivenOffice;

constexpr absl::Duration kPatience = absl::Minutes(3);

pid_t Spawn(std::vector<std::string> words) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  CHECK_EQ(posix_spawn(&child, argv[0], nullptr, nullptr, argv.data(), environ),
           0);
  return child;
}

template <typename Condition>
bool WaitUntil(const Condition& condition) {
  const absl::Time end = absl::Now() + kPatience;
  while (!condition()) {
    if (absl::Now() > end) return false;
    absl::SleepFor(absl::Milliseconds(20));
  }
  return true;
}

sockaddr_in Loopback(const int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

int FreePort() {
  const int listener = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = Loopback(0);
  socklen_t size = sizeof(address);
  CHECK_EQ(bind(listener, reinterpret_cast<sockaddr*>(&address), size), 0);
  CHECK_EQ(getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size),
           0);
  close(listener);
  return ntohs(address.sin_port);
}

class Server {
 public:
  explicit Server(const std::string& lines) : port_(FreePort()) {
    directory_.Write("server.lua",
                     absl::StrCat("include "
                                  "\"cartographer_server.lua\"\n",
                                  lines, "return MAP_BUILDER_SERVER\n"));
    process_ =
        Spawn({TEST_GRPC_SERVER_PROGRAM, "--configuration_basename=server.lua",
               "--configuration_directory=" + directory_.path(),
               "--address=" + address(), "--output=" + map_path()});
  }
  ~Server() {
    if (process_ != 0) End(SIGKILL);
  }
  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] std::string address() const {
    return absl::StrCat("127.0.0.1:", port_);
  }
  [[nodiscard]] std::string map_path() const {
    return directory_.path() + "/map.pbstream";
  }
  [[nodiscard]] bool IsRunning() const {
    int status = 0;
    return waitpid(process_, &status, WNOHANG) == 0;
  }
  // Returns the exit code.
  int End(const int signal) {
    kill(process_, signal);
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  const testing::TemporaryDirectory directory_;
  const int port_;
  pid_t process_ = 0;
};

// A robot, as the server's client, which hears of its own local SLAM.
class Client {
 public:
  Client(const Server& server, const std::string& name,
         const std::string& lines)
      : stub_(server.address(), name),
        id_(stub_.AddTrajectoryBuilder(
            testing::SensorIds(),
            testing::MakeStockOptions(lines).trajectory_builder,
            [this](int, const Time time, cartographer::transform::Rigid3d,
                   cartographer::sensor::RangeData,
                   std::unique_ptr<const mapping::TrajectoryBuilderInterface::
                                       InsertionResult>) {
              const absl::MutexLock lock(&mutex_);
              newest_ = time;
            })) {}

  // Returns whether the server has taken all scans: what arrives after the end
  // of a trajectory is dropped.
  bool Drive(const std::vector<Rigid2>& poses) {
    testing::Robot(&stub_, id_, static_cast<unsigned>(id_ + 1)).Drive(poses);
    return WaitUntilTaken(testing::kTimeStep *
                          static_cast<double>(poses.size() - 2));
  }
  bool WaitUntilTaken(const double seconds) {
    return WaitUntil([&] {
      const absl::MutexLock lock(&mutex_);
      return newest_ && *newest_ >= testing::TimeOf(seconds);
    });
  }
  void Finish() { stub_.FinishTrajectory(id_); }
  [[nodiscard]] int id() const { return id_; }
  MapBuilderStub& stub() { return stub_; }

 private:
  absl::Mutex mutex_;
  std::optional<Time> newest_ ABSL_GUARDED_BY(mutex_);
  MapBuilderStub stub_;
  const int id_;
};

// The server's own are the same as of map_builder_test: it closes no loops but
// ours.
constexpr char kOftenOptimized[] = "POSE_GRAPH.optimize_every_n_nodes = 5\n";

TEST(ServerTest, AFaultOfItsFilesIsAnErrorAndNoCrash) {
  testing::TemporaryDirectory directory;
  directory.Write("no_lua.lua", "return {");
  for (const char* const basename : {"absent.lua", "no_lua.lua"}) {
    const pid_t server =
        Spawn({TEST_GRPC_SERVER_PROGRAM,
               absl::StrCat("--configuration_basename=", basename),
               "--configuration_directory=" + directory.path()});
    int status = 0;
    waitpid(server, &status, 0);
    EXPECT_TRUE(WIFEXITED(status)) << basename;
    EXPECT_EQ(WEXITSTATUS(status), 1) << basename;
  }
}

TEST(FleetTest, RobotsWithoutACommonFrameAreJoined) {
  Server server(kOftenOptimized);
  const std::vector<Rigid2>& all = TheDrivenOffice().poses;
  const auto part = [&all](const double begin, const double end) {
    const auto count = static_cast<double>(all.size());
    return std::vector<Rigid2>(
        all.begin() + static_cast<std::ptrdiff_t>(begin * count),
        all.begin() + static_cast<std::ptrdiff_t>(end * count));
  };
  const std::vector<std::vector<Rigid2>> drives = {part(0., 0.55),
                                                   part(0.25, 0.8)};
  Client first(server, "first", testing::kWithoutOwnSearch);
  Client second(server, "second", testing::kWithoutOwnSearch);
  ASSERT_NE(first.id(), second.id());
  bool is_first_taken = false;
  std::thread beside([&] { is_first_taken = first.Drive(drives[0]); });
  EXPECT_TRUE(second.Drive(drives[1]));
  beside.join();
  EXPECT_TRUE(is_first_taken);
  first.Finish();
  second.Finish();
  mapping::PoseGraphInterface* const graph = first.stub().pose_graph();
  graph->RunFinalOptimization();

  int num_between = 0;
  for (const auto& constraint : graph->constraints()) {
    if (constraint.submap_id.trajectory_id !=
        constraint.node_id.trajectory_id) {
      ++num_between;
    }
  }
  EXPECT_GE(num_between, 10);
  // Where both have been, one is where it should be, seen from the other.
  const auto nodes = graph->GetTrajectoryNodePoses();
  int num_compared = 0;
  for (const auto& a : nodes.trajectory(first.id())) {
    for (const auto& b : nodes.trajectory(second.id())) {
      const Rigid2 true_a =
          testing::PoseAt(drives[0], a.data.constant_pose_data->time);
      const Rigid2 true_b =
          testing::PoseAt(drives[1], b.data.constant_pose_data->time);
      const Rigid2 truly = true_a.Inverse() * true_b;
      if (truly.translation().norm() > 1.) continue;
      const Rigid2 off =
          truly.Inverse() *
          FromHost(a.data.global_pose.inverse() * b.data.global_pose);
      EXPECT_LT(off.translation().norm(), 0.4);
      EXPECT_LT(std::abs(off.rotation()), 0.1);
      ++num_compared;
    }
  }
  EXPECT_GE(num_compared, 20);

  // It leaves the map of both.
  EXPECT_EQ(server.End(SIGTERM), 0);
  const absl::StatusOr<MapState> map = ReadMap(server.map_path());
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_THAT(map->trajectories, SizeIs(2));
}

void SendBytes(const Server& server, const std::string& bytes) {
  const int connection = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = Loopback(server.port());
  ASSERT_EQ(connect(connection, reinterpret_cast<sockaddr*>(&address),
                    sizeof(address)),
            0);
  EXPECT_EQ(send(connection, bytes.data(), bytes.size(), MSG_NOSIGNAL),
            static_cast<ssize_t>(bytes.size()));
  close(connection);
}

// Calls a method with these bytes in place of a message.
void CallWithBytes(const Server& server, const std::string& method,
                   const std::string& bytes) {
  grpc::GenericStub stub(grpc::CreateChannel(
      server.address(), grpc::InsecureChannelCredentials()));
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() +
                       std::chrono::seconds(2));
  const grpc::Slice slice(bytes);
  const grpc::ByteBuffer request(&slice, 1);
  grpc::ByteBuffer response;
  grpc::CompletionQueue queue;
  const auto call = stub.PrepareUnaryCall(
      &context, "/cartographer.cloud.proto.MapBuilderService/" + method,
      request, &queue);
  call->StartCall();
  grpc::Status status;
  call->Finish(&response, &status, &queue);
  void* tag = nullptr;
  bool is_ok = false;
  queue.Next(&tag, &is_ok);
}

class RubbishTest : public ::testing::Test {
 protected:
  // A robot that behaves is served as ever.
  void ExpectServesOthers() {
    ASSERT_TRUE(server_.IsRunning());
    Client robot(server_, "decent", lines_);
    for (int k = 0; k < 20; ++k) {
      testing::FeedScanOfARoom(&robot.stub(), robot.id(), 0., k);
    }
    EXPECT_TRUE(robot.WaitUntilTaken(0.3 * 17));
    robot.Finish();
    robot.stub().pose_graph()->RunFinalOptimization();
    const auto nodes = robot.stub().pose_graph()->GetTrajectoryNodePoses();
    EXPECT_GE(nodes.SizeOfTrajectoryOrZero(robot.id()), 10u);
    EXPECT_TRUE(server_.IsRunning());
  }

  const std::string lines_ = testing::SmallSubmapsLua(3);
  Server server_{"POSE_GRAPH.optimize_every_n_nodes = 3\n"};
};

TEST_F(RubbishTest, ARobotDies) {
  Client observer(server_, "observer", lines_);
  const pid_t robot = Spawn({TEST_ROBOT_PROGRAM, server_.address()});
  const auto num_nodes = [&observer] {
    size_t count = 0;
    const auto nodes = observer.stub().pose_graph()->GetTrajectoryNodePoses();
    for (const auto& node : nodes) {
      count += node.id.trajectory_id != 0 ? 1 : 0;
    }
    return count;
  };
  EXPECT_TRUE(WaitUntil([&] { return num_nodes() >= 10; }));
  kill(robot, SIGKILL);
  waitpid(robot, nullptr, 0);
  ExpectServesOthers();
  observer.Finish();
}

TEST_F(RubbishTest, BytesThatAreNoMessages) {
  ExpectServesOthers();
  SendBytes(server_, "GET / HTTP/1.1\r\n\r\n");
  SendBytes(server_, std::string(10000, '\xff'));
  // The beginning of a connection of gRPC, then nothing of it.
  SendBytes(server_,
            "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + std::string(500, '\x7f'));
  for (const char* const method :
       {"AddTrajectory", "AddOdometryData", "AddRangefinderData",
        "AddSensorDataBatch", "FinishTrajectory", "DeleteTrajectory",
        "ReceiveLocalSlamResults", "GetSubmap", "LoadState",
        "LoadStateFromFile", "WriteStateToFile", "NoSuchMethod"}) {
    CallWithBytes(server_, method, std::string(64, '\xff'));
    EXPECT_TRUE(server_.IsRunning()) << method;
  }
  ExpectServesOthers();
}

TEST_F(RubbishTest, MessagesThatMakeNoSense) {
  {
    Client robot(server_, "confused", lines_);
    testing::FeedScanOfARoom(&robot.stub(), robot.id(), 0., 5);
    testing::FeedScanOfARoom(&robot.stub(), robot.id(), 0., 6);
    // The time goes back, and then the numbers are gone.
    testing::FeedScanOfARoom(&robot.stub(), robot.id(), 0., 2);
    testing::FeedOdometry(
        &robot.stub(), robot.id(), 3.,
        Rigid2(std::numeric_limits<double>::quiet_NaN(), 0., 0.));
    for (int k = 10; k < 20; ++k) {
      testing::FeedScanOfARoom(&robot.stub(), robot.id(), 0., k);
    }
    EXPECT_TRUE(robot.WaitUntilTaken(0.3 * 17));
    robot.Finish();
    robot.Finish();
    robot.stub().FinishTrajectory(1234);
    robot.stub().pose_graph()->DeleteTrajectory(1234);
    robot.stub().LoadStateFromFile("/no/such/file.pbstream", true);
  }
  ExpectServesOthers();
  EXPECT_EQ(server_.End(SIGTERM), 0);
}

}  // namespace
}  // namespace cartographer_sdf::fleet_test
