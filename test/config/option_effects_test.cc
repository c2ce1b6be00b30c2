// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// No option of describing and recognising places is without effect.

#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "cartographer_sdf/config/option_keys.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/matching/place_index.h"
#include "cartographer_sdf/recognition/recognize.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"

namespace cartographer_sdf::option_effects_test {
namespace {

// Counts the leaves of a struct of options, and gives one of them another
// value: each attempt is another way to change it.
class LeafChanger : public OptionVisitor {
 public:
  LeafChanger(const int leaf, const int attempt)
      : leaf_(leaf), attempt_(attempt) {}

  static constexpr int kNumAttempts = 9;

  [[nodiscard]] int num_leaves() const { return num_leaves_; }
  [[nodiscard]] const std::string& chosen() const { return chosen_; }

 private:
  void Visit(const char* const key, double& option) override {
    constexpr double kFactors[kNumAttempts] = {0.5, 2.,  0.1,  10., 0.,
                                               -1., 1e3, 1e-3, -10.};
    if (!IsChosen(key)) return;
    option = option == 0. ? kFactors[attempt_] : option * kFactors[attempt_];
  }
  void Visit(const char* const key, int& option) override {
    if (!IsChosen(key)) return;
    const int values[kNumAttempts] = {option / 2,  2 * option, 1,
                                      option + 1,  option - 1, 0,
                                      50 * option, 3,          7};
    option = values[attempt_];
  }
  void Visit(const char* const key, bool& option) override {
    if (IsChosen(key)) option = !option;
  }
  void VisitName(const char* const key, const std::vector<std::string>& names,
                 int& index) override {
    if (IsChosen(key)) {
      index = (index + 1) % static_cast<int>(names.size());
    }
  }
  bool Enter(const char* const key) override {
    tables_.emplace_back(key);
    return true;
  }
  void Leave(const std::string&) override { tables_.pop_back(); }
  bool IsChosen(const char* const key) {
    if (num_leaves_++ != leaf_) return false;
    for (const std::string& table : tables_) chosen_ += table + ".";
    chosen_ += key;
    return true;
  }

  const int leaf_;
  const int attempt_;
  int num_leaves_ = 0;
  std::vector<std::string> tables_;
  std::string chosen_;
};

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
         << place.surface.cells(place.surface.geometry.size.x() - 1, 0).distance
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
      text << candidate.id << " " << candidate.score << "\n";
    }
  }
  return text.str();
}

// The leaves of `options` that change no outcome in any attempt. `outcome`
// gives one or more texts.
template <typename Options, typename Outcome>
std::vector<std::string> LeavesWithoutEffect(const Options& options,
                                             const Outcome& outcome) {
  Options copy = options;
  LeafChanger counter(-1, 0);
  VisitOptions(counter, copy);
  const auto before = outcome(options);
  std::vector<std::string> idle;
  for (int leaf = 0; leaf < counter.num_leaves(); ++leaf) {
    bool has_effect = false;
    std::string path;
    for (int attempt = 0; attempt < LeafChanger::kNumAttempts && !has_effect;
         ++attempt) {
      Options changed = options;
      LeafChanger changer(leaf, attempt);
      VisitOptions(changer, changed);
      path = changer.chosen();
      has_effect = Validate(changed).empty() && outcome(changed) != before;
    }
    if (!has_effect) idle.push_back(path);
  }
  return idle;
}

std::string Listed(const std::vector<std::string>& paths) {
  std::string text;
  for (const std::string& path : paths) text += path + "\n";
  return text;
}

TEST(OptionEffectsTest, OfPlaces) {
  const Drive drive;
  const std::vector<std::string> idle = LeavesWithoutEffect(
      PlaceOptions(), [&drive](const PlaceOptions& options) {
        return Text(drive.Describe(options));
      });
  EXPECT_EQ(Listed(idle), "");
}

TEST(OptionEffectsTest, OfRecognition) {
  const Drive drive;
  const std::map<SubmapId, Place> places = drive.Describe(PlaceOptions());
  // One whose matches only its neighbours propose.
  std::map<SubmapId, Place> featureless = places;
  featureless.at({0, 12}).features = FeatureSet();
  const auto outcome = [&](const RecognitionOptions& options) {
    // Some act only where others have been set.
    RecognitionOptions blind = options;
    blind.verify_neighbourhoods = false;
    blind.retrieval.votes.min_baseline_meters = 1e3;
    RecognitionOptions generous = options;
    generous.neighbourhood.weights.bias += 50.;
    RecognitionOptions by_paper = options;
    by_paper.match.method = Method::kPaper;
    RecognitionOptions by_ratio = options;
    by_ratio.match.correspondence.use_ratio_test = true;
    std::string text;
    for (const RecognitionOptions& variant :
         {options, blind, generous, by_paper, by_ratio}) {
      text += drive.Recognize(variant, places) + "\n";
    }
    text += drive.Recognize(generous, featureless);
    RetrievalOptions retrieval = options.retrieval;
    retrieval.min_num_candidates = 1;
    text += Candidates(retrieval, places);
    retrieval.max_num_candidates =
        1 + options.retrieval.max_num_candidates / 201;
    text += Candidates(retrieval, places);
    retrieval = options.retrieval;
    retrieval.min_score = 1e9;
    retrieval.min_num_candidates =
        1 + options.retrieval.min_num_candidates / 11;
    return text + Candidates(retrieval, places);
  };
  EXPECT_EQ(Listed(LeavesWithoutEffect(RecognitionOptions(), outcome)), "");
}

}  // namespace
}  // namespace cartographer_sdf::option_effects_test
