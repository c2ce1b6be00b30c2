// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/false_constraints.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "cartographer_sdf/closing/constraint_generation.h"
#include "cartographer_sdf/closing/pipeline.h"
#include "cartographer_sdf/geometry/distinct_poses.h"
#include "cartographer_sdf/place/trajectory_places.h"
#include "cartographer_sdf/place_store/described_map.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/simulation/random_numbers.h"
#include "cartographer_sdf/verification/agreement.h"
#include "cartographer_sdf/verification/registration.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Submaps with at least this overlap show one place [m^2].
constexpr double kMinOverlapArea = 20.;
// A pose that differs this much from the map's is wrong [m], [rad].
constexpr PoseTolerance kMinError{1.2, 0.4};
// Slides along the walls [m].
constexpr double kMinSlide = 1.5;
constexpr double kMaxSlide = 6.;
constexpr double kSlideStep = 0.25;
// Half turns are tried about the points of a grid with this number of 1 m steps
// in each direction.
constexpr int kMaxHalfTurnSteps = 2;
constexpr int kNumAgreementPoints = 500;
// Number of pairs of different places to match in search of aliases.
constexpr size_t kNumTwinCandidates = 600;
// Neighbours on either side of a row's first pair, and the limits on the number
// of pairs in a row.
constexpr int kRowReach = 2;
constexpr size_t kMinRowPairs = 3;
constexpr size_t kMaxRowPairs = 6;
constexpr int kNumAttempts = 10;

constexpr const char* kKindNames[] = {"corridor", "door", "half_turn",
                                      "twin",     "row",  "random"};

// Nodes of each submap of a pair that get a constraint to the other.
constexpr int kNumNodesPerSubmap = 2;
// A scan with a smaller fraction on walls yields no constraint, similar to
// Cartographer's minimum score. Has no effect on random poses.
constexpr double kMinHitRatio = 0.55;

// Weights are those of the map's own inter-submap constraints.
ConstraintOptions ForgingOptions(const ConstraintOptions& closing,
                                 const PoseGraph& pose_graph) {
  ConstraintOptions constraint_options = closing;
  constraint_options.num_nodes_per_submap = kNumNodesPerSubmap;
  constraint_options.min_num_constraints = 1;
  constraint_options.min_hit_ratio = kMinHitRatio;
  for (const Constraint& constraint : pose_graph.constraints) {
    if (constraint.tag != Constraint::Tag::kInterSubmap) continue;
    constraint_options.translation_weight = constraint.translation_weight;
    constraint_options.rotation_weight = constraint.rotation_weight;
    break;
  }
  return constraint_options;
}

// Generates wrong poses for pairs of a map's submaps, and constraints from
// them.
class Forger {
 public:
  Forger(const LoopClosingOptions& loop_closing, const uint32_t seed,
         const DescribedMap& map)
      : recognition_(loop_closing.recognition),
        constraint_options_(ForgingOptions(loop_closing.closing.constraints,
                                           map.state.pose_graph)),
        map_(map),
        nodes_(FindInsertedNodes(map.state.pose_graph)),
        random_(seed) {
    for (auto i = map.places.begin(); i != map.places.end(); ++i) {
      for (auto j = std::next(i); j != map.places.end(); ++j) {
        const IdPair ids{i->first, j->first};
        if (ShareScans(ids.first, ids.second, recognition_.min_index_gap)) {
          continue;
        }
        const double overlap =
            OverlapArea(i->second.surface, j->second.surface, PoseByMap(ids));
        if (overlap >= kMinOverlapArea) near_.push_back(ids);
        if (overlap == 0.) far_.push_back(ids);
      }
    }
    Shuffle(&near_);
    Shuffle(&far_);
    if (far_.size() > kNumTwinCandidates) far_.resize(kNumTwinCandidates);
  }

  // Finds different places that look alike (perceptual aliasing).
  void MatchAliases(const Executor& executor) {
    std::vector<std::optional<Match>> matches(far_.size());
    executor(far_.size(), [&](const size_t k) {
      matches[k] =
          MatchPlaces(recognition_.match, map_.places.at(far_[k].first),
                      map_.places.at(far_[k].second));
    });
    for (const std::optional<Match>& match : matches) {
      if (match) aliases_.push_back(match->pair);
    }
    std::stable_sort(
        aliases_.begin(), aliases_.end(),
        [](const PairPose& a, const PairPose& b) { return a.score > b.score; });
  }

