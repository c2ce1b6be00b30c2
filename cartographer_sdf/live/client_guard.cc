// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/client_guard.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "cartographer/io/proto_stream.h"
#include "cartographer/mapping/proto/serialization.pb.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

namespace common = cartographer::common;
namespace io = cartographer::io;
namespace mapping = cartographer::mapping;
namespace sensor = cartographer::sensor;
using SensorId = mapping::TrajectoryBuilderInterface::SensorId;
using SensorType = SensorId::SensorType;

// Of messages that may come with every scan.
constexpr int kLogEveryN = 1000;
constexpr double kMinAcceleration = 1e-3;  // [m/s^2]: otherwise not a direction

bool IsSound(const sensor::TimedPointCloudData& data) {
  if (!data.origin.allFinite()) return false;
  if (!data.intensities.empty() &&
      data.intensities.size() != data.ranges.size()) {
    return false;
  }
  // Times count back from that of the scan.
  return std::all_of(data.ranges.begin(), data.ranges.end(),
                     [](const sensor::TimedRangefinderPoint& point) {
                       return point.position.allFinite() && point.time <= 0.f;
                     });
}

bool IsSound(const sensor::ImuData& data) {
  return data.angular_velocity.allFinite() &&
         data.linear_acceleration.allFinite() &&
         data.linear_acceleration.norm() > kMinAcceleration;
}

bool IsSound(const sensor::OdometryData& data) { return data.pose.IsValid(); }

bool IsSound(const sensor::FixedFramePoseData& data) {
  return !data.pose || data.pose->IsValid();
}

bool IsSound(const sensor::LandmarkData& data) {
  return std::all_of(
      data.landmark_observations.begin(), data.landmark_observations.end(),
      [](const sensor::LandmarkObservation& observation) {
        return observation.landmark_to_tracking_transform.IsValid() &&
               observation.translation_weight >= 0. &&
               observation.rotation_weight >= 0.;
      });
}

// A state that arrives as a stream, as a file: the stream may have ended early.
class ReceivedState {
 public:
  explicit ReceivedState(io::ProtoStreamReaderInterface* const reader) {
    std::string directory =
        (std::filesystem::temp_directory_path() / "cartographer_sdf-XXXXXX")
            .string();
    if (mkdtemp(directory.data()) == nullptr) return;
    directory_ = directory;
    io::ProtoStreamWriter writer(path());
    mapping::proto::SerializationHeader header;
    if (reader->ReadProto(&header)) writer.WriteProto(header);
    mapping::proto::SerializedData data;
    while (reader->ReadProto(&data)) writer.WriteProto(data);
    writer.Close();
  }
  ~ReceivedState() {
    std::error_code ignored;
    if (!directory_.empty()) std::filesystem::remove_all(directory_, ignored);
  }
  ReceivedState(const ReceivedState&) = delete;
  ReceivedState& operator=(const ReceivedState&) = delete;

  // Of no file, where it could not be written.
  [[nodiscard]] std::string path() const {
    return directory_ + "/state.pbstream";
  }

 private:
  std::string directory_;
};

bool IsMap(const std::string& path) {
  const absl::StatusOr<MapState> map = ReadMap(path);
  if (!map.ok()) LOG(WARNING) << "not loaded: " << map.status().message();
  return map.ok();
}

class GuardedTrajectoryBuilder : public mapping::TrajectoryBuilderInterface {
 public:
  // `mutex` is held while the host gets data.
  GuardedTrajectoryBuilder(mapping::TrajectoryBuilderInterface* const host,
                           const std::set<SensorId>& sensor_ids,
                           absl::Mutex* const mutex)
      : host_(host), sensor_ids_(sensor_ids), mutex_(mutex) {}

  void AddSensorData(const std::string& sensor_id,
                     const sensor::TimedPointCloudData& data) override {
    Pass(SensorType::RANGE, sensor_id, data);
  }
  void AddSensorData(const std::string& sensor_id,
                     const sensor::ImuData& data) override {
    Pass(SensorType::IMU, sensor_id, data);
  }
  void AddSensorData(const std::string& sensor_id,
                     const sensor::OdometryData& data) override {
    Pass(SensorType::ODOMETRY, sensor_id, data);
  }
  void AddSensorData(const std::string& sensor_id,
                     const sensor::FixedFramePoseData& data) override {
    Pass(SensorType::FIXED_FRAME_POSE, sensor_id, data);
  }
  void AddSensorData(const std::string& sensor_id,
                     const sensor::LandmarkData& data) override {
    Pass(SensorType::LANDMARK, sensor_id, data);
  }
  // Dropped: they are for trajectories without local SLAM of their own.
  void AddLocalSlamResultData(
      std::unique_ptr<mapping::LocalSlamResultData> /*data*/) override {
    LOG(WARNING) << "a result of another local SLAM is dropped";
  }

 private:
  template <typename Data>
  void Pass(const SensorType type, const std::string& sensor_id,
            const Data& data) {
    const absl::MutexLock lock(mutex_);
    if (sensor_ids_.count({type, sensor_id}) > 0 && IsSound(data)) {
      common::Time& newest =
          newest_.emplace(sensor_id, common::Time::min()).first->second;
      if (data.time > newest) {
        newest = data.time;
        host_->AddSensorData(sensor_id, data);
        return;
      }
    }
    LOG_EVERY_N(WARNING, kLogEveryN)
        << "data of sensor " << sensor_id << " at " << data.time
        << " are unexpected, out of order or not numbers, and dropped";
  }

