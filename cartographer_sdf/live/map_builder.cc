// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/map_builder.h"

#include <utility>

#include "cartographer_sdf/live/searcher.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

namespace mapping = cartographer::mapping;
namespace sensor = cartographer::sensor;
namespace transform = cartographer::transform;

// The host's pose graph as users see it: forwards every call, and first
// announces those that may remove submaps or nodes.
class GuardedPoseGraph : public mapping::PoseGraph {
 public:
  // Owns neither; both must outlive this.
  GuardedPoseGraph(mapping::PoseGraph* host, Searcher* searcher)
      : host_(host), searcher_(searcher) {}

  // Announced.
  void RunFinalOptimization() override { searcher_->RunFinalOptimization(); }
  void DeleteTrajectory(const int trajectory_id) override {
    searcher_->ForgetTrajectory(trajectory_id);
    host_->DeleteTrajectory(trajectory_id);
  }
  void FinishTrajectory(const int trajectory_id) override {
    searcher_->FinishTrajectory(trajectory_id, [this, trajectory_id] {
      host_->FinishTrajectory(trajectory_id);
    });
  }
  void AddTrimmer(std::unique_ptr<mapping::PoseGraphTrimmer> trimmer) override {
    const Searcher::Announcement announcement(searcher_);
    host_->AddTrimmer(std::move(trimmer));
  }

  // Forwarded.
  mapping::MapById<mapping::SubmapId, SubmapData> GetAllSubmapData()
      const override {
    return host_->GetAllSubmapData();
  }
  SubmapData GetSubmapData(const mapping::SubmapId& submap_id) const override {
    return host_->GetSubmapData(submap_id);
  }
  mapping::MapById<mapping::SubmapId, SubmapPose> GetAllSubmapPoses()
      const override {
    return host_->GetAllSubmapPoses();
  }
  transform::Rigid3d GetLocalToGlobalTransform(
      const int trajectory_id) const override {
    return host_->GetLocalToGlobalTransform(trajectory_id);
  }
  mapping::MapById<mapping::NodeId, mapping::TrajectoryNode>
  GetTrajectoryNodes() const override {
    return host_->GetTrajectoryNodes();
  }
  mapping::MapById<mapping::NodeId, mapping::TrajectoryNodePose>
  GetTrajectoryNodePoses() const override {
    return host_->GetTrajectoryNodePoses();
  }
  std::map<int, TrajectoryState> GetTrajectoryStates() const override {
    return host_->GetTrajectoryStates();
  }
  std::map<std::string, transform::Rigid3d> GetLandmarkPoses() const override {
    return host_->GetLandmarkPoses();
  }
  void SetLandmarkPose(const std::string& landmark_id,
                       const transform::Rigid3d& global_pose,
                       const bool frozen) override {
    host_->SetLandmarkPose(landmark_id, global_pose, frozen);
  }
  bool IsTrajectoryFinished(const int trajectory_id) const override {
    return host_->IsTrajectoryFinished(trajectory_id);
  }
  bool IsTrajectoryFrozen(const int trajectory_id) const override {
    return host_->IsTrajectoryFrozen(trajectory_id);
  }
  std::map<int, TrajectoryData> GetTrajectoryData() const override {
    return host_->GetTrajectoryData();
  }
  std::vector<Constraint> constraints() const override {
    return host_->constraints();
  }
  mapping::proto::PoseGraph ToProto(
      const bool include_unfinished_submaps) const override {
    return host_->ToProto(include_unfinished_submaps);
  }
  void SetGlobalSlamOptimizationCallback(
      GlobalSlamOptimizationCallback callback) override {
    host_->SetGlobalSlamOptimizationCallback(std::move(callback));
  }
  void AddImuData(const int trajectory_id,
                  const sensor::ImuData& imu_data) override {
    host_->AddImuData(trajectory_id, imu_data);
  }
  void AddOdometryData(const int trajectory_id,
                       const sensor::OdometryData& odometry_data) override {
    host_->AddOdometryData(trajectory_id, odometry_data);
  }
  void AddFixedFramePoseData(const int trajectory_id,
                             const sensor::FixedFramePoseData& data) override {
    host_->AddFixedFramePoseData(trajectory_id, data);
  }
  void AddLandmarkData(const int trajectory_id,
                       const sensor::LandmarkData& landmark_data) override {
    host_->AddLandmarkData(trajectory_id, landmark_data);
  }
  void FreezeTrajectory(const int trajectory_id) override {
    host_->FreezeTrajectory(trajectory_id);
  }
  void AddSubmapFromProto(const transform::Rigid3d& global_pose,
                          const mapping::proto::Submap& submap) override {
    host_->AddSubmapFromProto(global_pose, submap);
  }
  void AddNodeFromProto(const transform::Rigid3d& global_pose,
                        const mapping::proto::Node& node) override {
    host_->AddNodeFromProto(global_pose, node);
  }
  void SetTrajectoryDataFromProto(
      const mapping::proto::TrajectoryData& data) override {
    host_->SetTrajectoryDataFromProto(data);
  }
  void AddNodeToSubmap(const mapping::NodeId& node_id,
                       const mapping::SubmapId& submap_id) override {
    host_->AddNodeToSubmap(node_id, submap_id);
  }
  void AddSerializedConstraints(
      const std::vector<Constraint>& constraints) override {
    host_->AddSerializedConstraints(constraints);
  }
  std::vector<std::vector<int>> GetConnectedTrajectories() const override {
    return host_->GetConnectedTrajectories();
  }
  sensor::MapByTime<sensor::ImuData> GetImuData() const override {
    return host_->GetImuData();
  }
  sensor::MapByTime<sensor::OdometryData> GetOdometryData() const override {
    return host_->GetOdometryData();
  }
  sensor::MapByTime<sensor::FixedFramePoseData> GetFixedFramePoseData()
      const override {
    return host_->GetFixedFramePoseData();
  }
  std::map<std::string, LandmarkNode> GetLandmarkNodes() const override {
    return host_->GetLandmarkNodes();
  }
  void SetInitialTrajectoryPose(
      const int from_trajectory_id, const int to_trajectory_id,
      const transform::Rigid3d& pose,
      const cartographer::common::Time time) override {
    host_->SetInitialTrajectoryPose(from_trajectory_id, to_trajectory_id, pose,
                                    time);
  }