  // Returns the constraints of one more pair, or row, of this kind; empty if
  // the map has no more.
  std::vector<Constraint> Forge(const FalseKind kind) {
    switch (kind) {
      case FalseKind::kTwin:
        return ForgeTwin();
      case FalseKind::kRow:
        return ForgeRow();
      case FalseKind::kRandom:
        return ForgeRandom();
      default:
        return ForgeNear(kind);
    }
  }

 private:
  using IdPair = std::pair<SubmapId, SubmapId>;

  template <typename T>
  void Shuffle(std::vector<T>* const items) {
    for (size_t k = items->size(); k > 1; --k) {
      std::swap((*items)[k - 1], (*items)[random_.Index(static_cast<int>(k))]);
    }
  }

  [[nodiscard]] Rigid2 PoseByMap(const IdPair& ids) const {
    const auto& poses = map_.state.pose_graph.submap_poses;
    return poses.at(ids.first).Inverse() * poses.at(ids.second);
  }

  [[nodiscard]] const RegistrationOptions& Registration() const {
    return recognition_.match.verification.registration;
  }

  [[nodiscard]] const SurfaceModel& Surface(const SubmapId& id) const {
    return map_.places.at(id).surface;
  }

  [[nodiscard]] std::optional<Rigid2> Register(const IdPair& ids,
                                               const Rigid2& guess) const {
    return RegisterSubmaps(Registration(), Surface(ids.first),
                           Surface(ids.second), guess);
  }

  [[nodiscard]] std::vector<Constraint> MakeConstraints(
      const PairPose& pair, const ScansByNode& scans) const {
    return GenerateConstraints(constraint_options_, pair, nodes_,
                               Surface(pair.reference), Surface(pair.query),
                               scans);
  }

  [[nodiscard]] bool IsWrong(const IdPair& ids, const Rigid2& pose) const {
    return !AreNear(pose, PoseByMap(ids), ObservedCentroid(Surface(ids.second)),
                    kMinError);
  }

  [[nodiscard]] double Alikeness(const IdPair& ids, const Rigid2& pose) const {
    const auto measure = [](const SurfaceModel& model,
                            const SurfaceModel& points, const Rigid2& T) {
      AgreementOptions agreement_options;
      agreement_options.max_num_points = kNumAgreementPoints;
      const DirectedAgreement agreement =
          MeasureAgreement(agreement_options, model, points.walls, T);
      return agreement.HitRatio() - 2. * agreement.ContradictionRatio();
    };
    const SurfaceModel& reference = Surface(ids.first);
    const SurfaceModel& query = Surface(ids.second);
    return measure(reference, query, pose) +
           measure(query, reference, pose.Inverse());
  }

  // Returns the registered wrong pose that looks most alike; none if there is
  // no such pose.
  [[nodiscard]] std::optional<Rigid2> BestWrong(
      const IdPair& ids, const std::vector<Rigid2>& guesses) const {
    std::optional<Rigid2> best;
    double best_alikeness = 0.;
    for (const Rigid2& guess : guesses) {
      const std::optional<Rigid2> pose = Register(ids, guess);
      if (!pose || !IsWrong(ids, *pose)) continue;
      const double alikeness = Alikeness(ids, *pose);
      if (!best || alikeness > best_alikeness) {
        best = pose;
        best_alikeness = alikeness;
      }
    }
    return best;
  }

  // In the frame of the first submap; none if registration fails.
  [[nodiscard]] std::optional<Eigen::Vector2d> DirectionOfWalls(
      const IdPair& ids) const {
    const std::optional<Rigid2> pose = Register(ids, PoseByMap(ids));
    if (!pose) return std::nullopt;
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(
               NormalScatter(Registration(), Surface(ids.first),
                             Surface(ids.second), *pose))
        .eigenvectors()
        .col(0);
  }

