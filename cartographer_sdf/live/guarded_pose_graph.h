// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The host's pose graph as our users get it: everything is forwarded, and what
// may take submaps or nodes away is announced before.

#ifndef CARTOGRAPHER_SDF_LIVE_GUARDED_POSE_GRAPH_H_
#define CARTOGRAPHER_SDF_LIVE_GUARDED_POSE_GRAPH_H_

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cartographer/mapping/pose_graph.h"
#include "cartographer_sdf/live/searcher.h"

namespace cartographer_sdf {

class GuardedPoseGraph : public cartographer::mapping::PoseGraph {
 public:
  // Neither is owned; both outlive this.
  GuardedPoseGraph(cartographer::mapping::PoseGraph* host, Searcher* searcher)
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
  void AddTrimmer(std::unique_ptr<cartographer::mapping::PoseGraphTrimmer>
                      trimmer) override {
    const Searcher::Announcement announcement(searcher_);
    host_->AddTrimmer(std::move(trimmer));
  }

  // Forwarded.
  cartographer::mapping::MapById<cartographer::mapping::SubmapId, SubmapData>
  GetAllSubmapData() const override {
    return host_->GetAllSubmapData();
  }
  SubmapData GetSubmapData(
      const cartographer::mapping::SubmapId& submap_id) const override {
    return host_->GetSubmapData(submap_id);
  }
  cartographer::mapping::MapById<cartographer::mapping::SubmapId, SubmapPose>
  GetAllSubmapPoses() const override {
    return host_->GetAllSubmapPoses();
  }
  cartographer::transform::Rigid3d GetLocalToGlobalTransform(
      const int trajectory_id) const override {
    return host_->GetLocalToGlobalTransform(trajectory_id);
  }
  cartographer::mapping::MapById<cartographer::mapping::NodeId,
                                 cartographer::mapping::TrajectoryNode>
  GetTrajectoryNodes() const override {
    return host_->GetTrajectoryNodes();
  }
  cartographer::mapping::MapById<cartographer::mapping::NodeId,
                                 cartographer::mapping::TrajectoryNodePose>
  GetTrajectoryNodePoses() const override {
    return host_->GetTrajectoryNodePoses();
  }
  std::map<int, TrajectoryState> GetTrajectoryStates() const override {
    return host_->GetTrajectoryStates();
  }
  std::map<std::string, cartographer::transform::Rigid3d> GetLandmarkPoses()
      const override {
    return host_->GetLandmarkPoses();
  }
  void SetLandmarkPose(const std::string& landmark_id,
                       const cartographer::transform::Rigid3d& global_pose,
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
  cartographer::mapping::proto::PoseGraph ToProto(
      const bool include_unfinished_submaps) const override {
    return host_->ToProto(include_unfinished_submaps);
  }
  void SetGlobalSlamOptimizationCallback(
      GlobalSlamOptimizationCallback callback) override {
    host_->SetGlobalSlamOptimizationCallback(std::move(callback));
  }
  void AddImuData(const int trajectory_id,
                  const cartographer::sensor::ImuData& imu_data) override {
    host_->AddImuData(trajectory_id, imu_data);
  }
  void AddOdometryData(
      const int trajectory_id,
      const cartographer::sensor::OdometryData& odometry_data) override {
    host_->AddOdometryData(trajectory_id, odometry_data);
  }
  void AddFixedFramePoseData(
      const int trajectory_id,
      const cartographer::sensor::FixedFramePoseData& data) override {
    host_->AddFixedFramePoseData(trajectory_id, data);
  }
  void AddLandmarkData(
      const int trajectory_id,
      const cartographer::sensor::LandmarkData& landmark_data) override {
    host_->AddLandmarkData(trajectory_id, landmark_data);
  }
  void FreezeTrajectory(const int trajectory_id) override {
    host_->FreezeTrajectory(trajectory_id);
  }
  void AddSubmapFromProto(
      const cartographer::transform::Rigid3d& global_pose,
      const cartographer::mapping::proto::Submap& submap) override {
    host_->AddSubmapFromProto(global_pose, submap);
  }
  void AddNodeFromProto(
      const cartographer::transform::Rigid3d& global_pose,
      const cartographer::mapping::proto::Node& node) override {
    host_->AddNodeFromProto(global_pose, node);
  }
  void SetTrajectoryDataFromProto(
      const cartographer::mapping::proto::TrajectoryData& data) override {
    host_->SetTrajectoryDataFromProto(data);
  }
  void AddNodeToSubmap(
      const cartographer::mapping::NodeId& node_id,
      const cartographer::mapping::SubmapId& submap_id) override {
    host_->AddNodeToSubmap(node_id, submap_id);
  }
  void AddSerializedConstraints(
      const std::vector<Constraint>& constraints) override {
    host_->AddSerializedConstraints(constraints);
  }
  std::vector<std::vector<int>> GetConnectedTrajectories() const override {
    return host_->GetConnectedTrajectories();
  }
  cartographer::sensor::MapByTime<cartographer::sensor::ImuData> GetImuData()
      const override {
    return host_->GetImuData();
  }
  cartographer::sensor::MapByTime<cartographer::sensor::OdometryData>
  GetOdometryData() const override {
    return host_->GetOdometryData();
  }
  cartographer::sensor::MapByTime<cartographer::sensor::FixedFramePoseData>
  GetFixedFramePoseData() const override {
    return host_->GetFixedFramePoseData();
  }
  std::map<std::string, LandmarkNode> GetLandmarkNodes() const override {
    return host_->GetLandmarkNodes();
  }
  void SetInitialTrajectoryPose(
      const int from_trajectory_id, const int to_trajectory_id,
      const cartographer::transform::Rigid3d& pose,
      const cartographer::common::Time time) override {
    host_->SetInitialTrajectoryPose(from_trajectory_id, to_trajectory_id, pose,
                                    time);
  }

 private:
  cartographer::mapping::PoseGraph* const host_;
  Searcher* const searcher_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_GUARDED_POSE_GRAPH_H_
