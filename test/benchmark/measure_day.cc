// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A long day of the live searcher in one process: robots map, localise with
// Cartographer's trimmer of pure localisation, are carried away, and end; old
// trajectories are deleted, overlapping submaps trimmed, maps saved. Prints a
// CSV with a line for every hundred or so submaps, for scripts/measure_day.py.
//
// usage: measure_day [NUM_SUBMAPS [SEED [alone]]]
//
// With `alone`, Cartographer runs without the searcher, for what it takes by
// itself.

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <deque>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "cartographer_sdf/live/map_builder.h"
#include "glog/logging.h"
#include "test/live/host.h"
#include "test/live/small_room.h"
#include "test/testing/random_number.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf {
namespace {

namespace mapping = ::cartographer::mapping;
using State = mapping::PoseGraphInterface::TrajectoryState;

// Submaps of two scans.
constexpr int kScansOfAShift = 220;
constexpr double kSecondsPerScan = 0.3;  // as FeedScanOfARoom() has it
constexpr size_t kNumKeptTrajectories = 2;
constexpr int kShiftsPerSave = 5;
// Carried to the other side of the room.
constexpr double kCarriedBy = M_PI;

double Seconds() {
  return std::chrono::duration<double>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// Of this thread, which adds the scans: what other programs do on the machine
// does not count.
double CpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) +
         1e-9 * static_cast<double>(now.tv_nsec);
}