  [[nodiscard]] std::vector<Rigid2> Guesses(const FalseKind kind,
                                            const IdPair& ids) {
    const Rigid2 T_reference_query = PoseByMap(ids);
    std::vector<Rigid2> guesses;
    if (kind == FalseKind::kHalfTurn) {
      const Eigen::Vector2d middle =
          0.5 * (ObservedCentroid(Surface(ids.first)) +
                 T_reference_query * ObservedCentroid(Surface(ids.second)));
      for (int i = -kMaxHalfTurnSteps; i <= kMaxHalfTurnSteps; ++i) {
        for (int j = -kMaxHalfTurnSteps; j <= kMaxHalfTurnSteps; ++j) {
          const Eigen::Vector2d centre = middle + Eigen::Vector2d(i, j);
          guesses.push_back(Rigid2(2. * centre, M_PI) * T_reference_query);
        }
      }
      return guesses;
    }
    const std::optional<Eigen::Vector2d> direction = DirectionOfWalls(ids);
    if (!direction) return guesses;
    const auto slide = [&](const double distance) {
      guesses.push_back(Rigid2(distance * *direction, 0.) * T_reference_query);
    };
    if (kind == FalseKind::kCorridor) {
      slide((random_.Chance(0.5) ? 1. : -1.) *
            random_.Uniform(kMinSlide, kMaxSlide));
      return guesses;
    }
    constexpr int kNumSteps =
        static_cast<int>((kMaxSlide - kMinSlide) / kSlideStep);
    for (int k = 0; k <= kNumSteps; ++k) {
      slide(kMinSlide + k * kSlideStep);
      slide(-(kMinSlide + k * kSlideStep));
    }
    return guesses;
  }

  std::vector<Constraint> ForgeNear(const FalseKind kind) {
    while (!near_.empty()) {
      const IdPair ids = near_.back();
      near_.pop_back();
      for (int attempt = 0; attempt < kNumAttempts; ++attempt) {
        const std::optional<Rigid2> pose = BestWrong(ids, Guesses(kind, ids));
        if (!pose) continue;
        std::vector<Constraint> constraints =
            MakeConstraints({ids.first, ids.second, *pose}, map_.point_clouds);
        if (!constraints.empty()) return constraints;
        // Other kinds would make the same guesses again.
        if (kind != FalseKind::kCorridor) break;
      }
    }
    return {};
  }

  std::vector<Constraint> ForgeTwin() {
    while (next_alias_ < aliases_.size()) {
      std::vector<Constraint> constraints =
          MakeConstraints(aliases_[next_alias_++], map_.point_clouds);
      if (!constraints.empty()) return constraints;
    }
    return {};
  }

  // A twin, and pairs of its neighbours at the poses that follow by local SLAM.
  std::vector<Constraint> ForgeRow() {
    while (next_alias_ < aliases_.size()) {
      const PairPose& first = aliases_[next_alias_++];
      std::vector<Constraint> row = MakeConstraints(first, map_.point_clouds);
      if (row.empty()) continue;
      size_t num_pairs = 1;
      for (int i = -kRowReach; i <= kRowReach; ++i) {
        for (int j = -kRowReach; j <= kRowReach; ++j) {
          if ((i == 0 && j == 0) || num_pairs == kMaxRowPairs) continue;
          const std::optional<PairPose> pair = Neighbours(first, i, j);
          if (!pair) continue;
          const std::vector<Constraint> constraints =
              MakeConstraints(*pair, map_.point_clouds);
          row.insert(row.end(), constraints.begin(), constraints.end());
          if (!constraints.empty()) ++num_pairs;
        }
      }
      if (num_pairs >= kMinRowPairs) return row;
    }
    return {};
  }

  [[nodiscard]] std::optional<PairPose> Neighbours(const PairPose& pair,
                                                   const int i,
                                                   const int j) const {
    PairPose neighbours = pair;
    neighbours.reference.index += i;
    neighbours.query.index += j;
    if (map_.places.count(neighbours.reference) == 0 ||
        map_.places.count(neighbours.query) == 0) {
      return std::nullopt;
    }
    const auto local = [&](const SubmapId& id) {
      return map_.state.submaps.at(id).T_local_submap;
    };
    neighbours.T_reference_query =
        local(neighbours.reference).Inverse() * local(pair.reference) *
        pair.T_reference_query * local(pair.query).Inverse() *
        local(neighbours.query);
    if (OverlapArea(Surface(neighbours.reference), Surface(neighbours.query),
                    neighbours.T_reference_query) < kMinOverlapArea) {
      return std::nullopt;
    }
    return neighbours;
  }

