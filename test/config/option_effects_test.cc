// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// No option that ships is without effect: here those of describing and
// recognising places.

#include "test/testing/option_effects.h"

#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "cartographer_sdf/config/option_keys.h"
#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/matching/place_index.h"
#include "cartographer_sdf/place/field_memory.h"
#include "cartographer_sdf/recognition/crossed_groups.h"
#include "cartographer_sdf/recognition/neighbourhood_verification.h"
#include "cartographer_sdf/recognition/recognize.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"
#include "test/testing/corridor_map.h"
#include "test/testing/divided_hall.h"
#include "test/testing/two_visits.h"

namespace cartographer_sdf::option_effects_test {
namespace {

// What a robot sees of two rooms, one after the other, and later both again.
class Drive {
 public:
  Drive() {
    const testing::Building building = testing::TwoRooms();
    const auto add = [&](const int index, const Rigid2& T_world_submap,
                         const testing::Viewpoints& viewpoints) {
      const SubmapId id{0, index};
      OccupancyGrid grid =
          testing::SeeFrom(building, T_world_submap, viewpoints);
      // Not all walls were seen equally often.
      for (Eigen::Index k = 0; k < grid.probability.size(); k += 3) {
        float& probability = grid.probability.data()[k];
        probability = 0.5f + 0.4f * (probability - 0.5f);
      }
      grids_.emplace(id, std::move(grid));
      odometry_[id] = {T_world_submap, 10. * index};
    };
    add(0, Rigid2(3., 2., 0.4), testing::WestRoomViewpoints());
    add(2, Rigid2(12., 2., 1.4), testing::EastRoomViewpoints());
    add(10, Rigid2(4., 3., -1.),
        {{2.2, 2.4}, {4.4, 3.2}, {6.3, 4.2}, {2., 1.}});
    add(12, Rigid2(13., 1., 0.2),
        {{10.8, 2.4}, {11.2, -0.6}, {13.8, 1.}, {13.3, 3.2}});
  }

  [[nodiscard]] std::map<SubmapId, Place> Describe(
      const PlaceOptions& options) const {
    std::map<SubmapId, Place> places;
    for (const auto& [id, grid] : grids_) {
      std::optional<Place> place = DescribePlace(options, id, grid);
      if (!place) continue;
      FindSelfSimilarities(MatchOptions(), &*place);
      places.emplace(id, *std::move(place));
    }
    return places;
  }
  // All that matching says, in full precision.
  [[nodiscard]] std::string Recognize(
      const RecognitionOptions& options,
      const std::map<SubmapId, Place>& places) const {
    std::vector<std::pair<std::string, double>> seconds;
    StageClock clock({}, &seconds);
    std::ostringstream text;
    text.precision(17);
    for (const Match& match : RecognizeWithin(options, {&places, &odometry_},
                                              MakeExecutor(2), &clock)) {
      const Rigid2& pose = match.pair.T_reference_query;
      text << match.pair.reference << match.pair.query << pose.translation()
           << " " << pose.rotation() << " " << match.pair.score << " "
           << VerdictName(match.verdict) << " " << match.pair_score << " "
           << match.margin << " " << match.inliers.size() << " "
           << match.rivals.size() << " " << match.evidence.HitRatio() << " "
           << match.evidence.ContradictionRatio() << "\n";
    }
    return text.str();
  }

