// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/localizer.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/geometry/evenly_spaced.h"
#include "cartographer_sdf/localization/compared_numbers.h"
#include "cartographer_sdf/localization/rival_placements.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

bool ByIds(const Match& a, const Match& b) {
  return IsBeforeByIds(a.pair, b.pair);
}

// Describes where in the map the strongest vote of a placement puts its place.
std::string DescribeWhere(const MapLayout& map,
                          const std::vector<Match>& matches,
                          const Placement& placement) {
  const size_t strongest =
      *std::max_element(placement.votes.begin(), placement.votes.end(),
                        [&matches](const size_t a, const size_t b) {
                          return matches[a].pair.score < matches[b].pair.score;
                        });
  const PairPose& pair = matches[strongest].pair;
  const Rigid2 T_map_submap =
      map.T_map_submap.at(pair.reference) * pair.T_reference_query;
  constexpr double kDegree = M_PI / 180.;
  // Half-turn rivals differ in nothing else.
  return absl::StrFormat("(%.1f, %.1f) m, %.0f deg in submap %d,%d",
                         T_map_submap.translation().x(),
                         T_map_submap.translation().y(),
                         T_map_submap.rotation() / kDegree,
                         pair.reference.trajectory, pair.reference.index);
}

std::string DescribeTooLittle(const double area, const double min_area) {
  const ComparedNumbers compared = FormatCompared(area, min_area, 0);
  return absl::StrFormat("too little was seen: %s m2, %s are needed",
                         compared.number, compared.threshold);
}

std::string DescribeLowScore(const double score, const double min_score,
                             const std::string& where) {
  const ComparedNumbers compared = FormatCompared(score, min_score, 2);
  return absl::StrFormat(
      "too little agrees: score %s at %s, %s is needed; more of the place must "
      "be seen",
      compared.number, where, compared.threshold);
}

class Localizer {
 public:
  Localizer(const LocalizationOptions& options, const LocalizationTask& task,
            const PlaceMatcher& match_places, const Executor& executor,
            const StageCallback& on_stage)
      : options_(options),
        task_(task),
        match_places_(match_places),
        executor_(executor),
        clock_(on_stage, &result_.stage_seconds) {}

  Localization Run() {
    double area = 0.;
    for (const auto& [id, place] : *task_.query.places) {
      area += ObservedArea(place.surface);
    }
    if (task_.query.places->empty() ||
        area < task_.placement.min_observed_area) {
      Refuse(LocalizationVerdict::kTooLittleSeen,
             DescribeTooLittle(area, task_.placement.min_observed_area));
    } else {
      Search();
    }
    clock_.End();
    return std::move(result_);
  }

 private:
  // All places of the query: evenly spaced ones first, then those between.
  [[nodiscard]] std::vector<std::map<SubmapId, Place>> Rounds() const {
    std::vector<const Place*> places;
    for (const auto& [id, place] : *task_.query.places)
      places.push_back(&place);
    std::vector<std::map<SubmapId, Place>> rounds;
    std::set<size_t> done;
    for (size_t count = static_cast<size_t>(options_.num_first_places);
         done.size() < places.size(); count *= 2) {
      std::map<SubmapId, Place> round;
      for (const size_t index : EvenlySpacedIndices(places.size(), count)) {
        if (done.insert(index).second) {
          round.emplace(places[index]->id, *places[index]);
        }
      }
      if (!round.empty()) rounds.push_back(std::move(round));
    }
    return rounds;
  }

  // Searches round by round, until the answer is certain.
  void Search() {
    for (const std::map<SubmapId, Place>& places : Rounds()) {
      std::vector<Match> voting;
      num_ambiguous_ = 0;
      for (Match& match : match_places_(places, clock_.Begin("match"))) {
        // Likely, except for the rival.
        num_ambiguous_ +=
            match.verdict == Verdict::kAmbiguous &&
            match.pair.score >= task_.match.verification.judgement.min_score;
        if (Votes(match)) voting.push_back(std::move(match));
      }
      std::stable_sort(voting.begin(), voting.end(), &ByIds);
      result_.matches = std::move(voting);
      result_.contradictions.clear();
      result_.crossing_walls.clear();
      result_.num_compared = 0;
      clock_.Begin("vote");
      Vote();
      Decide();
      if (result_.verdict != LocalizationVerdict::kLocalized) continue;
      clock_.Begin("confirm");
      Confirm();
      Decide();
      if (result_.verdict != LocalizationVerdict::kLocalized) continue;
      clock_.Begin("ask for rivals");
      AskForRivals();
      if (result_.verdict == LocalizationVerdict::kLocalized) return;
    }
  }

  [[nodiscard]] bool Votes(const Match& match) const {
    return IsLikely(match.verdict) ||
           (options_.count_likely_matches &&
            match.verdict == Verdict::kUnlikely && match.pair.score > 0.);
  }

