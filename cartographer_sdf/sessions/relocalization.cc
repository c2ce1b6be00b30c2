// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/sessions/relocalization.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/sessions/pose_check.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

double TotalArea(const DescribedMap& map) {
  double area = 0.;
  for (const auto& [id, place] : map.places) area += ObservedArea(place);
  return area;
}

bool ByIds(const Match& a, const Match& b) {
  return std::tie(a.closure.reference, a.closure.query) <
         std::tie(b.closure.reference, b.closure.query);
}

std::vector<LoopClosure> ClosuresOf(const std::vector<Match>& matches) {
  std::vector<LoopClosure> closures;
  for (const Match& match : matches) closures.push_back(match.closure);
  return closures;
}

// Where in the map a placement's strongest vote puts its place.
std::string DescribeWhere(const DescribedMap& map,
                          const std::vector<Match>& matches,
                          const Placement& placement) {
  const LoopClosure* strongest = nullptr;
  for (const size_t vote : placement.votes) {
    const LoopClosure& closure = matches[vote].closure;
    if (strongest == nullptr || closure.score > strongest->score) {
      strongest = &closure;
    }
  }
  const Rigid2 T_map_submap =
      map.state.pose_graph.submap_poses.at(strongest->reference) *
      strongest->T_reference_query;
  return absl::StrFormat(
      "(%.1f, %.1f) m in submap %d,%d", T_map_submap.translation().x(),
      T_map_submap.translation().y(), strongest->reference.trajectory,
      strongest->reference.index);
}

class Relocalizer {
 public:
  Relocalizer(const RelocalizationOptions& options,
              const LoopClosingOptions& stages, const DescribedMap& map,
              const DescribedMap& query, const Executor& executor,
              const StageCallback& on_stage)
      : options_(options),
        stages_(stages),
        map_(map),
        query_(query),
        executor_(executor),
        clock_(on_stage, &result_.stage_seconds) {}

  Relocalization Run() {
    const double area = TotalArea(query_);
    if (query_.places.empty() || area < options_.placement.min_observed_area) {
      Refuse(RelocalizationVerdict::kTooLittleSeen,
             absl::StrFormat("too little was seen: %.0f m2, %.0f are needed",
                             area, options_.placement.min_observed_area));
      return std::move(result_);
    }
    const MapPair maps(map_.state, query_.state);
    maps_ = &maps;
    Search();
    clock_.End();
    return std::move(result_);
  }

 private:
  // All places of the query, those first that are searched first: every one at
  // an even spacing, then those between.
  [[nodiscard]] std::vector<std::map<SubmapId, Place>> Rounds() const {
    std::vector<const Place*> places;
    for (const auto& [id, place] : query_.places) places.push_back(&place);
    std::vector<std::map<SubmapId, Place>> rounds;
    std::set<size_t> done;
    for (size_t count = static_cast<size_t>(options_.num_first_places);
         done.size() < places.size(); count *= 2) {
      std::map<SubmapId, Place>& round = rounds.emplace_back();
      const size_t num = std::min(count, places.size());
      for (size_t k = 0; k < num; ++k) {
        // The middles of equal parts.
        const size_t index = (2 * k + 1) * places.size() / (2 * num);
        if (done.insert(index).second) {
          round.emplace(places[index]->id, *places[index]);
        }
      }
    }
    return rounds;
  }

  void Search() {
    std::vector<Match> found;
    for (const std::map<SubmapId, Place>& places : Rounds()) {
      if (places.empty()) continue;
      std::vector<Match> matches =
          MatchBetween(stages_.match, std::nullopt, map_.places, places,
                       executor_, clock_.Begin("match"));
      for (Match& match : matches) {
        // Likely, but for the rival.
        num_ambiguous_ +=
            match.verdict == Verdict::kAmbiguous &&
            match.closure.score >= stages_.match.verification.min_score;
        if (match.verdict == Verdict::kAccepted) {
          found.push_back(std::move(match));
        }
      }
      std::stable_sort(found.begin(), found.end(), &ByIds);
      result_.matches = found;
      result_.contradictions.clear();
      clock_.Begin("vote");
      Vote();
      Decide();
      if (result_.verdict != RelocalizationVerdict::kLocalized) continue;
      clock_.Begin("confirm");
      Confirm();
      Decide();
      if (result_.verdict == RelocalizationVerdict::kLocalized) return;
    }
  }

