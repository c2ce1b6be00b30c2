// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/map_builder.h"

#include <utility>

#include "cartographer_sdf/live/guarded_pose_graph.h"
#include "cartographer_sdf/live/searcher.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

namespace mapping = cartographer::mapping;

class SearchingMapBuilder : public LiveMapBuilder {
 public:
  SearchingMapBuilder(std::unique_ptr<mapping::MapBuilderInterface> host,
                      const LiveOptions& options,
                      LocalizationCallback on_localization)
      : host_(std::move(host)) {
    auto* const pose_graph =
        dynamic_cast<mapping::PoseGraph*>(host_->pose_graph());
    searcher_ = std::make_shared<Searcher>(options, pose_graph,
                                           std::move(on_localization));
    if (pose_graph == nullptr) {
      LOG(WARNING) << "the pose graph is a remote one, to which no constraints "
                      "can be added: what is found is only logged";
      return;
    }
    guarded_pose_graph_ =
        std::make_unique<GuardedPoseGraph>(pose_graph, searcher_.get());
    // Adds the first hook.
    const Searcher::Announcement announcement(searcher_.get());
  }

  ~SearchingMapBuilder() override {
    searcher_->Shutdown();
    // The pose graph does what is left to do, and calls hooks, which own the
    // searcher too.
    host_.reset();
  }

  int AddTrajectoryBuilder(
      const std::set<SensorId>& expected_sensor_ids,
      const mapping::proto::TrajectoryBuilderOptions& trajectory_options,
      LocalSlamResultCallback local_slam_result_callback) override {
    auto callback =
        [searcher = searcher_, forward = std::move(local_slam_result_callback)](
            const int trajectory_id, const cartographer::common::Time time,
            const cartographer::transform::Rigid3d local_pose,
            cartographer::sensor::RangeData range_data_in_local,
            std::unique_ptr<
                const mapping::TrajectoryBuilderInterface::InsertionResult>
                insertion_result) {
          searcher->OnLocalSlamResult(trajectory_id, range_data_in_local,
                                      insertion_result.get());
          if (forward) {
            forward(trajectory_id, time, local_pose,
                    std::move(range_data_in_local),
                    std::move(insertion_result));
          }
        };
    const bool is_trimmed = trajectory_options.has_pure_localization_trimmer();
    int trajectory_id;
    {
      // Trimmers are added, perhaps.
      const Searcher::Announcement announcement(searcher_.get());
      trajectory_id = host_->AddTrajectoryBuilder(
          expected_sensor_ids, trajectory_options, std::move(callback));
    }
    searcher_->AddTrajectory(trajectory_id,
                             trajectory_options.has_initial_trajectory_pose(),
                             is_trimmed);
    return trajectory_id;
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
    searcher_->FinishTrajectory(trajectory_id, [this, trajectory_id] {
      host_->FinishTrajectory(trajectory_id);
    });
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
    std::map<int, int> trajectory_ids;
    {
      const Searcher::Announcement announcement(searcher_.get());
      trajectory_ids = host_->LoadState(reader, load_frozen_state);
    }
    searcher_->OnStateLoaded(trajectory_ids, load_frozen_state, "");
    return trajectory_ids;
  }
  std::map<int, int> LoadStateFromFile(const std::string& filename,
                                       const bool load_frozen_state) override {
    std::map<int, int> trajectory_ids;
    {
      const Searcher::Announcement announcement(searcher_.get());
      trajectory_ids = host_->LoadStateFromFile(filename, load_frozen_state);
    }
    searcher_->OnStateLoaded(trajectory_ids, load_frozen_state, filename);
    return trajectory_ids;
  }
  int num_trajectory_builders() const override {
    return host_->num_trajectory_builders();
  }
  mapping::PoseGraphInterface* pose_graph() override {
    if (guarded_pose_graph_ != nullptr) return guarded_pose_graph_.get();
    return host_->pose_graph();
  }
  const std::vector<mapping::proto::TrajectoryBuilderOptionsWithSensorIds>&
  GetAllTrajectoryBuilderOptions() const override {
    return host_->GetAllTrajectoryBuilderOptions();
  }

  std::optional<LocalizationResult> GetLocalization(
      const int trajectory_id) const override {
    return searcher_->GetLocalization(trajectory_id);
  }
  void Localize(const int trajectory_id) override {
    searcher_->Localize(trajectory_id);
  }
  void WaitUntilIdle() override { searcher_->WaitUntilIdle(); }
  LiveSummary GetSummary() const override { return searcher_->GetSummary(); }
  std::vector<ClosureRecord> GetClosures() const override {
    return searcher_->GetClosures();
  }

 private:
  std::shared_ptr<Searcher> searcher_;
  std::unique_ptr<mapping::MapBuilderInterface> host_;
  // Null where the pose graph is remote.
  std::unique_ptr<GuardedPoseGraph> guarded_pose_graph_;
};

}  // namespace

std::unique_ptr<mapping::MapBuilderInterface> CreateMapBuilder(
    std::unique_ptr<mapping::MapBuilderInterface> host,
    const LiveOptions& options, LocalizationCallback on_localization) {
  CHECK_EQ(Validate(options), "");
  if (!options.enabled) return host;
  return std::make_unique<SearchingMapBuilder>(std::move(host), options,
                                               std::move(on_localization));
}

LiveMapBuilder* AsLiveMapBuilder(
    mapping::MapBuilderInterface* const map_builder) {
  return dynamic_cast<LiveMapBuilder*>(map_builder);
}

}  // namespace cartographer_sdf
