// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/json.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "cartographer_sdf/localization/probability.h"

namespace cartographer_sdf {
namespace {

constexpr size_t kMaxNumPlacements = 10;

// Flat: the members of the pose are not nested.
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

// The matches that vote for the answer; none if there is no answer.
Json VotesJson(const Localization& result) {
  Json votes = Json::array();
  if (!result.T_map_query) return votes;
  for (const size_t vote : result.placements.front().votes) {
    votes.push_back(MatchJson(result.matches[vote]));
  }
  return votes;
}

// The best few other placements.
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

// Stages that ran several times have one entry, with the sum.
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
                    {"left_out", session.left_out},
                    {"T_merged_session", ToJson(session.T_merged_session)}});
  }
  return json;
}

// Boxes in the map frame.
Json ChangesJson(const std::vector<Change>& changes) {
  Json json = Json::array();
  for (const Change& change : changes) {
    json.push_back({{"kind", ChangeKindName(change.kind)},
                    {"x_min", change.box.min().x()},
                    {"y_min", change.box.min().y()},
                    {"x_max", change.box.max().x()},
                    {"y_max", change.box.max().y()},
                    {"wall_area", change.wall_area}});
  }
  return json;
}

Json PartsJson(const QueryParts& parts) {
  Json json = Json::array();
  for (const QueryPart& part : parts.parts) {
    json.push_back({{"first", ToJson(part.first)},
                    {"last", ToJson(part.last)},
                    {"T_map_query", ToJson(part.placement.T_map_query)},
                    {"matches", part.placement.votes.size()},
                    {"score", part.placement.score}});
  }
  return json;
}

Json JumpsJson(const QueryParts& parts) {
  Json json = Json::array();
  for (const Jump& jump : parts.jumps) {
    json.push_back({{"before", ToJson(jump.before)},
                    {"after", ToJson(jump.after)},
                    {"distance", jump.distance}});
  }
  return json;
}

// `certain` and `pose` are the names of members.
Json AnswerJson(const Localization& result, const char* const certain,
                const char* const pose) {
  std::optional<double> best, runner_up;
  if (result.score) {
    best = ProbabilityOf(*result.score, result.runner_up_score);
  }
  if (result.score && result.runner_up_score) {
    runner_up = ProbabilityOf(*result.runner_up_score, result.score);
  }
  return {
      {certain, result.T_map_query.has_value()},
      {"verdict", LocalizationVerdictName(result.verdict)},
      {"reason", result.reason},
      {pose, ToJson(result.T_map_query)},
      {"probability", ToJson(best)},
      {"runner_up_probability", ToJson(runner_up)},
      {"score", ToJson(result.score)},
      {"runner_up_score", ToJson(result.runner_up_score)},
      {"agreeing", result.num_agreeing},
      {"contradicting", result.num_contradicting},
      {"compared", result.num_compared},
      {"crossed", result.crossing_walls.size()},
      {"parts", PartsJson(result.parts)},
      {"jumps", JumpsJson(result.parts)},
      {"changed_area",
       result.T_map_query ? Json(ChangedArea(result.changes)) : Json(nullptr)},
      {"changes", ChangesJson(result.changes)}};
}

Json LinksJson(const std::vector<SessionLink>& links) {
  Json json = Json::array();
  for (const SessionLink& link : links) {
    json.push_back({{"first", link.first}, {"second", link.second}});
    json.back().update(
        AnswerJson(link.localization, "connected", "T_first_second"));
  }
  return json;
}

Json CandidateJson(const ScanCandidate& candidate) {
  const BeamEvidence& evidence = candidate.evidence;
  return {{"T_map_robot", ToJson(candidate.T_map_robot)},
          {"probability", candidate.probability},
          {"covariance", ToJson(candidate.covariance)},
          {"beams", evidence.num_beams},
          {"fit", evidence.fit},
          {"at_wall", evidence.at_wall},
          {"through_wall", evidence.through_wall},
          {"in_free_space", evidence.in_free_space},
          {"in_unknown", evidence.in_unknown}};
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

std::string FormatJson(const Json& json) {
  constexpr int kIndent = 2;
  return json.dump(kIndent, ' ', /*ensure_ascii=*/false,
                   Json::error_handler_t::replace) +
         "\n";
}

Json ToJson(const Rigid2& pose) {
  return {{"x", pose.translation().x()},
          {"y", pose.translation().y()},
          {"yaw", pose.rotation()}};
}

Json ToJson(const Eigen::Matrix3d& matrix) {
  Json rows = Json::array();
  for (int row = 0; row < 3; ++row) {
    rows.push_back({matrix(row, 0), matrix(row, 1), matrix(row, 2)});
  }
  return rows;
}

Json ToJson(const SubmapId& id) {
  return {{"trajectory", id.trajectory}, {"index", id.index}};
}

Json ToJson(const MapQuality& quality) {
  // Where nothing was compared, nothing is known.
  const auto known = [&quality](const double value) {
    return quality.num_pairs > 0 ? Json(value) : Json(nullptr);
  };
  return {{"pairs", quality.num_pairs},
          {"hit_ratio", known(quality.hit_ratio)},
          {"contradiction_ratio", known(quality.contradiction_ratio)},
          {"wall_distance", known(quality.wall_distance)}};
}

Json ToJson(const RunDescription& run) {
  Json inputs = Json::array();
  for (const InputFile& file : run.inputs) {
    inputs.push_back({{"flag", file.flag},
                      {"path", file.path},
                      {"bytes", ToJson(file.num_bytes)},
                      {"sha256", file.sha256}});
  }
  return {{"program",
           {{"name", run.program},
            {"version", run.version},
            {"commit", run.commit}}},
          {"command", {{"name", run.command}, {"arguments", run.arguments}}},
          {"started", run.started},
          {"inputs", std::move(inputs)}};
}

Json ToJson(const Localization& result) {
  Json json = AnswerJson(result, "localized", "T_map_query");
  json.update({{"closures", VotesJson(result)},
               {"placements", PlacementsJson(result.placements)},
               {"milliseconds", MillisecondsJson(result.stage_seconds)}});
  return json;
}

Json ToJson(const ScanLocalization& result) {
  const bool is_localized = result.verdict == LocalizationVerdict::kLocalized;
  Json candidates = Json::array();
  for (const ScanCandidate& candidate : result.candidates) {
    candidates.push_back(CandidateJson(candidate));
  }
  return {
      {"localized", is_localized},
      {"verdict", LocalizationVerdictName(result.verdict)},
      {"reason", result.reason},
      {"T_map_robot",
       is_localized ? ToJson(result.candidates.front().T_map_robot) : Json()},
      {"candidates", candidates},
      {"elsewhere_probability", ToJson(result.elsewhere_probability)},
      {"milliseconds", MillisecondsJson(result.stage_seconds)}};
}

Json ToJson(const SessionAnswer& answer) {
  Json json = ToJson(answer.localization);
  json["localized"] = answer.T_map_robot.has_value();
  json["T_map_robot"] = ToJson(answer.T_map_robot);
  json.update({{"state", ScanSearchStateName(answer.state)},
               {"looks", answer.num_looks},
               {"meters", answer.distance_driven},
               {"seconds", answer.seconds}});
  return json;
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