  void Vote() {
    result_.placements = FindPlacements(options_.placement, stages_.consistency,
                                        *maps_, ClosuresOf(result_.matches));
  }

  void Confirm() {
    Confirmation confirmation = ConfirmPlacement(
        options_.placement, stages_.consistency, stages_.match, *maps_,
        map_.places, query_.places, ClosuresOf(result_.matches),
        result_.placements.front(),
        static_cast<size_t>(options_.max_num_confirmed_pairs), executor_);
    result_.contradictions = std::move(confirmation.contradicting);
    if (confirmation.agreeing.empty()) return;
    // What was matched elsewhere and is confirmed here has two matches.
    for (Match& match : confirmation.agreeing) {
      result_.matches.push_back(std::move(match));
    }
    std::stable_sort(result_.matches.begin(), result_.matches.end(), &ByIds);
    Vote();
  }

  // Of the places that the best placement puts into what the map has seen, the
  // fraction that contradicts it.
  [[nodiscard]] double ContradictingFraction() const {
    std::set<SubmapId> agreeing, contradicting;
    for (const size_t vote : result_.placements.front().votes) {
      agreeing.insert(result_.matches[vote].closure.query);
    }
    for (const Match& match : result_.contradictions) {
      if (agreeing.count(match.closure.query) == 0) {
        contradicting.insert(match.closure.query);
      }
    }
    return static_cast<double>(contradicting.size()) /
           static_cast<double>(agreeing.size() + contradicting.size());
  }

  void Refuse(const RelocalizationVerdict verdict, const std::string& reason) {
    result_.verdict = verdict;
    result_.reason = reason;
  }

  void Decide() {
    const PlacementOptions& options = options_.placement;
    result_.T_map_query.reset();
    result_.runner_up_score.reset();
    if (result_.placements.empty()) {
      if (num_ambiguous_ > 0) {
        Refuse(RelocalizationVerdict::kAmbiguous,
               absl::StrFormat("ambiguous: %d pairs of submaps are alike, but "
                               "in more than one pose each",
                               num_ambiguous_));
      } else {
        Refuse(RelocalizationVerdict::kNothingAlike,
               "nothing alike: no submap of the query was found in the map");
      }
      return;
    }
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
    const double fraction = ContradictingFraction();
    if (best.score < options.min_score) {
      Refuse(RelocalizationVerdict::kUncertain,
             absl::StrFormat(
                 "too little agrees: score %.1f at %s, %.1f is needed; more of "
                 "the place must be seen",
                 best.score, DescribeWhere(map_, result_.matches, best),
                 options.min_score));
    } else if (fraction > options.max_contradicting_fraction) {
      Refuse(RelocalizationVerdict::kContradicted,
             absl::StrFormat("contradicted: alike at %s, but what should be "
                             "near there is not, of %.0f %% of the places",
                             DescribeWhere(map_, result_.matches, best),
                             100. * fraction));
    } else if (rival != nullptr &&
               best.score - rival->score < options.min_lead) {
      Refuse(RelocalizationVerdict::kAmbiguous,
             absl::StrFormat(
                 "ambiguous between %s (score %.1f) and %s (%.1f)",
                 DescribeWhere(map_, result_.matches, best), best.score,
                 DescribeWhere(map_, result_.matches, *rival), rival->score));
    } else {
      result_.verdict = RelocalizationVerdict::kLocalized;
      result_.reason =
          absl::StrFormat("%d matches of submaps agree", best.votes.size());
      result_.T_map_query = best.T_map_query;
    }
  }

  const RelocalizationOptions& options_;
  const LoopClosingOptions& stages_;
  const DescribedMap& map_;
  const DescribedMap& query_;
  const Executor& executor_;
  const MapPair* maps_ = nullptr;
  int num_ambiguous_ = 0;
  Relocalization result_;
  StageClock clock_;
};

}  // namespace

