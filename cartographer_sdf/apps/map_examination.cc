// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/map_examination.h"

#include <algorithm>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/closing/torn_submaps.h"
#include "cartographer_sdf/recognition/trajectory_links.h"
#include "cartographer_sdf/verification/agreement.h"

namespace cartographer_sdf {
namespace {

// The pairs of places that the links of a trajectory connect, as local SLAM
// placed them.
std::vector<PlacePair> LinkedPairs(const int index_step,
                                   const DescribedMap& map) {
  std::vector<PlacePair> pairs;
  for (const auto& [id, place] : map.places) {
    const auto next = map.places.find({id.trajectory, id.index + index_step});
    if (next == map.places.end()) continue;
    const PlacePair pair = {&place, &next->second,
                            map.odometry.at(id).T_local_submap.Inverse() *
                                map.odometry.at(next->first).T_local_submap};
    if (OverlapsEnough(place.surface, next->second.surface,
                       pair.T_reference_query)) {
      pairs.push_back(pair);
    }
  }
  return pairs;
}

bool HasClosures(const PoseGraph& pose_graph) {
  return std::any_of(pose_graph.constraints.begin(),
                     pose_graph.constraints.end(),
                     [](const Constraint& constraint) {
                       return constraint.tag == Constraint::Tag::kInterSubmap;
                     });
}

// Whether verification would accept the place in another pose of itself.
bool ResemblesItself(const VerificationOptions& options,
                     const SurfaceModel& surface) {
  return std::any_of(
      surface.self_similar_poses.begin(), surface.self_similar_poses.end(),
      [&](const Rigid2& pose) {
        const PairEvidence evidence = MeasurePair(
            options.agreement, options.registration, surface, surface, pose);
        const double score =
            Score(options.judgement.score_weights, evidence, kMaxMargin);
        return Judge(options.judgement, evidence, score, kMaxMargin) ==
               Verdict::kAccepted;
      });
}

void MeasurePlaces(const VerificationOptions& verification,
                   const DescribedMap& map, MapExamination* const result) {
  result->num_submaps = map.state.submaps.size();
  result->num_places = map.places.size();
  for (const auto& [id, place] : map.places) {
    result->num_self_similar += ResemblesItself(verification, place.surface);
    result->mean_area += ObservedArea(place.surface);
  }
  if (!map.places.empty()) {
    result->mean_area /= static_cast<double>(map.places.size());
  }
}

std::string Percent(const double ratio) {
  return absl::StrFormat("%.1f %%", 100. * ratio);
}

void AdviseOnTrajectories(const MapExamination& map,
                          std::vector<std::string>* const advice) {
  // Of all places. Most maps have none.
  constexpr double kManyBroken = 0.05;
  // Willow, ACES, Killian Court and offices: below 1.5 %.
  constexpr double kNoisy = 0.03;
  if (!map.torn_submaps.empty() || !map.slips.empty() ||
      static_cast<double>(map.broken_links.size()) >
          kManyBroken * static_cast<double>(map.num_places)) {
    advice->push_back(absl::StrFormat(
        "local SLAM slipped: %d submaps are torn inside, behind %d the walls "
        "contradict where it put the next ones, and at %d steps odometry "
        "turned otherwise. Drive slower there, use odometry or an IMU, or let "
        "the front end search for each scan "
        "(use_online_correlative_scan_matching)",
        map.torn_submaps.size(), map.broken_links.size(), map.slips.size()));
  }
  const double noise = map.along_trajectories.contradiction_ratio;
  if (noise > kNoisy) {
    advice->push_back(absl::StrFormat(
        "walls are noisy: of the walls that submaps two apart have in common, "
        "%s stand in free space. Look at moving objects, at the time stamps of "
        "the scans, at the mounting of the lidar (a floor that it sees), and "
        "at min_range and max_range",
        Percent(noise)));
  }
}

void AdviseOnWhole(const MapExamination& map,
                   std::vector<std::string>* const advice) {
  // Moved furniture leaves a few percent.
  constexpr double kFolded = 0.03;
  constexpr double kTimesNoise = 3.;
  const MapQuality& whole = map.whole;
  if (whole.contradiction_ratio <= kFolded ||
      whole.contradiction_ratio <=
          kTimesNoise * map.along_trajectories.contradiction_ratio) {
    return;
  }
  advice->push_back(absl::StrFormat(
      "places that were seen twice do not agree: %s of their walls stand in "
      "free space. %s",
      Percent(whole.contradiction_ratio),
      map.is_closed ? "Run audit to find loop closures that are wrong, and "
                      "close_loops for those that are missing"
                    : "The map has no loop closures: run close_loops"));
}

void AdviseOnPlaces(const MapExamination& map,
                    std::vector<std::string>* const advice) {
  constexpr double kSmall = 20.;
  constexpr double kManyAlike = 0.5;
  if (map.num_places < map.num_submaps) {
    advice->push_back(absl::StrFormat(
        "%d of %d submaps show no wall and cannot be recognised",
        map.num_submaps - map.num_places, map.num_submaps));
  }
  if (map.num_places > 0 && map.mean_area < kSmall) {
    advice->push_back(absl::StrFormat(
        "submaps show little, %.0f m2 in the mean: a larger "
        "submaps.num_range_data or max_range makes places easier to recognise",
        map.mean_area));
  }
  if (static_cast<double>(map.num_self_similar) >
      kManyAlike * static_cast<double>(map.num_places)) {
    advice->push_back(absl::StrFormat(
        "%d of %d submaps resemble themselves when they are turned round or "
        "shifted, as corridors do: they are recognised only together with "
        "their neighbours. A larger submaps.num_range_data or max_range helps",
        map.num_self_similar, map.num_places));
  }
}

}  // namespace

MapExamination ExamineMap(const LoopClosingOptions& options,
                          const DescribedMap& map, const Executor& executor,
                          const StageCallback& on_stage) {
  const RecognitionOptions& recognition = options.recognition;
  const VerificationOptions& verification = recognition.match.verification;
  MapExamination result;
  StageClock clock(on_stage, &result.stage_seconds);
  MeasurePlaces(verification, map, &result);
  result.is_closed = HasClosures(map.state.pose_graph);
  clock.Begin("compare walls");
  result.whole =
      MeasureMapQuality(verification.agreement, recognition.min_index_gap,
                        map.places, map.state.pose_graph, executor);
  result.along_trajectories =
      CompareWalls(verification.agreement,
                   LinkedPairs(recognition.links.index_step, map), executor);
  result.broken_links = TrajectoryLinks(recognition.links, verification,
                                        map.trajectory_places(), executor)
                            .broken();
  result.torn_submaps = FindTornSubmaps(
      options.closing.tear, map.state.pose_graph, map.point_clouds, executor,
      clock.Begin("find torn submaps"));
  clock.End();
  result.slips = FindSlips(options.closing.optimization.min_slip_angle,
                           map.state.pose_graph);
  return result;
}

std::vector<std::string> AdviseOnMap(const MapExamination& examination) {
  std::vector<std::string> advice;
  AdviseOnTrajectories(examination, &advice);
  AdviseOnWhole(examination, &advice);
  AdviseOnPlaces(examination, &advice);
  return advice;
}

}  // namespace cartographer_sdf
