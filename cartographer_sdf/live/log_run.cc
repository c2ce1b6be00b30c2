// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/log_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>
#include <thread>
#include <utility>

#include "absl/base/thread_annotations.h"
#include "absl/strings/str_cat.h"
#include "absl/synchronization/mutex.h"
#include "cartographer/common/configuration_file_resolver.h"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/mapping/map_builder.h"
#include "cartographer/mapping/pose_graph.h"
#include "cartographer/mapping/trajectory_builder_interface.h"
#include "cartographer/sensor/imu_data.h"
#include "cartographer/sensor/odometry_data.h"
#include "cartographer/sensor/timed_point_cloud_data.h"
#include "cartographer_sdf/live/host_conversion.h"
#include "cartographer_sdf/live/save_state.h"
#include "cartographer_sdf/live/worker.h"
#include "cartographer_sdf/pbstream/map_file.h"

namespace cartographer_sdf {
namespace {

namespace mapping = cartographer::mapping;
namespace sensor = cartographer::sensor;
namespace transform = cartographer::transform;
using cartographer::common::Time;
using SensorId = mapping::TrajectoryBuilderInterface::SensorId;

constexpr char kRangeSensor[] = "range";
constexpr char kImuSensor[] = "imu";
constexpr char kOdometrySensor[] = "odom";
// Reading of an accelerometer at rest [m/s^2].
constexpr double kGravity = 9.8;
// One final optimisation lets closures into the graph, the next one acts on
// them.
constexpr int kMaxFinalOptimizations = 4;

Time ToHostTime(const double unix_seconds) {
  // Times in the year 2001 have a resolution of about 1e-7 s in a double, the
  // length of the host's ticks.
  return cartographer::common::FromUniversal(
      std::llround(unix_seconds * 1e7) +
      cartographer::common::kUtsEpochOffsetFromUnixEpochInSeconds * 10000000ll);
}

// Returns every beam, because the host also uses those without a return. A
// range beyond max_range marks its first metres as free.
sensor::TimedPointCloudData ToHostScan(const Recording& recording,
                                       const LaserScan& scan) {
  sensor::TimedPointCloudData data;
  data.time = ToHostTime(scan.time);
  data.origin = Eigen::Vector3f::Zero();
  data.ranges.reserve(scan.ranges.size());
  for (size_t i = 0; i < scan.ranges.size(); ++i) {
    const double angle = recording.first_angle +
                         recording.angle_increment * static_cast<double>(i);
    const Eigen::Vector3d direction(std::cos(angle), std::sin(angle), 0.);
    data.ranges.push_back(sensor::TimedRangefinderPoint{
        (scan.ranges[i] * direction).cast<float>(), 0.f});
  }
  return data;
}

// Silences the host, which prints the progress of synchronous optimisations to
// standard output.
struct SilentStandardOutput {
  SilentStandardOutput() { std::cout.setstate(std::ios::failbit); }
  ~SilentStandardOutput() { std::cout.clear(); }
};

// Clock shared by the threads of a run. CPU time is that of all threads [s].
struct Clock {
  const std::chrono::steady_clock::time_point begin =
      std::chrono::steady_clock::now();
  const std::clock_t begin_cpu = std::clock();

  [[nodiscard]] double wall() const { return SecondsSince(begin); }
  [[nodiscard]] double cpu() const {
    return static_cast<double>(std::clock() - begin_cpu) / CLOCKS_PER_SEC;
  }
};

class Run {
 public:
  Run(const Recording& recording, const LogRunOptions& options)
      : recording_(recording),
        options_(options),
        distances_(MetersDriven(recording)),
        uses_imu_(
            options.host.trajectory_builder.trajectory_builder_2d_options()
                .use_imu_data()),
        map_builder_(CreateMapBuilder(
            mapping::CreateMapBuilder(options.host.map_builder), options.live,
            [this](const LocalizationResult& result) { Located(result); })),
        live_(AsLiveMapBuilder(map_builder_.get())) {}

  absl::Status LoadMap() {
    if (!options_.map_path.has_value()) return absl::OkStatus();
    // The host aborts on invalid files.
    const absl::StatusOr<MapState> state = ReadMap(*options_.map_path);
    if (!state.ok()) return state.status();
    if (state->trajectories.empty()) {
      return absl::InvalidArgumentError(
          absl::StrCat(*options_.map_path, " holds no trajectory"));
    }
    map_builder_->LoadStateFromFile(*options_.map_path,
                                    /*load_frozen_state=*/true);
    WaitForSearcher();
    return absl::OkStatus();
  }

