// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/map_builder.h"

#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

namespace mapping = cartographer::mapping;

class ForwardingMapBuilder : public LiveMapBuilder {
 public:
  explicit ForwardingMapBuilder(
      std::unique_ptr<mapping::MapBuilderInterface> host)
      : host_(std::move(host)) {}

  int AddTrajectoryBuilder(
      const std::set<SensorId>& expected_sensor_ids,
      const mapping::proto::TrajectoryBuilderOptions& trajectory_options,
      LocalSlamResultCallback local_slam_result_callback) override {
    return host_->AddTrajectoryBuilder(expected_sensor_ids, trajectory_options,
                                       std::move(local_slam_result_callback));
  }
  int AddTrajectoryForDeserialization(
      const mapping::proto::TrajectoryBuilderOptionsWithSensorIds& options)
      override {
    return host_->AddTrajectoryForDeserialization(options);
  }
  mapping::TrajectoryBuilderInterface* GetTrajectoryBuilder(
      const int trajectory_id) const override {
    return host_->GetTrajectoryBuilder(trajectory_id);
  }
  void FinishTrajectory(const int trajectory_id) override {
    host_->FinishTrajectory(trajectory_id);
  }
  std::string SubmapToProto(
      const mapping::SubmapId& submap_id,
      mapping::proto::SubmapQuery::Response* const response) override {
    return host_->SubmapToProto(submap_id, response);
  }
  void SerializeState(
      const bool include_unfinished_submaps,
      cartographer::io::ProtoStreamWriterInterface* const writer) override {
    host_->SerializeState(include_unfinished_submaps, writer);
  }
  bool SerializeStateToFile(const bool include_unfinished_submaps,
                            const std::string& filename) override {
    return host_->SerializeStateToFile(include_unfinished_submaps, filename);
  }
  std::map<int, int> LoadState(
      cartographer::io::ProtoStreamReaderInterface* const reader,
      const bool load_frozen_state) override {
    return host_->LoadState(reader, load_frozen_state);
  }
  std::map<int, int> LoadStateFromFile(const std::string& filename,
                                       const bool load_frozen_state) override {
    return host_->LoadStateFromFile(filename, load_frozen_state);
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

  std::optional<LocalizationResult> GetLocalization(int) const override {
    return std::nullopt;
  }
  void Localize(int) override {}
  void WaitUntilIdle() override {}
  LiveSummary GetSummary() const override { return {}; }
  std::vector<ClosureRecord> GetClosures() const override { return {}; }

 private:
  const std::unique_ptr<mapping::MapBuilderInterface> host_;
};

}  // namespace

const char* LocalizationReasonName(const LocalizationReason reason) {
  switch (reason) {
    case LocalizationReason::kLocated:
      return "located";
    case LocalizationReason::kNoMap:
      return "no_map";
    case LocalizationReason::kNotEnoughSeen:
      return "not_enough_seen";
    case LocalizationReason::kNoMatch:
      return "no_match";
    case LocalizationReason::kAmbiguous:
      return "ambiguous";
    case LocalizationReason::kUncertain:
      return "uncertain";
    case LocalizationReason::kFinished:
      return "finished";
  }
  LOG(FATAL) << static_cast<int>(reason);
}

const char* ClosureFateName(const ClosureFate fate) {
  switch (fate) {
    case ClosureFate::kPending:
      return "pending";
    case ClosureFate::kContradicted:
      return "contradicted";
    case ClosureFate::kScansDisagree:
      return "scans_disagree";
    case ClosureFate::kReady:
      return "ready";
    case ClosureFate::kInjected:
      return "injected";
    case ClosureFate::kDetectedOnly:
      return "detected_only";
    case ClosureFate::kGone:
      return "gone";
  }
  LOG(FATAL) << static_cast<int>(fate);
}

std::unique_ptr<mapping::MapBuilderInterface> CreateMapBuilder(
    std::unique_ptr<mapping::MapBuilderInterface> host,
    const LiveOptions& options, LocalizationCallback) {
  CHECK_EQ(Validate(options), "");
  if (!options.enabled) return host;
  return std::make_unique<ForwardingMapBuilder>(std::move(host));
}

LiveMapBuilder* AsLiveMapBuilder(
    mapping::MapBuilderInterface* const map_builder) {
  return dynamic_cast<LiveMapBuilder*>(map_builder);
}

void RegisterMetrics(cartographer::metrics::FamilyFactory*) {}

}  // namespace cartographer_sdf