  // A placement is support by itself.
  [[nodiscard]] bool HasLikelyVote(const Placement& placement) const {
    return std::any_of(placement.votes.begin(), placement.votes.end(),
                       [this](const size_t vote) {
                         return IsLikely(result_.matches[vote].verdict);
                       });
  }

  void Vote() {
    std::vector<PairPose> pairs;
    for (const Match& match : result_.matches) pairs.push_back(match.pair);
    result_.placements = FindPlacements(task_.placement, task_.consistency,
                                        task_.layouts(), pairs);
  }

  [[nodiscard]] std::vector<PairPose> PairsOfBest() const {
    std::vector<PairPose> pairs;
    for (const Match& match : VotesForBest()) pairs.push_back(match.pair);
    return pairs;
  }

  void Confirm() {
    Confirmation confirmation = ConfirmPlacement(
        task_, PairsOfBest(),
        static_cast<size_t>(options_.max_num_confirmed_pairs), executor_);
    result_.contradictions = std::move(confirmation.contradicting);
    result_.crossing_walls = std::move(confirmation.crossing_walls);
    result_.num_compared = confirmation.num_compared;
    if (confirmation.agreeing.empty()) return;
    // A pair matched elsewhere and confirmed here has two matches.
    for (Match& match : confirmation.agreeing) {
      result_.matches.push_back(std::move(match));
    }
    std::stable_sort(result_.matches.begin(), result_.matches.end(), &ByIds);
    Vote();
  }

  [[nodiscard]] std::vector<Match> VotesForBest() const {
    std::vector<Match> votes;
    for (const size_t vote : result_.placements.front().votes) {
      votes.push_back(result_.matches[vote]);
    }
    return votes;
  }

  // Refuses the placement if others do as well on what both maps show.
  void AskForRivals() {
    Contest contest = FindRivalPlacements(
        task_, PairsOfBest(),
        static_cast<size_t>(options_.max_num_confirmed_pairs), executor_);
    if (contest.rivals.empty()) return;
    // Without a pair that says anything by itself, it keeps its votes.
    Placement& best = result_.placements.front();
    if (contest.placement.placement.votes.empty()) {
      best.score = 0.;
    } else {
      best = Adopt(std::move(contest.placement));
    }
    result_.placements.resize(1);
    for (MeasuredPlacement& rival : contest.rivals) {
      result_.placements.push_back(Adopt(std::move(rival)));
    }
    std::stable_sort(result_.placements.begin(), result_.placements.end(),
                     [](const Placement& a, const Placement& b) {
                       return a.score > b.score;
                     });
    for (Placement& placement : result_.placements) {
      placement.is_rival = &placement != &result_.placements.front();
    }
    const Placement* const rival = CountVotes();
    result_.T_map_query.reset();
    result_.parts = {};
    RefuseAmbiguous(*rival,
                    "; the place repeats itself, and both suit what was seen");
  }

  // Takes over the matches of a measured placement.
  Placement Adopt(MeasuredPlacement measured) {
    for (size_t& vote : measured.placement.votes) {
      vote += result_.matches.size();
    }
    std::move(measured.confirmation.agreeing.begin(),
              measured.confirmation.agreeing.end(),
              std::back_inserter(result_.matches));
    return std::move(measured.placement);
  }

  void RefuseAmbiguous(const Placement& rival, const std::string& why) {
    const Placement& best = result_.placements.front();
    const auto where = [this](const Placement& placement) {
      return DescribeWhere(*task_.map.layout, result_.matches, placement);
    };
    Refuse(LocalizationVerdict::kAmbiguous,
           absl::StrFormat("ambiguous between %s (score %.1f) and %s (%.1f)%s",
                           where(best), best.score, where(rival), rival.score,
                           why));
  }

  void Refuse(const LocalizationVerdict verdict, const std::string& reason) {
    result_.verdict = verdict;
    result_.reason = reason;
  }

  void Accept(const Placement& placement) {
    result_.verdict = LocalizationVerdict::kLocalized;
    result_.reason =
        absl::StrFormat("%d matches of submaps agree", placement.votes.size());
    result_.T_map_query = placement.T_map_query;
    std::vector<PairPose> votes;
    for (const Match& match : result_.matches) votes.push_back(match.pair);
    result_.parts = FindQueryParts(task_.placement, task_.consistency,
                                   task_.layouts(), votes, result_.placements);
    if (!result_.parts.jumps.empty()) {
      result_.reason += "; " + DescribeJumps(result_.parts.jumps);
    }
  }

  void RefuseWithoutPlacement() {
    if (num_ambiguous_ > 0) {
      Refuse(LocalizationVerdict::kAmbiguous,
             absl::StrFormat("ambiguous: %d pairs of submaps are alike, but "
                             "in more than one pose each",
                             num_ambiguous_));
    } else {
      Refuse(LocalizationVerdict::kNothingAlike,
             "nothing alike: no submap of the query was found in the map");
    }
  }

