// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// No option of localising, by matches and by a scan, of drawing places from
// scans, of choosing sessions to compare and of looking for folds in merged
// maps is without effect.

#include <algorithm>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/apps/fold_check.h"
#include "cartographer_sdf/apps/session_links.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/localization/localizer.h"
#include "cartographer_sdf/localization/scan_localizer.h"
#include "cartographer_sdf/localization/scan_places.h"
#include "cartographer_sdf/localization/scan_session.h"
#include "gtest/gtest.h"
#include "test/testing/drawn_map.h"
#include "test/testing/option_effects.h"
#include "test/testing/visited_rooms.h"

namespace cartographer_sdf::localization_option_effects_test {
namespace {

using testing::VisitedRooms;

// Walls of the east room stand in its free space.
const Rigid2 kMisplaced(1.4, 1.2, 0.05);

std::string Text(const Localization& localization) {
  std::ostringstream text;
  text.precision(17);
  text << localization.reason << " " << localization.score.value_or(-1.) << " "
       << localization.runner_up_score.value_or(-1.) << " "
       << localization.num_agreeing << " " << localization.num_contradicting
       << " " << localization.matches.size() << "\n";
  for (const Placement& placement : localization.placements) {
    text << placement.T_map_query.translation().transpose() << " "
         << placement.score << " " << placement.votes.size() << " "
         << placement.is_rival << "\n";
  }
  return text.str();
}

class LocalizationOptionEffectsTest : public ::testing::Test {
 protected:
  LocalizationOptionEffectsTest() {
    for (const auto& [id, place] : rooms_.map().places) {
      (IsOfFirstVisit(id) ? first_ : again_).emplace(id, place);
    }
  }

  static bool IsOfFirstVisit(const SubmapId& id) {
    return id < VisitedRooms::kWestAgain;
  }
  // Of the query's submaps one is found in the map for sure, a little off, and
  // elsewhere; the other is left to confirmation.
  [[nodiscard]] std::vector<Match> MatchesOfOne() const {
    return {rooms_.MakeMatch(VisitedRooms::kWestFirst, VisitedRooms::kWestAgain,
                             9.),
            rooms_.MakeMatch(VisitedRooms::kWestFirst, VisitedRooms::kWestAgain,
                             3., Rigid2(0.6, 0., 0.12)),
            rooms_.MakeMatch(VisitedRooms::kEastFirst, VisitedRooms::kWestAgain,
                             4., Rigid2(7., 3., 2.))};
  }
  [[nodiscard]] std::string Locate(
      const LocalizationOptions& options, const std::vector<Match>& matches,
      const Rigid2& error_of_east = Rigid2()) const {
    const DescribedMap& map = rooms_.map();
    const MapLayout layout =
        MakeMapLayout(map.state.pose_graph, map.odometry, map.places);
    MapLayout query_layout = layout;
    Rigid2& east = query_layout.T_map_submap.at(VisitedRooms::kEastAgain);
    east = error_of_east * east;
    // Well-made maps, which tell where the other room must be.
    ConsistencyOptions consistency;
    consistency.rotation_sigma_per_sqrt_meter = 0.001;
    const PlaceMatcher matcher = [&matches](
                                     const std::map<SubmapId, Place>& queries,
                                     const ProgressCallback&) {
      std::vector<Match> found;
      for (const Match& match : matches) {
        if (queries.count(match.pair.query) > 0) found.push_back(match);
      }
      return found;
    };
    return Text(Localize(options, consistency, MatchOptions(),
                         {&first_, &layout}, {&again_, &query_layout}, matcher,
                         MakeExecutor(1)));
  }