  mapping::TrajectoryBuilderInterface* const host_;
  const std::set<SensorId> sensor_ids_;
  absl::Mutex* const mutex_;
  std::map<std::string, common::Time> newest_ ABSL_GUARDED_BY(*mutex_);
};

class GuardedMapBuilder : public mapping::MapBuilderInterface {
 public:
  explicit GuardedMapBuilder(std::unique_ptr<mapping::MapBuilderInterface> host)
      : host_(std::move(host)) {}

  int AddTrajectoryBuilder(
      const std::set<SensorId>& expected_sensor_ids,
      const mapping::proto::TrajectoryBuilderOptions& options,
      LocalSlamResultCallback callback) override {
    mapping::proto::TrajectoryBuilderOptions sound = options;
    if (options.has_initial_trajectory_pose()) {
      const int other = options.initial_trajectory_pose().to_trajectory_id();
      const auto nodes = host_->pose_graph()->GetTrajectoryNodePoses();
      if (nodes.SizeOfTrajectoryOrZero(other) == 0) {
        LOG(WARNING) << "an initial pose relative to trajectory " << other
                     << ", which has no nodes, is dropped";
        sound.clear_initial_trajectory_pose();
      }
    }
    const absl::MutexLock host_lock(&host_mutex_);
    const int id = host_->AddTrajectoryBuilder(expected_sensor_ids, sound,
                                               std::move(callback));
    const absl::MutexLock lock(&mutex_);
    if (options.has_trajectory_builder_2d_options() ||
        options.has_trajectory_builder_3d_options()) {
      builders_[id] = std::make_unique<GuardedTrajectoryBuilder>(
          host_->GetTrajectoryBuilder(id), expected_sensor_ids, &host_mutex_);
    }
    active_.insert(id);
    return id;
  }
  mapping::TrajectoryBuilderInterface* GetTrajectoryBuilder(
      const int trajectory_id) const override {
    const absl::MutexLock lock(&mutex_);
    const auto found = builders_.find(trajectory_id);
    if (found != builders_.end()) return found->second.get();
    // It has no local SLAM, or was loaded, or is none.
    const bool is_known =
        trajectory_id >= 0 && trajectory_id < host_->num_trajectory_builders();
    return is_known ? host_->GetTrajectoryBuilder(trajectory_id) : nullptr;
  }
  void FinishTrajectory(const int trajectory_id) override {
    {
      const absl::MutexLock lock(&mutex_);
      if (active_.erase(trajectory_id) == 0) {
        LOG(WARNING) << "trajectory " << trajectory_id
                     << ", which is not active, cannot be finished";
        return;
      }
    }
    const absl::MutexLock lock(&host_mutex_);
    host_->FinishTrajectory(trajectory_id);
  }
  std::map<int, int> LoadStateFromFile(const std::string& filename,
                                       const bool load_frozen_state) override {
    if (!IsMap(filename)) return {};
    const absl::MutexLock lock(&host_mutex_);
    return host_->LoadStateFromFile(filename, load_frozen_state);
  }
  std::map<int, int> LoadState(io::ProtoStreamReaderInterface* const reader,
                               const bool load_frozen_state) override {
    const ReceivedState received(reader);
    if (!IsMap(received.path())) return {};
    io::ProtoStreamReader complete(received.path());
    const absl::MutexLock lock(&host_mutex_);
    return host_->LoadState(&complete, load_frozen_state);
  }

  // Forwarded.
  int AddTrajectoryForDeserialization(
      const mapping::proto::TrajectoryBuilderOptionsWithSensorIds& options)
      override {
    return host_->AddTrajectoryForDeserialization(options);
  }
  std::string SubmapToProto(
      const mapping::SubmapId& submap_id,
      mapping::proto::SubmapQuery::Response* const response) override {
    return host_->SubmapToProto(submap_id, response);
  }
  void SerializeState(const bool include_unfinished_submaps,
                      io::ProtoStreamWriterInterface* const writer) override {
    host_->SerializeState(include_unfinished_submaps, writer);
  }
  bool SerializeStateToFile(const bool include_unfinished_submaps,
                            const std::string& filename) override {
    return host_->SerializeStateToFile(include_unfinished_submaps, filename);
  }
  int num_trajectory_builders() const override {
    return host_->num_trajectory_builders();
  }
  mapping::PoseGraphInterface* pose_graph() override {
    return host_->pose_graph();
  }
  const std::vector<mapping::proto::TrajectoryBuilderOptionsWithSensorIds>&
  GetAllTrajectoryBuilderOptions() const override {
    return host_->GetAllTrajectoryBuilderOptions();
  }

 private:
  const std::unique_ptr<mapping::MapBuilderInterface> host_;
  // Cartographer's map builder takes sensor data and trajectories of one thread
  // at a time. Taken before the other one.
  absl::Mutex host_mutex_;
  mutable absl::Mutex mutex_;
  std::map<int, std::unique_ptr<GuardedTrajectoryBuilder>> builders_
      ABSL_GUARDED_BY(mutex_);
  std::set<int> active_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace

std::unique_ptr<mapping::MapBuilderInterface> GuardAgainstClients(
    std::unique_ptr<mapping::MapBuilderInterface> host) {
  return std::make_unique<GuardedMapBuilder>(std::move(host));
}

}  // namespace cartographer_sdf