 private:
  mapping::PoseGraph* const host_;
  Searcher* const searcher_;
};

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
      LOG(WARNING) << "the pose graph is remote, so constraints cannot be "
                      "added: closures are only logged";
      return;
    }
    guarded_pose_graph_ =
        std::make_unique<GuardedPoseGraph>(pose_graph, searcher_.get());
    // Adds the first hook.
    const Searcher::Announcement announcement(searcher_.get());
  }

  ~SearchingMapBuilder() override {
    searcher_->Shutdown();
    // The pose graph finishes its queue and calls hooks, which share ownership
    // of the searcher.
    host_.reset();
  }

  int AddTrajectoryBuilder(
      const std::set<SensorId>& expected_sensor_ids,
      const mapping::proto::TrajectoryBuilderOptions& trajectory_options,
      LocalSlamResultCallback local_slam_result_callback) override {
    auto callback =
        [searcher = searcher_, forward = std::move(local_slam_result_callback)](
            const int trajectory_id, const cartographer::common::Time time,
            const transform::Rigid3d& local_pose,
            sensor::RangeData range_data_in_local,
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
      // May add trimmers.
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
    return Load(load_frozen_state, "",
                [&] { return host_->LoadState(reader, load_frozen_state); });
  }
  std::map<int, int> LoadStateFromFile(const std::string& filename,
                                       const bool load_frozen_state) override {
    return Load(load_frozen_state, filename, [&] {
      return host_->LoadStateFromFile(filename, load_frozen_state);
    });
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
  std::optional<StartPose> GetStartPose(
      const int trajectory_id) const override {
    return searcher_->GetStartPose(trajectory_id);
  }
  void WaitUntilIdle() override { searcher_->WaitUntilIdle(); }
  LiveSummary GetSummary() const override { return searcher_->GetSummary(); }
  std::vector<ClosureRecord> GetClosures() const override {
    return searcher_->GetClosures();
  }
  std::vector<RefusedMatch> GetRefusedMatches() const override {
    return searcher_->GetRefusedMatches();
  }

 private:
  std::map<int, int> Load(const bool is_frozen, const std::string& path,
                          const std::function<std::map<int, int>()>& load) {
    std::map<int, int> trajectory_ids;
    {
      const Searcher::Announcement announcement(searcher_.get());
      trajectory_ids = load();
    }
    searcher_->OnStateLoaded(trajectory_ids, is_frozen, path);
    return trajectory_ids;
  }

  std::shared_ptr<Searcher> searcher_;
  std::unique_ptr<mapping::MapBuilderInterface> host_;
  // Null if the pose graph is remote.
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