  const VisitedRooms rooms_;
  std::map<SubmapId, Place> first_, again_;
};

TEST_F(LocalizationOptionEffectsTest, NoneOfLocalizationIsWithout) {
  std::vector<Match> matches_of_both = MatchesOfOne();
  matches_of_both.push_back(
      rooms_.MakeMatch(VisitedRooms::kEastFirst, VisitedRooms::kEastAgain, 6.));
  std::vector<Match> with_likely = MatchesOfOne();
  with_likely.push_back(
      rooms_.MakeMatch(VisitedRooms::kEastFirst, VisitedRooms::kEastAgain, 2.));
  with_likely.back().verdict = Verdict::kUnlikely;
  // Of one submap, found from both rooms.
  const std::vector<Match> from_both_rooms = {
      rooms_.MakeMatch(VisitedRooms::kWestFirst, VisitedRooms::kWestAgain, 9.),
      rooms_.MakeMatch(VisitedRooms::kEastFirst, VisitedRooms::kWestAgain, 5.)};
  const std::vector<testing::Scenario<LocalizationOptions>> scenarios = {
      {"",
       [&](const LocalizationOptions& options) {
         return Locate(options, MatchesOfOne());
       }},
      {"placement.max_contradiction_ratio",
       [&](const LocalizationOptions& options) {
         return Locate(options, MatchesOfOne(), kMisplaced);
       }},
      {"placement.max_contradicting_fraction",
       [&](const LocalizationOptions& options) {
         return Locate(options, MatchesOfOne(), kMisplaced);
       }},
      {"placement.further_match_weight",
       [&](const LocalizationOptions& options) {
         return Locate(options, from_both_rooms);
       }},
      {"count_likely_matches",
       [&](const LocalizationOptions& options) {
         return Locate(options, with_likely);
       }},
      // Where either submap is enough.
      {"num_first_places", [&](const LocalizationOptions& options) {
         LocalizationOptions easy = options;
         easy.placement.min_score = 1.;
         easy.placement.min_lead = 0.;
         easy.max_num_confirmed_pairs = 0;
         return Locate(easy, matches_of_both);
       }}};
  EXPECT_EQ(testing::OptionsWithoutEffect(LocalizationOptions(), scenarios),
            "");
}

TEST_F(LocalizationOptionEffectsTest, NoneOfScanPlacesIsWithout) {
  ScanPlaceOptions base;
  base.num_scans = 12;
  const std::vector<testing::Scenario<ScanPlaceOptions>> scenarios = {
      {"", [this](const ScanPlaceOptions& options) {
         const ScanMap scans =
             DescribeScans(options, PlaceOptions(), MatchOptions(),
                           rooms_.map(), {0., 12.}, MakeExecutor(1));
         std::ostringstream text;
         text.precision(9);
         for (const auto& [id, grid] : scans.grids) {
           text << id << " " << grid.geometry.size.transpose() << " "
                << grid.probability.sum() << "\n";
         }
         return text.str();
       }}};
  EXPECT_EQ(testing::OptionsWithoutEffect(base, scenarios), "");
}

std::string Text(const ScanLocalization& localization) {
  std::ostringstream text;
  text.precision(17);
  text << localization.reason << " "
       << localization.elsewhere_probability.value_or(-1.) << "\n";
  for (const ScanCandidate& candidate : localization.candidates) {
    text << candidate.T_map_robot.translation().transpose() << " "
         << candidate.probability << "\n";
  }
  return text.str();
}

// In two rooms.
std::string LocateScan(const ScanLocalizationOptions& options,
                       const OccupancyGrid& grid, const RobotScan& scan) {
  const auto map = MakePanoramaMap(options.viewpoints, grid, {});
  return map ? Text(LocalizeScans(options, *map, {scan})) : "no map";
}

TEST(ScanLocalizationOptionEffectsTest, NoneIsWithout) {
  const OccupancyGrid grid = testing::TwoRoomsGrid();
  const RobotScan all =
      testing::ScanFrom(testing::TwoRooms(), Rigid2(2., 1.7, 0.3));
  // Some beams cross walls, and some end in free space.
  RobotScan disturbed = testing::Narrowed(all, 3.5);
  for (size_t k = 0; k < disturbed.scan.returns.size() / 6; ++k) {
    disturbed.scan.returns[k] *= k % 2 == 0 ? 0.6f : 1.7f;
  }
  // Nobody has seen the wall at the right of the west room.
  OccupancyGrid without_wall = grid;
  for (int i = 0; i < grid.geometry.size.x(); ++i) {
    if (grid.geometry.CellCentre({i, 0}).x() > 6.3) {
      without_wall.known.row(i).setConstant(false);
    }
  }
  const std::vector<testing::Scenario<ScanLocalizationOptions>> scenarios = {
      {"",
       [&](const ScanLocalizationOptions& options) {
         return LocateScan(options, grid, disturbed);
       }},
      {"min_num_beams",
       [&](const ScanLocalizationOptions& options) {
         return LocateScan(options, grid, testing::Narrowed(all, 0.8));
       }},
      {"presence_weights.in_unknown",
       [&](const ScanLocalizationOptions& options) {
         return LocateScan(options, without_wall, all);
       }},
      // Something is there with the probability .73, and then it is certain
      // where.
      {"min_probability", [&](const ScanLocalizationOptions& options) {
         ScanLocalizationOptions half_sure = options;
         half_sure.presence_weights = {0., 0., 0., 0., 0., 0., 1.};
         return LocateScan(half_sure, grid, all);
       }}};
  ScanLocalizationOptions base;
  base.min_probability = 0.6;
  EXPECT_EQ(testing::OptionsWithoutEffect(base, scenarios), "");
}

// A drive of half a metre a scan straight ahead, and then one scan a second in
// another room; what each scan tells.
std::string FollowDrive(const ScanSessionOptions& options,
                        const PanoramaMap& map, const double field_of_view,
                        const double min_probability) {
  ScanLocalizationOptions localization;
  localization.min_probability = min_probability;
  ScanSession session(localization, options, map);
  std::string text;
  for (int k = 0; k < 24; ++k) {
    const bool is_carried = k >= 14;
    const Rigid2 T_odometry_robot(0.3 * std::min(k, 9), 0.,
                                  0.3 * std::max(0, std::min(k, 13) - 9));
    const Rigid2 T_world_robot = is_carried
                                     ? Rigid2(12.2, 3.1, 1.)
                                     : Rigid2(1.8, 1.8, 0.1) * T_odometry_robot;
    const SessionAnswer& answer =
        session.Add({static_cast<double>(k),
                     T_odometry_robot,
                     {testing::Narrowed(
                         testing::ScanFrom(testing::TwoRooms(), T_world_robot),
                         field_of_view)}});
    text += Text(answer.localization) + ScanSearchStateName(answer.state) +
            ScanUseName(answer.use);
  }
  return text;
}

TEST(ScanSessionOptionEffectsTest, NoneIsWithout) {
  const auto map = MakePanoramaMap({}, testing::TwoRoomsGrid(), {});
  ASSERT_TRUE(map.has_value());
  constexpr double kNeverCertain = 1. - 1e-12;
  const std::vector<testing::Scenario<ScanSessionOptions>> scenarios = {
      {"",
       [&](const ScanSessionOptions& options) {
         return FollowDrive(options, *map, 0.8, kNeverCertain);
       }},
      {"max_contradicting_fraction",
       [&](const ScanSessionOptions& options) {
         return FollowDrive(options, *map, 7., 0.9);
       }},
      {"lost_after_seconds",
       [&](const ScanSessionOptions& options) {
         return FollowDrive(options, *map, 7., 0.9);
       }},
      {"lost_after_scans", [&](const ScanSessionOptions& options) {
         ScanSessionOptions at_once = options;
         at_once.lost_after_seconds = 0.;
         return FollowDrive(at_once, *map, 7., 0.9);
       }}};
  ScanSessionOptions base;
  base.max_num_looks = 4;
  EXPECT_EQ(testing::OptionsWithoutEffect(base, scenarios), "");
}

// The two visits as sessions, of which the second was laid wrong.
TEST_F(LocalizationOptionEffectsTest, NoneOfTheFoldCheckIsWithout) {
  JoinedSessions joined;
  PoseGraph merged;
  for (const auto& [id, place] : rooms_.map().places) {
    const int session = IsOfFirstVisit(id) ? 0 : 1;
    Place renamed = place;
    renamed.id = {session, id.index};
    joined.places.emplace(renamed.id, renamed);
    Rigid2 T_map_submap = rooms_.T_world_submap(id);
    if (id == VisitedRooms::kEastAgain) {
      T_map_submap = kMisplaced * T_map_submap;
    }
    merged.submap_poses[renamed.id] = T_map_submap;
    joined.session_of_trajectory[session] = static_cast<size_t>(session);
  }
  joined.state.pose_graph = merged;
  const Session first{"first", {}, {}}, second{"second", {}, {}};
  const std::vector<testing::Scenario<FoldCheckOptions>> scenarios = {
      {"", [&](const FoldCheckOptions& options) {
         const auto overlaps = CheckOverlaps(options, RecognitionOptions(),
                                             joined, merged, MakeExecutor(1));
         size_t num_contradictions = 0;
         for (const auto& [ids, overlap] : overlaps) {
           num_contradictions += overlap.contradictions.size();
         }
         const std::optional<MergingFault> fault =
             FindFold(options, overlaps, {&first, &second});
         return std::to_string(num_contradictions) +
                (fault ? fault->reason : "");
       }}};
  FoldCheckOptions base;
  base.max_folded_fraction = 0.3;
  EXPECT_EQ(testing::OptionsWithoutEffect(base, scenarios), "");
}

TEST(OptionEffectsTest, OfLinksBetweenSessions) {
  const std::vector<testing::Scenario<SessionLinkOptions>> scenarios = {
      {"", [](const SessionLinkOptions& options) {
         const std::vector<Session> sessions(7);
         const LocalizationOptions localization;
         const LoopClosingOptions stages;
         const Executor executor = MakeExecutor(1);
         std::vector<std::pair<std::string, double>> seconds;
         StageClock clock({}, &seconds);
         SessionLinker linker(options, localization, stages, sessions, executor,
                              &clock);
         linker.LinkMostAlike();
         return std::to_string(linker.links().size());
       }}};
  EXPECT_EQ(testing::OptionsWithoutEffect(SessionLinkOptions(), scenarios), "");
}

}  // namespace
}  // namespace cartographer_sdf::localization_option_effects_test
