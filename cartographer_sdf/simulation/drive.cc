// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/drive.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "cartographer_sdf/geometry/number_range.h"
#include "cartographer_sdf/simulation/path_planner.h"
#include "cartographer_sdf/simulation/random_numbers.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

using Path = std::vector<Eigen::Vector2d>;

// Smaller buildings make no useful drive [m^2].
constexpr double kMinReachableArea = 4.;
// The whole drive is this many times the round trip, see MakeItinerary.
constexpr double kRoundTrips = 2.25;
constexpr int kMaxPlaces = 40;

struct Waypoint {
  int cell;
  ShortestPaths paths;
};

// Draws a reachable cell whose cost from all places is at least half of the
// largest such cost; any reachable cell if there are no places.
int DrawFarCell(const NavigationGrid& grid, const std::vector<Waypoint>& places,
                RandomNumbers* const random) {
  std::vector<std::pair<float, int>> candidates;
  float largest = 0.f;
  for (int k = 0; k != grid.reachable.size(); ++k) {
    if (!grid.reachable(k)) continue;
    float cost = std::numeric_limits<float>::infinity();
    for (const Waypoint& place : places) {
      cost = std::min(cost, place.paths.cost[k]);
    }
    candidates.push_back({cost, k});
    largest = std::max(largest, cost);
  }
  candidates.erase(std::remove_if(candidates.begin(), candidates.end(),
                                  [&](const std::pair<float, int>& candidate) {
                                    return candidate.first < 0.5f * largest;
                                  }),
                   candidates.end());
  return candidates[random->Index(static_cast<int>(candidates.size()))].second;
}

float Cost(const Waypoint& from, const Waypoint& to) {
  return from.paths.cost[to.cell];
}

// Index of the place in the round trip after which the new place adds the least
// cost.
size_t CheapestInsertion(const std::vector<Waypoint>& trip,
                         const Waypoint& place) {
  size_t best = 0;
  float best_detour = std::numeric_limits<float>::infinity();
  for (size_t k = 0; k != trip.size(); ++k) {
    const Waypoint& next = trip[(k + 1) % trip.size()];
    const float detour =
        Cost(trip[k], place) + Cost(place, next) - Cost(trip[k], next);
    if (detour < best_detour) {
      best_detour = detour;
      best = k;
    }
  }
  return best;
}

float RoundTripCost(const std::vector<Waypoint>& trip) {
  float cost = 0.f;
  for (size_t k = 0; k != trip.size(); ++k) {
    cost += Cost(trip[k], trip[(k + 1) % trip.size()]);
  }
  return cost;
}

std::vector<Waypoint> PlanRoundTrip(const NavigationGrid& grid,
                                    const double length,
                                    RandomNumbers* const random) {
  std::vector<Waypoint> trip;
  while (trip.size() < 2 ||
         (RoundTripCost(trip) < length && trip.size() < kMaxPlaces)) {
    const int cell = DrawFarCell(grid, trip, random);
    Waypoint place{cell, FindShortestPaths(grid, cell)};
    const size_t position =
        trip.empty() ? 0 : CheapestInsertion(trip, place) + 1;
    trip.insert(trip.begin() + position, std::move(place));
  }
  return trip;
}

// Indices of places: around, then back over the second half, then by a short
// cut to the start and over the first half again.
std::vector<int> MakeItinerary(const int num_places) {
  std::vector<int> itinerary;
  for (int k = 0; k != num_places; ++k) itinerary.push_back(k);
  for (int k = num_places; k >= num_places / 2; --k) {
    itinerary.push_back(k % num_places);
  }
  for (int k = 0; k <= num_places / 2; ++k) itinerary.push_back(k);
  return itinerary;
}

// Repeats the itinerary until the path is long enough, with a margin for the
// length that the robot saves by cutting corners and turning short of dead
// ends.
Path MakePath(const NavigationGrid& grid, const std::vector<Waypoint>& trip,
              const DriveOptions& options) {
  const std::vector<int> itinerary =
      MakeItinerary(static_cast<int>(trip.size()));
  Path path;
  double length = 0.;
  for (size_t k = 0; length < 1.5 * options.length; ++k) {
    const Waypoint& from = trip[itinerary[k % itinerary.size()]];
    const Waypoint& to = trip[itinerary[(k + 1) % itinerary.size()]];
    for (const Eigen::Vector2d& point :
         SmoothPath(grid, from.paths, to.cell, options.clearance)) {
      if (!path.empty()) length += (point - path.back()).norm();
      path.push_back(point);
    }
  }
  return path;
}

// Follows a point ahead on the path ("pure pursuit"): turns towards it, and
// drives more slowly the larger the heading error; turns on the spot in dead
// ends.
std::vector<DrivenPose> Follow(const Path& path, const DriveOptions& options) {
  constexpr double kLookahead = 0.25;  // [m]
  // Turn rate per heading error [1/s].
  constexpr double kTurnGain = 3.;
  const Eigen::Vector2d start =
      path[std::min<size_t>(5, path.size() - 1)] - path.front();
  Rigid2 T_world_robot(path.front(), std::atan2(start.y(), start.x()));
  std::vector<DrivenPose> poses = {{0., T_world_robot}};
  double length = 0.;
  size_t ahead = 0;
  for (int step = 1; length < options.length; ++step) {
    while (ahead != path.size() &&
           (path[ahead] - T_world_robot.translation()).norm() < kLookahead) {
      ++ahead;
    }
    if (ahead == path.size()) break;
    const Eigen::Vector2d p_robot = T_world_robot.Inverse() * path[ahead];
    const double heading_error = std::atan2(p_robot.y(), p_robot.x());
    const double turn = std::clamp(kTurnGain * heading_error,
                                   -options.turn_rate, options.turn_rate) *
                        options.time_step;
    const double advance =
        options.speed * options.time_step *
        std::max(0.,
                 std::cos(2. * std::min(std::abs(heading_error), M_PI / 4.)));
    T_world_robot = T_world_robot * Rigid2(advance, 0., turn);
    length += advance;
    poses.push_back({step * options.time_step, T_world_robot});
  }
  return poses;
}

}  // namespace

std::string Validate(const DriveOptions& options) {
  return FirstOutside({{"length", options.length, 0.01, 1e5},
                       {"clearance", options.clearance, 0.01,
                        NavigationGrid::kMaxClearance - 0.01},
                       {"speed", options.speed, 0.01, 10.},
                       {"turn_rate", options.turn_rate, 0.01, 10.},
                       {"time_step", options.time_step, 1e-3, 0.1}});
}

absl::StatusOr<std::vector<DrivenPose>> Drive(const FloorPlan& plan,
                                              const DriveOptions& options,
                                              const uint32_t seed) {
  CHECK_EQ(Validate(options), "");
  const NavigationGrid grid = MakeNavigationGrid(plan, options.clearance);
  const double area = static_cast<double>(grid.reachable.count()) *
                      grid.geometry.resolution * grid.geometry.resolution;
  if (area < kMinReachableArea) {
    return absl::InvalidArgumentError(absl::StrCat(
        "the floor plan has no connected free area of ", kMinReachableArea,
        " m^2 at least ", options.clearance, " m away from walls"));
  }
  RandomNumbers random(seed, RandomStream::kDrive);
  const std::vector<Waypoint> trip =
      PlanRoundTrip(grid, options.length / kRoundTrips, &random);
  return Follow(MakePath(grid, trip, options), options);
}

}  // namespace cartographer_sdf