  // Returns false if no node was created.
  bool Drive(const std::function<void(double)>& on_progress) {
    std::set<SensorId> sensors = {
        {SensorId::SensorType::RANGE, kRangeSensor},
        {SensorId::SensorType::ODOMETRY, kOdometrySensor}};
    if (uses_imu_) sensors.insert({SensorId::SensorType::IMU, kImuSensor});
    // Must exist before the first scan reads it.
    clock_ = std::make_unique<Clock>();
    result_.trajectory_id = map_builder_->AddTrajectoryBuilder(
        sensors, options_.host.trajectory_builder,
        [this](const int, const Time time, const transform::Rigid3d& local_pose,
               sensor::RangeData,
               const std::unique_ptr<
                   const mapping::TrajectoryBuilderInterface::InsertionResult>&
                   insertion) { Inserted(time, local_pose, insertion.get()); });
    const std::vector<LaserScan>& scans = recording_.scans;
    for (size_t i = 0; i < scans.size(); ++i) {
      KeepPace(scans[i].time - scans.front().time);
      {
        const absl::MutexLock lock(&mutex_);
        now_ = i;
      }
      Feed(i);
      if (!options_.real_time_factor.has_value()) WaitForSearcher();
      if (on_progress) {
        on_progress(static_cast<double>(i + 1) /
                    static_cast<double>(scans.size()));
      }
    }
    result_.num_scans = static_cast<int>(scans.size());
    result_.duration = scans.back().time - scans.front().time;
    result_.distance = distances_.back();
    result_.wall_seconds = clock_->wall();
    result_.cpu_seconds = clock_->cpu();
    return !result_.nodes.empty();
  }

  void Finish() {
    map_builder_->FinishTrajectory(result_.trajectory_id);
    for (int k = 0; k < kMaxFinalOptimizations; ++k) {
      WaitForSearcher();
      const int num_injected = NumInjected();
      map_builder_->pose_graph()->RunFinalOptimization();
      WaitForSearcher();
      if (NumInjected() == num_injected) break;
    }
    result_.final_wall_seconds = clock_->wall() - result_.wall_seconds;
    result_.final_cpu_seconds = clock_->cpu() - result_.cpu_seconds;
  }

  absl::Status WriteMap() const {
    if (!options_.output_path.has_value()) return absl::OkStatus();
    return SaveState(*options_.output_path, map_builder_.get());
  }

  LogRunResult TakeResult() {
    if (live_ != nullptr) {
      result_.summary = live_->GetSummary();
      result_.closures = live_->GetClosures();
    }
    const absl::MutexLock lock(&mutex_);
    result_.localizations = std::move(localizations_);
    return std::move(result_);
  }

 private:
  void WaitForSearcher() const {
    if (live_ != nullptr) live_->WaitUntilIdle();
  }
  [[nodiscard]] int NumInjected() const {
    return live_ == nullptr ? 0 : live_->GetSummary().num_injected;
  }

  void KeepPace(const double recording_seconds) {
    if (!options_.real_time_factor.has_value()) return;
    const double due = recording_seconds / *options_.real_time_factor;
    const double early = due - clock_->wall();
    if (early > 0.) {
      std::this_thread::sleep_for(std::chrono::duration<double>(early));
    } else {
      result_.max_delay_seconds = std::max(result_.max_delay_seconds, -early);
    }
  }

  void Feed(const size_t i) {
    const LaserScan& scan = recording_.scans[i];
    const std::vector<MotionSample> samples =
        i == 0
            ? std::vector<MotionSample>{{scan.time, scan.T_odometry_robot, 0.}}
            : MotionBetween(recording_.scans[i - 1], scan);
    const sensor::TimedPointCloudData host_scan = ToHostScan(recording_, scan);
    mapping::TrajectoryBuilderInterface* const builder =
        map_builder_->GetTrajectoryBuilder(result_.trajectory_id);
    for (const MotionSample& sample : samples) {
      const Time time = ToHostTime(sample.time);
      if (uses_imu_) {
        AddSensorData(builder, kImuSensor,
                      sensor::ImuData{
                          time, {0., 0., kGravity}, {0., 0., sample.yaw_rate}});
      }
      AddSensorData(
          builder, kOdometrySensor,
          sensor::OdometryData{time, ToHost(sample.T_odometry_robot)});
    }
    AddSensorData(builder, kRangeSensor, host_scan);
  }

  // The host processes a scan as soon as all sensors have reached its time,
  // whichever comes last.
  template <typename SensorData>
  void AddSensorData(mapping::TrajectoryBuilderInterface* const builder,
                     const std::string& sensor, const SensorData& data) {
    const auto begin = std::chrono::steady_clock::now();
    builder->AddSensorData(sensor, data);
    result_.sensor_seconds.push_back(SecondsSince(begin));
  }

  // Called on the sensor thread.
  void Inserted(
      const Time time, const transform::Rigid3d& local_pose,
      const mapping::TrajectoryBuilderInterface::InsertionResult* const
          insertion) {
    if (insertion == nullptr) return;
    NodeMoment moment;
    moment.node_index = insertion->node_id.node_index;
    moment.time = FromHostTime(time);
    moment.T_map_tracking =
        FromHost(map_builder_->pose_graph()->GetLocalToGlobalTransform(
                     insertion->node_id.trajectory_id) *
                 local_pose);
    moment.is_connected = IsConnected(insertion->node_id.trajectory_id);
    moment.cpu_seconds = clock_->cpu();
    const absl::MutexLock lock(&mutex_);
    moment.distance = distances_[now_];
    result_.nodes.push_back(moment);
  }

