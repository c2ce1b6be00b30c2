// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Everything that may take a submap or a node away, at random and all at once,
// while as many constraints as possible are added, most of them wrong. The host
// aborts the process where one comes too late. Submaps are cheap: two scans of
// a small room each. SDF_STRESS_NODES=20000 drives for longer.

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <random>
#include <thread>

#include "cartographer/mapping/pose_graph.h"
#include "cartographer/mapping/pose_graph_trimmer.h"
#include "cartographer_sdf/live/map_builder.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/live/host.h"
#include "test/live/small_room.h"
#include "test/testing/random_number.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::stress_test {
namespace {

namespace mapping = cartographer::mapping;
using testing::EagerOptions;
using testing::MakeStockOptions;
using testing::SensorIds;
using testing::UniformInt;

int NumNodes() {
  constexpr int kDefault = 600;
  const char* const text = std::getenv("SDF_STRESS_NODES");
  return text == nullptr ? kDefault : std::atoi(text);
}

// Trims whatever it may, now and then: other people's trimmer.
class RandomTrimmer : public mapping::PoseGraphTrimmer {
 public:
  explicit RandomTrimmer(const unsigned seed) : engine_(seed) {}
  void Trim(mapping::Trimmable* const graph) override {
    ++num_calls_;
    const auto submaps = graph->GetOptimizedSubmapData();
    for (const auto& submap : submaps) {
      // The newest of a trajectory stays: the host refers the whole trajectory
      // to it, trimmed or not, and would abort by itself.
      if (UniformInt(4, &engine_) == 0 &&
          graph->GetSubmapIds(submap.id.trajectory_id).back() != submap.id) {
        graph->TrimSubmap(submap.id);
      }
    }
  }
  bool IsFinished() override { return num_calls_ > 30; }

 private:
  std::mt19937 engine_;
  int num_calls_ = 0;
};

class StressTest : public ::testing::Test {
 protected:
  void AddTrajectory(const bool is_trimmed) {
    auto options = stock_.trajectory_builder;
    if (is_trimmed) {
      options.mutable_pure_localization_trimmer()->set_max_submaps_to_keep(3);
    }
    const int id =
        map_builder_->AddTrajectoryBuilder(SensorIds(), options, nullptr);
    robots_.push_back({id, is_trimmed, UniformInt(100, &engine_) * 0.0628, 0});
  }

  void Step(const size_t k) {
    Robot& robot = robots_[k];
    testing::FeedScanOfARoom(map_builder_.get(), robot.trajectory_id,
                             robot.phase, robot.num_scans);
    ++robot.num_scans;
  }

  void Finish(const size_t k) {
    const Robot robot = robots_[k];
    robots_.erase(robots_.begin() + static_cast<std::ptrdiff_t>(k));
    map_builder_->FinishTrajectory(robot.trajectory_id);
    // Those with a trimmer of their own go by themselves.
    if (!robot.is_trimmed) finished_.push_back(robot.trajectory_id);
  }

  void Delete() {
    const size_t k = static_cast<size_t>(
        UniformInt(static_cast<int>(finished_.size()), &engine_));
    const int id = finished_[k];
    // The host aborts by itself where the end has not reached its queue.
    using State = mapping::PoseGraphInterface::TrajectoryState;
    if (map_builder_->pose_graph()->GetTrajectoryStates()[id] !=
        State::FINISHED) {
      return;
    }
    finished_.erase(finished_.begin() + static_cast<std::ptrdiff_t>(k));
    map_builder_->pose_graph()->DeleteTrajectory(id);
  }