double ResidentMegabytes() {
  std::ifstream file("/proc/self/statm");
  double size = 0., resident = 0.;
  file >> size >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

testing::StockOptions Stock() {
  return testing::MakeStockOptions(
      testing::SmallSubmapsLua(/*every_n_nodes=*/10) +
      "POSE_GRAPH.overlapping_submaps_trimmer_2d = { fresh_submaps_count = 4, "
      "min_covered_area = 1., min_added_submaps_count = 4 }\n");
}

// A map to localise in.
void WriteMapOfTheRoom(const std::string& path) {
  testing::StockOptions stock =
      testing::MakeStockOptions(testing::SmallSubmapsLua(10));
  const auto host = mapping::CreateMapBuilder(stock.map_builder);
  const int id = host->AddTrajectoryBuilder(testing::SensorIds(),
                                            stock.trajectory_builder, nullptr);
  for (int k = 0; k < 70; ++k) {
    testing::FeedScanOfARoom(host.get(), id, 0., k);
  }
  host->FinishTrajectory(id);
  host->pose_graph()->RunFinalOptimization();
  CHECK(host->SerializeStateToFile(true, path));
}

class Day {
 public:
  Day(const unsigned seed, const bool is_alone) : engine_(seed) {
    const std::string map = directory_.File("map.pbstream");
    WriteMapOfTheRoom(map);
    LiveOptions options = testing::EagerOptions();
    options.enabled = !is_alone;
    builder_ =
        CreateMapBuilder(mapping::CreateMapBuilder(stock_.map_builder), options,
                         [this](const LocalizationResult& result) {
                           num_localized_ += result.localized ? 1 : 0;
                         });
    live_ = AsLiveMapBuilder(builder_.get());
    builder_->LoadStateFromFile(map, /*load_frozen_state=*/true);
    std::cout
        << "hours,submaps,trajectories,places,waiting,resident_mb,scan_mean_ms,"
           "scan_max_ms,scan_mean_cpu_ms,callback_mean_us,worker_ms_per_"
           "submap,closures,"
           "localized,kidnaps,deletions,saves\n";
  }

  void Run(const int num_submaps) {
    for (int shift = 0; GetSummary().num_submaps < num_submaps; ++shift) {
      Shift(/*is_trimmed=*/shift % 2 == 1);
      if (shift % kShiftsPerSave == 0) Save();
      DeleteOldTrajectories();
      if (live_ != nullptr) live_->WaitUntilIdle();
      PrintLine();
    }
    builder_->pose_graph()->RunFinalOptimization();
    PrintLine();
  }

 private:
  // A submap is begun every two scans.
  [[nodiscard]] LiveSummary GetSummary() const {
    if (live_ != nullptr) return live_->GetSummary();
    LiveSummary summary;
    summary.num_submaps = num_trajectories_ * kScansOfAShift / 2;
    return summary;
  }

  // One drive; half of them are carried away in their middle.
  void Shift(const bool is_trimmed) {
    auto options = stock_.trajectory_builder;
    if (is_trimmed) {
      options.mutable_pure_localization_trimmer()->set_max_submaps_to_keep(3);
    }
    const int id =
        builder_->AddTrajectoryBuilder(testing::SensorIds(), options, nullptr);
    ++num_trajectories_;
    double phase = testing::UniformInt(100, &engine_) * 0.0628;
    const bool is_carried = testing::UniformInt(2, &engine_) == 0;
    for (int k = 0; k < kScansOfAShift; ++k) {
      if (is_carried && k == kScansOfAShift / 2) {
        phase += kCarriedBy;
        if (live_ != nullptr) live_->Localize(id);
        ++num_kidnaps_;
      }
      const double begin = Seconds(), cpu_begin = CpuSeconds();
      testing::FeedScanOfARoom(builder_.get(), id, phase, k);
      scan_cpu_seconds_ += CpuSeconds() - cpu_begin;
      scan_seconds_.push_back(Seconds() - begin);
    }
    builder_->FinishTrajectory(id);
    if (!is_trimmed) finished_.push_back(id);
    WaitForTheHost(id);
  }

  // Until the end of the trajectory has reached its queue.
  void WaitForTheHost(const int id) const {
    while (builder_->pose_graph()->GetTrajectoryStates().at(id) ==
           State::ACTIVE) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  void Save() {
    CHECK(builder_->SerializeStateToFile(true,
                                         directory_.File("saved.pbstream")));
    ++num_saves_;
  }

  void DeleteOldTrajectories() {
    mapping::PoseGraphInterface* const graph = builder_->pose_graph();
    while (finished_.size() > kNumKeptTrajectories) {
      graph->DeleteTrajectory(finished_.front());
      finished_.pop_front();
      ++num_deletions_;
    }
  }

  // Of the time since the last line.
  void PrintLine() {
    const LiveSummary now = GetSummary();
    double sum = 0., longest = 0.;
    for (const double seconds : scan_seconds_) {
      sum += seconds;
      longest = std::max(longest, seconds);
    }
    const double num_scans =
        static_cast<double>(std::max<size_t>(1, scan_seconds_.size()));
    const double callbacks =
        now.callback_mean_seconds * static_cast<double>(now.num_callbacks) -
        last_.callback_mean_seconds * static_cast<double>(last_.num_callbacks);
    std::cout << num_trajectories_ * kScansOfAShift * kSecondsPerScan / 3600.
              << "," << now.num_submaps << "," << num_trajectories_ << ","
              << now.num_places << "," << now.num_waiting_tasks << ","
              << ResidentMegabytes() << "," << 1e3 * sum / num_scans << ","
              << 1e3 * longest << "," << 1e3 * scan_cpu_seconds_ / num_scans
              << ","
              << 1e6 * callbacks /
                     static_cast<double>(std::max<int64_t>(
                         1, now.num_callbacks - last_.num_callbacks))
              << ","
              << 1e3 * (now.worker_cpu_seconds - last_.worker_cpu_seconds) /
                     std::max(1, now.num_submaps - last_.num_submaps)
              << "," << now.num_injected << "," << num_localized_ << ","
              << num_kidnaps_ << "," << num_deletions_ << "," << num_saves_
              << std::endl;
    last_ = now;
    scan_seconds_.clear();
    scan_cpu_seconds_ = 0.;
  }

  testing::TemporaryDirectory directory_;
  std::mt19937 engine_;
  const testing::StockOptions stock_ = Stock();
  std::atomic<int> num_localized_{0};
  std::unique_ptr<mapping::MapBuilderInterface> builder_;
  LiveMapBuilder* live_ = nullptr;
  std::deque<int> finished_;
  int num_trajectories_ = 0, num_kidnaps_ = 0, num_deletions_ = 0,
      num_saves_ = 0;
  std::vector<double> scan_seconds_;  // wall time of each
  double scan_cpu_seconds_ = 0.;
  LiveSummary last_;
};

}  // namespace
}  // namespace cartographer_sdf

int main(int argc, char** argv) {
  google::InitGoogleLogging(argv[0]);
  const int num_submaps = argc > 1 ? std::atoi(argv[1]) : 10000;
  const unsigned seed =
      argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 1;
  const bool is_alone = argc > 3 && std::string(argv[3]) == "alone";
  cartographer_sdf::Day(seed, is_alone).Run(num_submaps);
  return EXIT_SUCCESS;
}