  [[nodiscard]] bool IsConnected(const int trajectory_id) const {
    if (!options_.map_path.has_value()) return false;
    const auto* const pose_graph =
        dynamic_cast<mapping::PoseGraph*>(map_builder_->pose_graph());
    if (pose_graph == nullptr) return false;
    const auto components = pose_graph->GetConnectedTrajectories();
    return std::any_of(components.begin(), components.end(),
                       [trajectory_id](const std::vector<int>& component) {
                         return component.size() > 1 &&
                                std::count(component.begin(), component.end(),
                                           trajectory_id) > 0;
                       });
  }

  // Called on the searcher's thread.
  void Located(const LocalizationResult& result) {
    if (clock_ == nullptr) return;
    const double cpu = clock_->cpu();
    const absl::MutexLock lock(&mutex_);
    localizations_.push_back(LocalizationMoment{
        result, recording_.scans[now_].time, distances_[now_], cpu});
  }

  const Recording& recording_;
  const LogRunOptions& options_;
  const std::vector<double> distances_;
  const bool uses_imu_;
  std::unique_ptr<Clock> clock_;
  LogRunResult result_;
  absl::Mutex mutex_;
  // Index of the last scan fed.
  size_t now_ ABSL_GUARDED_BY(mutex_) = 0;
  std::vector<LocalizationMoment> localizations_ ABSL_GUARDED_BY(mutex_);
  // Last, because its threads use the other members until it is destroyed.
  const std::unique_ptr<mapping::MapBuilderInterface> map_builder_;
  LiveMapBuilder* const live_;
};

absl::Status CheckWritable(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return absl::InvalidArgumentError(
        absl::StrCat("cannot write ", path, ": it is a directory"));
  }
  const std::filesystem::path parent =
      std::filesystem::absolute(path, ignored).parent_path();
  if (!std::filesystem::is_directory(parent, ignored)) {
    return absl::NotFoundError(absl::StrCat(
        "cannot write ", path, ": there is no directory ", parent.string()));
  }
  return absl::OkStatus();
}

// The host's reader requires every key of the returned table to be used. Drops
// keys that belong to ROS, but keeps the check of the two tables and the line
// numbers in messages.
std::string OnlyWhatIsUsed(const std::string& code) {
  return absl::StrCat("local function file() ", code,
                      "\nend\nlocal options = file()\nreturn {\n"
                      "map_builder = options.map_builder,\n"
                      "trajectory_builder = options.trajectory_builder }\n");
}

}  // namespace

absl::StatusOr<HostOptions> LoadHostOptions(
    const std::vector<std::string>& directories, const std::string& basename) {
  auto resolver =
      std::make_unique<cartographer::common::ConfigurationFileResolver>(
          directories);
  const std::string code = resolver->GetFileContentOrDie(basename);
  cartographer::common::LuaParameterDictionary dictionary(OnlyWhatIsUsed(code),
                                                          std::move(resolver));
  HostOptions options;
  options.map_builder = mapping::CreateMapBuilderOptions(
      dictionary.GetDictionary("map_builder").get());
  options.trajectory_builder = mapping::CreateTrajectoryBuilderOptions(
      dictionary.GetDictionary("trajectory_builder").get());
  if (!options.map_builder.use_trajectory_builder_2d()) {
    return absl::InvalidArgumentError(
        absl::StrCat(basename,
                     ": MAP_BUILDER.use_trajectory_builder_2d is not "
                     "true, and 3D is not supported"));
  }
  return options;
}

double FromHostTime(const Time time) {
  return static_cast<double>(
             cartographer::common::ToUniversal(time) -
             cartographer::common::kUtsEpochOffsetFromUnixEpochInSeconds *
                 10000000ll) *
         1e-7;
}

std::string Validate(const LogRunOptions& options) {
  if (options.real_time_factor.has_value() &&
      !(*options.real_time_factor > 0. && *options.real_time_factor <= 1e6)) {
    return "real_time_factor must be positive and at most 1e6";
  }
  return Validate(options.live);
}

absl::StatusOr<LogRunResult> RunLog(
    const Recording& recording, const LogRunOptions& options,
    const std::function<void(double)>& on_progress) {
  if (const std::string problem = Validate(options); !problem.empty()) {
    return absl::InvalidArgumentError(problem);
  }
  if (recording.scans.size() < 2) {
    return absl::InvalidArgumentError(absl::StrCat(
        "a recording of ", recording.scans.size(), " scans is too short"));
  }
  if (options.output_path.has_value()) {
    const absl::Status status = CheckWritable(*options.output_path);
    if (!status.ok()) return status;
  }
  // Outlives the run, whose destructor prints too.
  const SilentStandardOutput silent;
  Run run(recording, options);
  absl::Status status = run.LoadMap();
  if (!status.ok()) return status;
  // The host could not load a map with a trajectory that has no nodes.
  if (!run.Drive(on_progress)) {
    return absl::InvalidArgumentError(
        "Cartographer made no nodes from the recording: no beam has a range "
        "that it accepts");
  }
  run.Finish();
  LogRunResult result = run.TakeResult();
  status = run.WriteMap();
  if (!status.ok()) return status;
  return result;
}

}  // namespace cartographer_sdf