  std::vector<Constraint> ForgeRandom() {
    const int size = static_cast<int>(map_.places.size());
    for (int attempt = 0; attempt < kNumAttempts; ++attempt) {
      const int i = random_.Index(size);
      const int j = random_.Index(size);
      const auto& reference = std::next(map_.places.begin(), std::min(i, j));
      const auto& query = std::next(map_.places.begin(), std::max(i, j));
      const std::vector<Eigen::Vector2d>& points =
          reference->second.surface.observed_points;
      const Eigen::Vector2d middle =
          points[random_.Index(static_cast<int>(points.size()))];
      const Rigid2 pose = Rigid2(middle, random_.Uniform(-M_PI, M_PI)) *
                          Rigid2(-ObservedCentroid(query->second.surface), 0.);
      const IdPair ids{reference->first, query->first};
      if (ShareScans(ids.first, ids.second, recognition_.min_index_gap) ||
          !IsWrong(ids, pose)) {
        continue;
      }
      return MakeConstraints({ids.first, ids.second, pose}, {});
    }
    return {};
  }

  const RecognitionOptions& recognition_;
  const ConstraintOptions constraint_options_;
  const DescribedMap& map_;
  const std::map<SubmapId, InsertedNodes> nodes_;
  RandomNumbers random_;
  // Pairs that see the same place according to the map, and pairs that do not.
  std::vector<IdPair> near_;
  std::vector<IdPair> far_;
  std::vector<PairPose> aliases_;  // best first
  size_t next_alias_ = 0;
};

}  // namespace

const char* FalseKindName(const FalseKind kind) {
  return kKindNames[static_cast<int>(kind)];
}

std::vector<FalseKind> AllFalseKinds() {
  std::vector<FalseKind> kinds;
  for (size_t k = 0; k < std::size(kKindNames); ++k) {
    kinds.push_back(static_cast<FalseKind>(k));
  }
  return kinds;
}

std::string Validate(const FalsificationOptions& options) {
  return options.num_pairs < 1 ? "num_pairs must be positive" : "";
}

absl::StatusOr<FalsifiedMap> FalsifyMap(
    const LoopClosingOptions& loop_closing, const FalsificationOptions& options,
    const std::string& path, const std::set<int>& frozen_trajectories,
    const Executor& executor) {
  CHECK_EQ(Validate(loop_closing), "");
  CHECK_EQ(Validate(options), "");
  absl::Status status = CheckHasTrajectories(path, frozen_trajectories);
  if (!status.ok()) return status;
  const absl::StatusOr<DescribedMap> map =
      DescribeMap(loop_closing.place, loop_closing.recognition.match, path,
                  executor, {}, PointClouds::kKeep);
  if (!map.ok()) return map.status();
  const PoseGraph& pose_graph = map->state.pose_graph;
  FalsifiedMap result;
  result.pose_graph = pose_graph;
  if (map->places.empty()) return result;

  Forger forger(loop_closing, options.seed, *map);
  forger.MatchAliases(executor);
  size_t pair = 0;
  for (const FalseKind kind : options.kinds) {
    for (int k = 0; k < options.num_pairs; ++k) {
      const std::vector<Constraint> constraints = forger.Forge(kind);
      if (constraints.empty()) break;
      for (const Constraint& constraint : constraints) {
        result.false_constraints.push_back(
            {result.pose_graph.constraints.size(), kind, pair});
        result.pose_graph.constraints.push_back(constraint);
      }
      ++pair;
    }
  }
  if (!result.false_constraints.empty()) {
    Optimize(OptimizationInForce(loop_closing.closing, pose_graph),
             frozen_trajectories, &result.pose_graph);
  }
  return result;
}

}  // namespace cartographer_sdf
