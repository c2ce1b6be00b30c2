// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/session_json.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace cartographer_sdf {
namespace {

constexpr size_t kMaxNumPlacements = 10;

// Flat: the members of the pose are among the others.
Json MatchJson(const Match& match) {
  const PairPose& pair = match.pair;
  Json json = {{"reference_trajectory", pair.reference.trajectory},
               {"reference_index", pair.reference.index},
               {"query_trajectory", pair.query.trajectory},
               {"query_index", pair.query.index},
               {"score", pair.score}};
  json.update(ToJson(pair.T_reference_query));
  json.update({{"overlap", match.evidence.overlap},
               {"hit_ratio", match.evidence.HitRatio()},
               {"contradiction_ratio", match.evidence.ContradictionRatio()}});
  return json;
}

// The matches that vote for the answer; none where there is no answer.
Json VotesJson(const Localization& result) {
  Json votes = Json::array();
  if (!result.T_map_query) return votes;
  for (const size_t vote : result.placements.front().votes) {
    votes.push_back(MatchJson(result.matches[vote]));
  }
  return votes;
}

// Where else it might be; the best few.
Json PlacementsJson(const std::vector<Placement>& placements) {
  Json json = Json::array();
  for (size_t k = 0; k < std::min(placements.size(), kMaxNumPlacements); ++k) {
    const Placement& placement = placements[k];
    json.push_back({{"T_map_query", ToJson(placement.T_map_query)},
                    {"score", placement.score},
                    {"matches", placement.votes.size()},
                    {"rival", placement.is_rival}});
  }
  return json;
}

// Stages that ran twice count once, with the sum.
Json MillisecondsJson(
    const std::vector<std::pair<std::string, double>>& stage_seconds) {
  Json json = Json::object();
  for (const auto& [stage, seconds] : stage_seconds) {
    json[stage] = json.value(stage, 0.) + 1000. * seconds;
  }
  return json;
}

Json SessionsJson(const MergingResult& result) {
  Json json = Json::array();
  for (const MergedSession& session : result.sessions) {
    const bool is_merged =
        session.T_merged_session.has_value() && result.refusal.empty();
    json.push_back({{"path", session.path},
                    {"group", session.group},
                    {"merged", is_merged},
                    {"T_merged_session", ToJson(session.T_merged_session)}});
  }
  return json;
}

Json LinksJson(const std::vector<SessionLink>& links) {
  Json json = Json::array();
  for (const SessionLink& link : links) {
    const Localization& found = link.localization;
    json.push_back({{"first", link.first},
                    {"second", link.second},
                    {"connected", found.T_map_query.has_value()},
                    {"verdict", LocalizationVerdictName(found.verdict)},
                    {"reason", found.reason},
                    {"T_first_second", ToJson(found.T_map_query)},
                    {"score", ToJson(found.score)},
                    {"runner_up_score", ToJson(found.runner_up_score)},
                    {"agreeing", found.num_agreeing},
                    {"contradicting", found.num_contradicting}});
  }
  return json;
}

// How many closures have each status.
Json StatusesJson(const std::vector<Closure>& closures) {
  std::map<std::string, int> counts;
  for (const Closure& closure : closures) {
    ++counts[ClosureStatusName(closure.status)];
  }
  return counts;
}

}  // namespace

Json ToJson(const Localization& result) {
  return {{"localized", result.T_map_query.has_value()},
          {"verdict", LocalizationVerdictName(result.verdict)},
          {"reason", result.reason},
          {"T_map_query", ToJson(result.T_map_query)},
          {"score", ToJson(result.score)},
          {"runner_up_score", ToJson(result.runner_up_score)},
          {"agreeing", result.num_agreeing},
          {"contradicting", result.num_contradicting},
          {"closures", VotesJson(result)},
          {"placements", PlacementsJson(result.placements)},
          {"milliseconds", MillisecondsJson(result.stage_seconds)}};
}

Json ToJson(const MergingResult& result) {
  return {{"merged", result.refusal.empty()},
          {"reason", result.refusal},
          {"sessions", SessionsJson(result)},
          {"pairs", LinksJson(result.links)},
          {"closures", StatusesJson(result.closed.closures)},
          {"overlapping_pairs", result.num_overlapping},
          {"contradicting_pairs", result.contradictions.size()},
          {"milliseconds", MillisecondsJson(result.stage_seconds)}};
}

}  // namespace cartographer_sdf