std::string Validate(const RelocalizationOptions& options) {
  for (const std::string& error :
       {Validate(options.placement), Validate(options.scan_places)}) {
    if (!error.empty()) return error;
  }
  if (options.num_first_places < 1) {
    return "num_first_places must be positive";
  }
  if (options.max_num_confirmed_pairs < 0) {
    return "max_num_confirmed_pairs must not be negative";
  }
  return "";
}

const char* RelocalizationVerdictName(const RelocalizationVerdict verdict) {
  switch (verdict) {
    case RelocalizationVerdict::kLocalized:
      return "localized";
    case RelocalizationVerdict::kTooLittleSeen:
      return "too_little_seen";
    case RelocalizationVerdict::kNothingAlike:
      return "nothing_alike";
    case RelocalizationVerdict::kUncertain:
      return "uncertain";
    case RelocalizationVerdict::kAmbiguous:
      return "ambiguous";
    case RelocalizationVerdict::kContradicted:
      return "contradicted";
  }
  LOG(FATAL) << "not a verdict: " << static_cast<int>(verdict);
}

Relocalization Relocalize(const RelocalizationOptions& options,
                          const LoopClosingOptions& stages,
                          const DescribedMap& map, const DescribedMap& query,
                          const Executor& executor,
                          const StageCallback& on_stage) {
  CHECK_EQ(Validate(options), "");
  CHECK_EQ(Validate(stages), "");
  CHECK(stages.match.method == Method::kSdf)
      << "the paper's method verifies nothing";
  return Relocalizer(options, stages, map, query, executor, on_stage).Run();
}

absl::StatusOr<Session> DescribeSession(const RelocalizationOptions& options,
                                        const LoopClosingOptions& stages,
                                        const std::string& path,
                                        const std::optional<TimeWindow>& window,
                                        const Executor& executor,
                                        const ProgressCallback& on_progress) {
  if (window) {
    const absl::StatusOr<MapState> state = ReadMap(path, {}, on_progress);
    if (!state.ok()) return state.status();
    absl::StatusOr<ScanMap> scans =
        DescribeScans(options.scan_places, stages.place, stages.match, path,
                      *state, *window, executor);
    if (!scans.ok()) return scans.status();
    return Session{path, std::move(scans->map), std::move(scans->grids)};
  }
  absl::StatusOr<DescribedMap> map =
      DescribeMap(stages.place, stages.match, path, executor, on_progress);
  if (!map.ok()) return map.status();
  std::set<int> without_submaps(map->state.trajectories.begin(),
                                map->state.trajectories.end());
  for (const auto& [id, submap] : map->state.submaps) {
    without_submaps.erase(id.trajectory);
  }
  Session session{path, *std::move(map), {}};
  if (without_submaps.empty()) return session;
  absl::StatusOr<ScanMap> scans =
      DescribeScans(options.scan_places, stages.place, stages.match, path,
                    session.map.state, TimeWindow(), executor, without_submaps);
  if (!scans.ok()) return scans.status();
  // A submap may be in the pose graph without a record of its own; it is not
  // replaced.
  std::set<SubmapId> added;
  PoseGraph& graph = session.map.state.pose_graph;
  for (const auto& [id, pose] : scans->map.state.pose_graph.submap_poses) {
    if (!graph.submap_poses.emplace(id, pose).second) continue;
    added.insert(id);
    session.map.state.submaps[id] = scans->map.state.submaps.at(id);
  }
  for (const Constraint& constraint : scans->map.state.pose_graph.constraints) {
    if (added.count(constraint.submap) > 0) {
      graph.constraints.push_back(constraint);
    }
  }
  for (const SubmapId& id : added) {
    session.scan_grids.emplace(id, std::move(scans->grids.at(id)));
    const auto place = scans->map.places.find(id);
    if (place != scans->map.places.end()) {
      session.map.places.emplace(id, std::move(place->second));
    }
  }
  return session;
}

}  // namespace cartographer_sdf