 private:
  std::map<SubmapId, OccupancyGrid> grids_;
  std::map<SubmapId, OdometryPose> odometry_;
};

std::string Text(const std::map<SubmapId, Place>& places) {
  std::ostringstream text;
  text.precision(9);
  for (const auto& [id, place] : places) {
    text << id << place.features.descriptors << " "
         << place.surface.walls.size() << " "
         << (*place.surface.cells.Pin())(place.surface.geometry.size.x() - 1, 0)
                .distance
         << " " << place.surface.geometry.size.transpose() << "\n";
    for (const Feature& feature : place.features.features) {
      text << feature.keypoint.clearance << " ";
    }
  }
  return text.str();
}

// What an index of all places proposes for each.
std::string Candidates(const RetrievalOptions& options,
                       const std::map<SubmapId, Place>& places) {
  PlaceIndex index(options);
  for (const auto& [id, place] : places) index.Add(id, place.features);
  std::ostringstream text;
  text.precision(17);
  for (const auto& [id, place] : places) {
    for (const RetrievalCandidate& candidate : index.Query(place.features)) {
      text << candidate.id << " " << candidate.score << " "
           << candidate.T_reference_query.size() << "\n";
    }
  }
  return text.str();
}

void KeepBadPoses(RecognitionOptions* const options) {
  options->verify_neighbourhoods = false;
  RankingOptions& ranking = options->match.verification.ranking;
  ranking.min_coarse_score = -10.;
  ranking.min_fine_score = -10.;
  ranking.max_fine_score_gap = 10.;
}

// What becomes of matches of three submaps, each with two others: farther apart
// by the way than by local SLAM, turned, and with leads from none to 5.
std::string RefusedRivals(const RivalMatchOptions& options) {
  const std::map<SubmapId, Place> places;
  std::map<SubmapId, OdometryPose> odometry = {
      {{0, 0}, {Rigid2(), 0.}}, {{0, 1}, {Rigid2(1., 0., 0.), 40.}}};
  const TrajectoryPlaces map{&places, &odometry};
  std::vector<Match> matches;
  // Each query has a trajectory of its own.
  const auto add = [&](const int trajectory, const Rigid2& pose,
                       const double lead) {
    odometry[{trajectory, 0}] = {};
    for (const int reference : {0, 1}) {
      Match match;
      match.pair = {{0, reference},
                    {trajectory, 0},
                    reference == 0 ? pose : Rigid2(-1., 0., 0.),
                    reference == 0 ? 8. : 8. - lead};
      match.verdict = Verdict::kAccepted;
      matches.push_back(match);
    }
  };
  int trajectory = 0;
  for (const double lead : {0., 1., 2., 5.}) {
    for (const double distance : {0.8, 1.7, 2.5, 3.6, 5., 20.}) {
      add(++trajectory, Rigid2(distance, 0., 0.), lead);
    }
    for (const double rotation : {0.2, 0.4, 0.7, 3.}) {
      add(++trajectory, Rigid2(0., 0., rotation), lead);
    }
  }
  RefuseRivalMatches(options, JudgementOptions(), {map, map, std::nullopt},
                     &matches);
  std::ostringstream text;
  for (const Match& match : matches) {
    text << VerdictName(match.verdict) << match.pair.score << " ";
  }
  return text.str();
}

// What becomes of matches between two drives along a corridor: of certain ones
// alone, and of likely ones at various distances from one.
std::string JudgedBySupport(const MatchSupportOptions& options) {
  const testing::CorridorMap corridor;
  std::ostringstream text;
  const auto judge = [&](std::vector<Match> matches) {
    JudgeBySupport(options, corridor.Between(), &matches);
    text << VerdictName(matches.back().verdict) << " ";
  };
  for (const double score : {5., 6.5, 7.5, 9.}) {
    judge({testing::AcceptedMatch(0, 0, Rigid2(), score)});
  }
  const auto judge_beside = [&](const int index, const Rigid2& pose,
                                const double score) {
    Match likely = testing::AcceptedMatch(index, index, pose, score);
    likely.verdict = Verdict::kUnlikely;
    judge({testing::AcceptedMatch(0, 0, Rigid2(), 20.), likely});
  };
  for (int index = 1; index < 10; ++index) judge_beside(index, Rigid2(), 3.);
  for (const double score : {0.5, 0.8, 1.2, 1.8}) {
    judge_beside(1, Rigid2(), score);
  }
  for (const double distance : {0.2, 0.45, 0.55, 0.9}) {
    judge_beside(1, Rigid2(distance, 0., 0.), 3.);
  }
  for (const double rotation : {0.05, 0.09, 0.11, 0.18}) {
    judge_beside(1, Rigid2(0., 0., rotation), 3.);
  }
  return text.str();
}

// How many matches there are where only accepted ones propose to others.
std::string SpreadMatches(const RecognitionOptions& options) {
  const testing::TwoVisits visits;
  const auto& places = *visits.Places().places;
  const std::optional<Match> west =
      MatchPlaces(options.match, places.at(testing::TwoVisits::kWestFirst),
                  places.at(testing::TwoVisits::kWestAgain));
  CHECK(west.has_value());
  NeighbourhoodOptions neighbourhood = options.neighbourhood;
  neighbourhood.max_num_rounds = 0;
  return std::to_string(
      VerifyNeighbourhoods(neighbourhood, options.match,
                           {visits.Places(), visits.Places(), 3}, {*west},
                           MakeExecutor(1))
          .size());
}

// How many matches there are of a place that was seen three times.
std::string MatchManyVisits(const RecognitionOptions& options) {
  const testing::ManyVisits visits(3);
  return std::to_string(
      VerifyNeighbourhoods(options.neighbourhood, options.match,
                           {visits.Places(), visits.Places(), 3},
                           visits.WestMatches(), MakeExecutor(1))
          .size());
}

TEST(OptionEffectsTest, OfPlaces) {
  const Drive drive;
  const std::vector<testing::Scenario<PlaceOptions>> scenarios = {
      {"",
       [&drive](const PlaceOptions& options) {
         return Text(drive.Describe(options));
       }},
      // Few and small places: a thousandth of the bound.
      {"max_field_megabytes", [&drive](const PlaceOptions& options) {
         std::map<SubmapId, Place> places = drive.Describe(options);
         PlaceOptions scaled = options;
         scaled.max_field_megabytes /= 1e3;
         FieldMemory memory(scaled);
         memory.Add(&places);
         return std::to_string(memory.NumBytes());
       }}};
  EXPECT_EQ(testing::OptionsWithoutEffect(PlaceOptions(), scenarios), "");
}

TEST(OptionEffectsTest, OfRecognition) {
  const Drive drive;
  const testing::DividedHall halls(4.);
  const std::map<SubmapId, Place> places = drive.Describe(PlaceOptions());
  // One whose matches only its neighbours propose.
  std::map<SubmapId, Place> featureless = places;
  featureless.at({0, 12}).features = FeatureSet();
  // Some act only where others have been set.
  const auto with = [&](void (*set)(RecognitionOptions*)) {
    return [&, set](const RecognitionOptions& options) {
      RecognitionOptions changed = options;
      set(&changed);
      return drive.Recognize(changed, places);
    };
  };
  const auto alone = with([](RecognitionOptions* options) {
    options->verify_neighbourhoods = false;
  });
  // An index that proposes nothing.
  const auto blind = with([](RecognitionOptions* options) {
    options->verify_neighbourhoods = false;
    options->retrieval.pairs.min_length_meters = 1e3;
    options->retrieval.pairs.max_length_meters = 2e3;
  });
  const auto by_paper = with([](RecognitionOptions* options) {
    options->match.method = Method::kPaper;
  });
  const std::vector<testing::Scenario<RecognitionOptions>> scenarios = {
      {"",
       [&](const RecognitionOptions& options) {
         return drive.Recognize(options, places);
       }},
      {"match.", alone},
      {"match.verification.screening.", with(&KeepBadPoses)},
      {"match.verification.screening.max_score_gap",
       with([](RecognitionOptions* options) {
         KeepBadPoses(options);
         options->match.verification.screening.min_score = -1e6;
       })},
      {"match.verification.crossing.",
       [&halls](const RecognitionOptions& options) {
         std::vector<Match> matches = {testing::DividedHall::MakeMatch(9.)};
         RefuseCrossedGroups(options.match.verification, options.neighbourhood,
                             options.support, halls.Maps(), MakeExecutor(1),
                             &matches);
         return std::string(VerdictName(matches[0].verdict));
       }},
      {"use_retrieval", blind},
      {"match.correspondence.max_ratio", with([](RecognitionOptions* options) {
         options->match.correspondence.use_ratio_test = true;
       })},
      {"match.ransac.", by_paper},
      {"match.min_num_inliers", by_paper},
      {"match.seed", by_paper},
      {"links.",
       [](const RecognitionOptions& options) {
         const testing::SlippedVisit visit{testing::TwoVisits()};
         std::ostringstream text;
         const TrajectoryLinks links(options.links, options.match.verification,
                                     visit.Places(), MakeExecutor(1));
         for (const SubmapId& id : links.broken()) {
           text << id;
         }
         return text.str();
       }},
      {"rivals.",
       [](const RecognitionOptions& options) {
         return RefusedRivals(options.rivals);
       }},
      {"support.",
       [](const RecognitionOptions& options) {
         return JudgedBySupport(options.support);
       }},
      {"neighbourhood.",
       [&](const RecognitionOptions& options) {
         RecognitionOptions generous = options;
         generous.neighbourhood.weights.bias += 50.;
         return drive.Recognize(options, places) +
                drive.Recognize(generous, places) +
                drive.Recognize(generous, featureless);
       }},
      {"neighbourhood.max_proposal_index_distance", &SpreadMatches},
      {"neighbourhood.max_num_matches_per_submap", &MatchManyVisits},
      {"retrieval.",
       [&](const RecognitionOptions& options) {
         RetrievalOptions retrieval = options.retrieval;
         retrieval.min_num_candidates = 1;
         return Candidates(retrieval, places);
       }},
      {"retrieval.min_num_candidates",
       [&](const RecognitionOptions& options) {
         RetrievalOptions retrieval = options.retrieval;
         retrieval.min_score = 1e9;
         retrieval.min_num_candidates =
             1 + options.retrieval.min_num_candidates / 11;
         return Candidates(retrieval, places);
       }},
      {"retrieval.max_num_candidates",
       [&](const RecognitionOptions& options) {
         RetrievalOptions retrieval = options.retrieval;
         retrieval.min_num_candidates = 1;
         retrieval.max_num_candidates =
             1 + options.retrieval.max_num_candidates / 201;
         return Candidates(retrieval, places);
       }},
  };
  EXPECT_EQ(testing::OptionsWithoutEffect(RecognitionOptions(), scenarios), "");
}

// Passes over the tables whose options have a test that walks through all of
// them, and lists all other options.
class UntestedOptions : public OptionVisitor {
 public:
  [[nodiscard]] const std::string& paths() const { return paths_; }