  // Counts the votes for and against the best placement; returns its best
  // rival, null if it has none.
  const Placement* CountVotes() {
    const Placement& best = result_.placements.front();
    const Placement* rival = nullptr;
    result_.num_agreeing = static_cast<int>(best.votes.size());
    result_.num_contradicting = static_cast<int>(result_.contradictions.size());
    for (const Placement& placement : result_.placements) {
      if (!placement.is_rival) continue;
      if (rival == nullptr) rival = &placement;
      result_.num_contradicting += static_cast<int>(placement.votes.size());
    }
    result_.score = best.score;
    if (rival != nullptr) result_.runner_up_score = rival->score;
    return rival;
  }

  [[nodiscard]] std::string DescribeCrossing(const std::string& where) const {
    const CrossingWall& longest = *std::max_element(
        result_.crossing_walls.begin(), result_.crossing_walls.end(),
        [](const CrossingWall& a, const CrossingWall& b) {
          return a.length < b.length;
        });
    return absl::StrFormat(
        "contradicted: alike at %s, but walls of one map stand across the free "
        "space of the other in %d of %d pairs of submaps, up to %.1f m long in "
        "submap %d,%d and submap %d,%d of the query",
        where, result_.crossing_walls.size(), result_.num_compared,
        longest.length, longest.reference.trajectory, longest.reference.index,
        longest.query.trajectory, longest.query.index);
  }

  // With so much evidence it is as good a reason to doubt as one just behind.
  [[nodiscard]] bool IsCertainRival(const Placement& best,
                                    const Placement& rival) const {
    return rival.score >= task_.placement.min_score &&
           rival.score >= kRivalShare * best.score;
  }

  void Decide() {
    const PlacementOptions& options = task_.placement;
    result_.T_map_query.reset();
    result_.parts = {};
    result_.runner_up_score.reset();
    if (result_.placements.empty()) return RefuseWithoutPlacement();
    const Placement& best = result_.placements.front();
    const Placement* const rival = CountVotes();
    const std::string where =
        DescribeWhere(*task_.map.layout, result_.matches, best);
    const double fraction =
        ContradictingFraction(VotesForBest(), result_.contradictions);
    if (!HasLikelyVote(best)) {
      Refuse(LocalizationVerdict::kUncertain,
             absl::StrFormat("too little agrees: no match at %s is certain by "
                             "itself; more of the place must be seen",
                             where));
    } else if (best.score < options.min_score) {
      Refuse(LocalizationVerdict::kUncertain,
             DescribeLowScore(best.score, options.min_score, where));
    } else if (fraction > options.max_contradicting_fraction) {
      Refuse(LocalizationVerdict::kContradicted,
             absl::StrFormat("contradicted: alike at %s, but the surroundings "
                             "of %.0f %% of the places do not match",
                             where, 100. * fraction));
    } else if (IsCrossed(task_.match.verification.crossing,
                         result_.crossing_walls.size(), result_.num_compared)) {
      Refuse(LocalizationVerdict::kContradicted, DescribeCrossing(where));
    } else if (rival != nullptr &&
               (best.score - rival->score < options.min_lead ||
                IsCertainRival(best, *rival))) {
      RefuseAmbiguous(*rival, "");
    } else {
      Accept(best);
    }
  }

  const LocalizationOptions& options_;
  const LocalizationTask& task_;
  const PlaceMatcher& match_places_;
  const Executor& executor_;
  int num_ambiguous_ = 0;
  Localization result_;
  StageClock clock_;
};

}  // namespace

std::string Validate(const LocalizationOptions& options) {
  if (const std::string error = Validate(options.placement); !error.empty()) {
    return error;
  }
  if (options.num_first_places < 1) {
    return "num_first_places must be positive";
  }
  if (options.max_num_confirmed_pairs < 0) {
    return "max_num_confirmed_pairs must not be negative";
  }
  return "";
}

const char* LocalizationVerdictName(const LocalizationVerdict verdict) {
  // In the order of the enumerators.
  constexpr const char* kNames[] = {
      "localized", "too_little_seen", "nothing_alike", "uncertain",
      "ambiguous", "contradicted",    "no_map",        "finished"};
  static_assert(std::size(kNames) ==
                static_cast<size_t>(LocalizationVerdict::kFinished) + 1);
  return kNames[static_cast<size_t>(verdict)];
}

Localization Localize(const LocalizationOptions& options,
                      const ConsistencyOptions& consistency,
                      const MatchOptions& match_options, const PlacedMap& map,
                      const PlacedMap& query, const PlaceMatcher& match_places,
                      const Executor& executor, const StageCallback& on_stage) {
  CHECK_EQ(Validate(options), "");
  CHECK(match_options.method == Method::kSdf)
      << "the paper's method verifies nothing";
  const LocalizationTask task{options.placement, consistency, match_options,
                              map, query};
  return Localizer(options, task, match_places, executor, on_stage).Run();
}

}  // namespace cartographer_sdf
