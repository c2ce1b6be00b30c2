// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/placement_covariance.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstddef>
#include <optional>

#include "cartographer_sdf/localization/map_precision.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr size_t kMaxNumWallPoints = 400;  // of each place of the query
// Walls farther apart than this do not hold each other [m].
constexpr double kWallScale = 0.15;
constexpr double kWallSigma = 0.05;  // [m]
// Neighbouring cells of a wall err together: so much of it counts once [m].
constexpr double kIndependentWallMeters = 0.5;
// A piece of wall reaches this far around its middle [m], and is straight if
// its spread across is less than this part of that along.
constexpr double kPieceRadius = 0.6;
constexpr double kStraightRatio = 0.15;
// Where walls hold nothing [m], [rad].
constexpr double kFreeTranslationSigma = 5.;
constexpr double kFreeRotationSigma = 0.5;

Eigen::Matrix3d Diagonal(const double translation, const double rotation) {
  return Eigen::Vector3d(translation, translation, rotation).asDiagonal();
}

// How a piece of wall around a point holds a pose, in the frame of the walls:
// across it, and where it bends also along it. Gradients of the field would not
// do: a wall that slants in the grid has steps, which hold nothing.
Eigen::Matrix2d HoldOfWall(const std::vector<SurfacePoint>& walls,
                           const Eigen::Vector2d& middle) {
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (const SurfacePoint& wall : walls) {
    const Eigen::Vector2d offset = wall.position - middle;
    if (offset.squaredNorm() > kPieceRadius * kPieceRadius) continue;
    scatter += offset * offset.transpose();
    sum += offset;
    ++count;
  }
  scatter -= sum * sum.transpose() / count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(scatter);
  const Eigen::Vector2d& squares = solver.eigenvalues();
  // A pole, of which every direction is across.
  if (!(squares.y() > 0.)) return Eigen::Matrix2d::Identity();
  const Eigen::Vector2d across = solver.eigenvectors().col(0);
  const Eigen::Vector2d along = solver.eigenvectors().col(1);
  const double bend = std::max(0., squares.x() / squares.y() - kStraightRatio) /
                      (1. - kStraightRatio);
  return across * across.transpose() + bend * along * along.transpose();
}

// How near a point of the query's walls is to a wall of the reference, where
// the match puts it, from 0 to 1.
std::optional<double> NearnessOf(const SurfaceModel& reference,
                                 const Eigen::Vector2d& p_reference) {
  const CellGeometry& geometry = reference.geometry;
  const PinnedCells cells = reference.cells.Pin();
  const std::optional<FieldSample> sample = SampleSurface(
      geometry, *cells,
      geometry.GridToCells(geometry.T_submap_grid.Inverse() * p_reference));
  if (!sample) return std::nullopt;
  const double ratio =
      (sample->distance + 0.5 * geometry.resolution) / kWallScale;
  return 1. / ((1. + ratio * ratio) * (1. + ratio * ratio));
}

// What a point says of the robot's pose by a vote, if its field reaches there.
std::optional<Eigen::Matrix3d> InformationOfPoint(
    const SurfaceModel& reference, const PairPose& vote,
    const Rigid2& T_map_reference, const Eigen::Vector2d& p_query,
    const Eigen::Matrix2d& hold, const Eigen::Vector2d& p_map_robot) {
  const Eigen::Vector2d p_reference = vote.T_reference_query * p_query;
  const std::optional<double> nearness = NearnessOf(reference, p_reference);
  if (!nearness) return std::nullopt;
  const Eigen::Matrix2d R_map_query =
      (T_map_reference * vote.T_reference_query).RotationMatrix();
  const Eigen::Vector2d arm = T_map_reference * p_reference - p_map_robot;
  Eigen::Matrix<double, 2, 3> jacobian;
  jacobian << 1., 0., -arm.y(), 0., 1., arm.x();
  return *nearness * jacobian.transpose() * R_map_query * hold *
         R_map_query.transpose() * jacobian;
}

// Sums over the walls of a place of the query. Submaps of the map overlap: a
// point that several votes put on a wall counts once, with their mean.
Eigen::Matrix3d InformationOfPlace(const std::map<SubmapId, Place>& map_places,
                                   const Place& query, const MapPair& maps,
                                   const std::vector<PairPose>& votes,
                                   const Eigen::Vector2d& p_map_robot) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  const std::vector<SurfacePoint>& walls = query.surface.walls;
  const size_t count = std::min(walls.size(), kMaxNumWallPoints);
  for (size_t k = 0; k < count; ++k) {
    const Eigen::Matrix2d hold =
        walls[k].weight * HoldOfWall(walls, walls[k].position);
    Eigen::Matrix3d of_point = Eigen::Matrix3d::Zero();
    int num_votes = 0;
    for (const PairPose& vote : votes) {
      if (vote.query != query.id) continue;
      const std::optional<Eigen::Matrix3d> information =
          InformationOfPoint(map_places.at(vote.reference).surface, vote,
                             maps.map->T_map_submap.at(vote.reference),
                             walls[k].position, hold, p_map_robot);
      if (!information) continue;
      of_point += *information;
      ++num_votes;
    }
    if (num_votes > 0) sum += of_point / num_votes;
  }
  if (count == 0) return sum;
  // Each point stands for a piece of wall.
  const double meters_per_point = query.surface.geometry.resolution *
                                  static_cast<double>(walls.size()) /
                                  static_cast<double>(count);
  return sum * meters_per_point /
         (kIndependentWallMeters * kWallSigma * kWallSigma);
}

// Mean square of what votes put the robot off where the placement does. The
// same drift moves all of them, so that more votes do not make it less.
Eigen::Matrix3d ScatterOfVotes(const MapPair& maps,
                               const std::vector<PairPose>& votes,
                               const Rigid2& T_map_robot,
                               const Rigid2& T_query_robot) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double sum_of_weights = 0.;
  for (const PairPose& vote : votes) {
    const Rigid2 T_map_voted =
        PlaceByVote(maps, vote, vote.query) *
        maps.query->T_map_submap.at(vote.query).Inverse() * T_query_robot;
    Eigen::Vector3d off;
    off << T_map_voted.translation() - T_map_robot.translation(),
        NormalizeAngle(T_map_voted.rotation() - T_map_robot.rotation());
    const double weight = std::max(vote.score, 1e-3);
    sum += weight * off * off.transpose();
    sum_of_weights += weight;
  }
  return sum / sum_of_weights;
}

}  // namespace

Eigen::Matrix3d PlacementCovariance(
    const std::map<SubmapId, Place>& map_places,
    const std::map<SubmapId, Place>& query_places, const MapPair& maps,
    const std::vector<PairPose>& votes, const Rigid2& T_map_query,
    const Rigid2& T_query_robot) {
  CHECK(!votes.empty());
  const Rigid2 T_map_robot = T_map_query * T_query_robot;
  Eigen::Matrix3d information =
      Diagonal(1. / (kFreeTranslationSigma * kFreeTranslationSigma),
               1. / (kFreeRotationSigma * kFreeRotationSigma));
  for (const auto& [id, place] : query_places) {
    information += InformationOfPlace(map_places, place, maps, votes,
                                      T_map_robot.translation());
  }
  return information.llt().solve(Eigen::Matrix3d::Identity()) +
         ScatterOfVotes(maps, votes, T_map_robot, T_query_robot) +
         Diagonal(kMapTranslationSigma * kMapTranslationSigma,
                  kMapRotationSigma * kMapRotationSigma);
}

}  // namespace cartographer_sdf