 private:
  void Visit(const char* const key, double& /*option*/) override { Add(key); }
  void Visit(const char* const key, int& /*option*/) override { Add(key); }
  void Visit(const char* const key, bool& /*option*/) override { Add(key); }
  void VisitName(const char* const key,
                 const std::vector<std::string>& /*names*/,
                 int& /*index*/) override {
    Add(key);
  }
  bool Enter(const char* const key) override {
    const std::string path = outer_ + key;
    const std::set<std::string> tested = {
        // Above.
        "loop_closing.place", "loop_closing.recognition",
        // closing_option_effects_test.cc
        "loop_closing.closing",
        // localization_option_effects_test.cc
        "localization", "scan_places", "scan_localization", "scan_session",
        "session_links", "fold_check",
        // audit_option_effects_test.cc
        "audit", "report"};
    if (tested.count(path) > 0) return false;
    lengths_.push_back(outer_.size());
    outer_ = path + ".";
    return true;
  }
  void Leave(const std::string& /*problem*/) override {
    outer_.resize(lengths_.back());
    lengths_.pop_back();
  }
  void Add(const std::string& key) { paths_ += outer_ + key + "\n"; }

  std::string outer_;
  std::vector<size_t> lengths_;
  std::string paths_;
};

TEST(OptionEffectsTest, EveryTableHasATest) {
  Options options;
  UntestedOptions untested;
  VisitOptions(untested, options);
  EXPECT_EQ(untested.paths(), "");
}

}  // namespace
}  // namespace cartographer_sdf::option_effects_test