  struct Robot {
    int trajectory_id;
    bool is_trimmed;
    double phase;
    int num_scans;
  };
  std::mt19937 engine_{42};
  testing::StockOptions stock_;
  std::unique_ptr<mapping::MapBuilderInterface> map_builder_;
  std::vector<Robot> robots_;
  std::vector<int> finished_;
};

std::string StressLua(const int every_n_nodes, const bool trims_overlapping,
                      const bool matches_scans) {
  std::string lines = testing::SmallSubmapsLua(every_n_nodes);
  if (matches_scans) {
    lines += "POSE_GRAPH.constraint_builder.sampling_ratio = 0.02\n";
  }
  if (trims_overlapping) {
    lines +=
        "POSE_GRAPH.overlapping_submaps_trimmer_2d = { fresh_submaps_count = "
        "4, min_covered_area = 1., min_added_submaps_count = 4 }\n";
  }
  return lines;
}

TEST_F(StressTest, NeverAbortsTheHost) {
  testing::TemporaryDirectory directory;
  // A map to be loaded.
  stock_ = MakeStockOptions(StressLua(3, false, true));
  map_builder_ = mapping::CreateMapBuilder(stock_.map_builder);
  AddTrajectory(false);
  for (int k = 0; k < 12; ++k) Step(0);
  Finish(0);
  map_builder_->pose_graph()->RunFinalOptimization();
  const std::string map_path = directory.path() + "/map.pbstream";
  ASSERT_TRUE(map_builder_->SerializeStateToFile(true, map_path));
  map_builder_.reset();
  finished_.clear();

  int num_injected = 0, num_submaps = 0;
  int num_runs = 0;
  for (int num_nodes = 0; num_nodes < NumNodes(); ++num_runs) {
    constexpr int kNodesOfARun = 150;
    constexpr std::array<int, 3> kEveryNNodes = {1, 4, 10};
    const bool matches_scans = num_runs % 4 < 2;
    stock_ = MakeStockOptions(StressLua(
        kEveryNNodes[static_cast<size_t>(num_runs) % kEveryNNodes.size()],
        num_runs % 2 == 1, matches_scans));
    std::atomic<int> num_localized{0};
    map_builder_ = CreateMapBuilder(
        mapping::CreateMapBuilder(stock_.map_builder), EagerOptions(),
        [&num_localized](const LocalizationResult& result) {
          num_localized += result.localized ? 1 : 0;
        });
    LiveMapBuilder* const live = AsLiveMapBuilder(map_builder_.get());
    auto* const pose_graph =
        dynamic_cast<mapping::PoseGraph*>(map_builder_->pose_graph());
    ASSERT_NE(pose_graph, nullptr);
    // The host's trimmer of overlapping submaps aborts by itself where none is
    // left that was there before, hence some that nobody deletes.
    if (num_runs % 3 == 1 || num_runs % 2 == 1) {
      map_builder_->LoadStateFromFile(map_path, true);
    }
    // A user who looks on.
    std::atomic<bool> is_over{false};
    std::thread onlooker([&] {
      while (!is_over) {
        (void)live->GetSummary();
        (void)live->GetClosures();
        (void)live->GetLocalization(1);
        (void)map_builder_->pose_graph()->GetAllSubmapPoses();
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      }
    });
    AddTrajectory(false);
    AddTrajectory(true);
    for (int k = 0; k < kNodesOfARun; ++k, ++num_nodes) {
      Step(static_cast<size_t>(
          UniformInt(static_cast<int>(robots_.size()), &engine_)));
      const int action = UniformInt(200, &engine_);
      if (action < 8 && robots_.size() > 1) {
        Finish(static_cast<size_t>(
            UniformInt(static_cast<int>(robots_.size()), &engine_)));
      } else if (action < 16 && robots_.size() < 4) {
        AddTrajectory(UniformInt(2, &engine_) == 0);
      } else if (action < 24 && !finished_.empty()) {
        Delete();
      } else if (action < 27) {
        pose_graph->AddTrimmer(std::make_unique<RandomTrimmer>(engine_()));
      } else if (action < 30) {
        live->Localize(robots_.front().trajectory_id);
      } else if (action < 32) {
        pose_graph->RunFinalOptimization();
      } else if (action < 34) {
        map_builder_->LoadStateFromFile(map_path, UniformInt(2, &engine_) == 0);
      } else if (action < 80) {
        // Sometimes the worker keeps up.
        live->WaitUntilIdle();
      }
    }
    // The host demands it.
    while (!robots_.empty()) Finish(0);
    // Where scans wait to be matched as it is destroyed, the host reads tables
    // of its trajectory builders that it has destroyed before.
    if (matches_scans || UniformInt(2, &engine_) == 0) {
      map_builder_->pose_graph()->RunFinalOptimization();
    }
    is_over = true;
    onlooker.join();
    num_injected += live->GetSummary().num_injected;
    num_submaps += live->GetSummary().num_submaps;
    robots_.clear();
    finished_.clear();
    // In the middle of it all.
    map_builder_.reset();
  }
  LOG(INFO) << num_runs << " runs, " << num_submaps << " submaps, "
            << num_injected << " closures injected";
  EXPECT_GT(num_injected, NumNodes() / 50);
}

}  // namespace
}  // namespace cartographer_sdf::stress_test
