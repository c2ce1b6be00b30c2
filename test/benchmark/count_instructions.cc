// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What scripts/check_instructions.py counts the instructions of: describing one
// submap, matching one pair that shows the same place and one that does not,
// and one query of an index of 300 submaps. Where it was compiled without
// valgrind's header, its exit code is 77.

#include <optional>
#include <utility>
#include <vector>

#include "cartographer_sdf/matching/place_index.h"
#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/recognition/match.h"
#include "glog/logging.h"
#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#endif

#include "test/benchmark/recombined_submaps.h"
#include "test/testing/building.h"

namespace cartographer_sdf::benchmarks {
namespace {

constexpr int kNumIndexedSubmaps = 300;

// The rooms at both ends of the corridor, seen from somewhat different points
// and by another submap: the same place.
OccupancyGrid SeeRooms(const Rigid2& T_world_submap,
                       const Eigen::Vector2d& shift) {
  testing::Viewpoints viewpoints;
  for (const testing::Viewpoints& some :
       {testing::WestRoomViewpoints(), testing::EastRoomViewpoints()}) {
    for (size_t k = 0; k < some.size(); k += 2) {
      viewpoints.emplace_back(some[k] + shift);
    }
  }
  viewpoints.emplace_back(Eigen::Vector2d(6., 6.) + shift);
  return testing::SeeFrom(testing::TwoRooms(), T_world_submap, viewpoints);
}

// Another place.
OccupancyGrid SeeHall() {
  testing::Building hall = testing::BareRoom(16., 12.);
  for (int k = 0; k < 6; ++k) {
    hall.push_back(
        testing::Furniture(-6. + 2.3 * k, k % 3 - 1.5, 0.8, 0.6, 0.7 * k));
  }
  return testing::SeeFrom(hall, Rigid2(), {{-5., 3.}, {0., -4.}, {5., 4.}});
}

#ifdef CALLGRIND_DUMP_STATS_AT
// Counts the instructions of the work under that name.
template <typename Work>
void Count(const char* const name, const Work& work) {
  CALLGRIND_START_INSTRUMENTATION;
  CALLGRIND_ZERO_STATS;
  work();
  CALLGRIND_DUMP_STATS_AT(name);
  CALLGRIND_STOP_INSTRUMENTATION;
}

std::optional<Place> Describe(const int index, const OccupancyGrid& grid) {
  std::optional<Place> place = DescribePlace(PlaceOptions(), {0, index}, grid);
  if (place) FindSelfSimilarities(MatchOptions(), &*place);
  return place;
}

bool IsAccepted(const Place& reference, const Place& query) {
  const std::optional<Match> match =
      MatchPlaces(MatchOptions(), reference, query);
  return match && match->verdict == Verdict::kAccepted;
}

int Run() {
  const OccupancyGrid grid = SeeRooms(Rigid2(), {0., 0.});
  std::optional<Place> reference;
  Count("description", [&] { reference = Describe(0, grid); });
  const std::optional<Place> same =
      Describe(1, SeeRooms(Rigid2(4., -3., 2.1), {0.2, -0.1}));
  const std::optional<Place> other = Describe(2, SeeHall());
  CHECK(reference && same && other);
  bool is_right = false, is_wrong = false;
  Count("pair", [&] {
    is_right = IsAccepted(*reference, *same);
    is_wrong = IsAccepted(*reference, *other);
  });
  CHECK(is_right && !is_wrong);

  const RecombinedSubmaps submaps({reference->features.features,
                                   same->features.features,
                                   other->features.features});
  PlaceIndex index{RetrievalOptions()};
  for (int k = 0; k < kNumIndexedSubmaps; ++k) {
    index.Add({0, k}, submaps.Make(k));
  }
  const FeatureSet query = submaps.SeeAgain(7);
  std::vector<RetrievalCandidate> candidates;
  Count("query", [&] { candidates = index.Query(query); });
  CHECK(!candidates.empty() && candidates[0].id == SubmapId({0, 7}));
  return 0;
}
#else
int Run() { return 77; }
#endif

}  // namespace
}  // namespace cartographer_sdf::benchmarks

int main() { return cartographer_sdf::benchmarks::Run(); }
