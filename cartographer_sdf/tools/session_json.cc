// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/session_json.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"

namespace cartographer_sdf {
namespace {

std::string Format(const std::optional<double>& number) {
  return number ? absl::StrFormat("%.9g", *number) : "null";
}

std::string Format(const std::optional<Rigid2>& pose) {
  if (!pose) return "null";
  return absl::StrFormat(R"({"x": %.9g, "y": %.9g, "yaw": %.9g})",
                         pose->translation().x(), pose->translation().y(),
                         pose->rotation());
}

std::string FormatClosure(const LoopClosure& closure) {
  return absl::StrFormat(
      R"({"reference_trajectory": %d, "reference_index": %d, )"
      R"("query_trajectory": %d, "query_index": %d, )"
      R"("score": %.9g, "x": %.9g, "y": %.9g, "yaw": %.9g, )"
      R"("overlap": %.4g, "hit_ratio": %.4g, "contradiction_ratio": %.4g})",
      closure.reference.trajectory, closure.reference.index,
      closure.query.trajectory, closure.query.index, closure.score,
      closure.T_reference_query.translation().x(),
      closure.T_reference_query.translation().y(),
      closure.T_reference_query.rotation(), closure.evidence.overlap,
      closure.evidence.hit_ratio, closure.evidence.contradiction_ratio);
}

std::string FormatClosures(const std::vector<LoopClosure>& closures) {
  std::vector<std::string> lines;
  for (const LoopClosure& closure : closures) {
    lines.push_back("    " + FormatClosure(closure));
  }
  if (lines.empty()) return "[]";
  return absl::StrCat("[\n", absl::StrJoin(lines, ",\n"), "\n  ]");
}

// Stages that ran twice count once, with the sum.
std::string FormatMilliseconds(
    const std::vector<std::pair<std::string, double>>& stages) {
  std::map<std::string, double> sums;
  std::vector<std::string> order;
  for (const auto& [stage, seconds] : stages) {
    if (sums.count(stage) == 0) order.push_back(stage);
    sums[stage] += seconds;
  }
  std::vector<std::string> entries;
  for (const std::string& stage : order) {
    entries.push_back(
        absl::StrFormat("%s: %.1f", QuoteJson(stage), 1000. * sums.at(stage)));
  }
  return absl::StrCat("{", absl::StrJoin(entries, ", "), "}");
}

std::vector<LoopClosure> VotesOf(const Relocalization& result) {
  std::vector<LoopClosure> votes;
  if (!result.T_map_query) return votes;
  for (const size_t vote : result.placements.front().votes) {
    votes.push_back(result.matches[vote].closure);
  }
  return votes;
}

// Where else it might be; the best few.
std::string FormatPlacements(const Relocalization& result) {
  constexpr size_t kMaxNumPlacements = 10;
  std::vector<std::string> lines;
  for (const Placement& placement : result.placements) {
    if (lines.size() == kMaxNumPlacements) break;
    lines.push_back(absl::StrFormat(
        R"(    {"T_map_query": %s, "score": %.9g, "matches": %d, )"
        R"("rival": %s})",
        Format(std::make_optional(placement.T_map_query)), placement.score,
        placement.votes.size(), placement.is_rival ? "true" : "false"));
  }
  if (lines.empty()) return "[]";
  return absl::StrCat("[\n", absl::StrJoin(lines, ",\n"), "\n  ]");
}

const char* Bool(const bool value) { return value ? "true" : "false"; }

}  // namespace

std::string QuoteJson(const std::string_view text) {
  std::string quoted = "\"";
  for (size_t i = 0; i < text.size(); ++i) {
    const unsigned char byte = static_cast<unsigned char>(text[i]);
    if (byte == '"' || byte == '\\') {
      quoted += '\\';
      quoted += static_cast<char>(byte);
    } else if (byte < 0x20 || byte == 0x7f) {
      quoted += absl::StrFormat("\\u%04x", byte);
    } else if (byte < 0x80) {
      quoted += static_cast<char>(byte);
    } else {
      // A well-formed sequence of two to four bytes, or a question mark.
      const size_t size = byte >= 0xf0 && byte < 0xf5   ? 4
                          : byte >= 0xe0 && byte < 0xf0 ? 3
                          : byte >= 0xc2 && byte < 0xe0 ? 2
                                                        : 0;
      bool is_valid = size > 0 && i + size <= text.size();
      for (size_t k = 1; is_valid && k < size; ++k) {
        is_valid = (static_cast<unsigned char>(text[i + k]) & 0xc0) == 0x80;
      }
      quoted += is_valid ? std::string(text.substr(i, size)) : "?";
      if (is_valid) i += size - 1;
    }
  }
  return quoted + "\"";
}

std::string FormatRelocalization(const Relocalization& result) {
  std::string json = "{\n";
  absl::StrAppend(
      &json, "  \"localized\": ", Bool(result.T_map_query.has_value()),
      ",\n  \"verdict\": \"", RelocalizationVerdictName(result.verdict),
      "\",\n  \"reason\": ", QuoteJson(result.reason),
      ",\n  \"T_map_query\": ", Format(result.T_map_query),
      ",\n  \"score\": ", Format(result.score),
      ",\n  \"runner_up_score\": ", Format(result.runner_up_score));
  absl::StrAppend(&json, ",\n  \"agreeing\": ", result.num_agreeing,
                  ",\n  \"contradicting\": ", result.num_contradicting,
                  ",\n  \"closures\": ", FormatClosures(VotesOf(result)),
                  ",\n  \"placements\": ", FormatPlacements(result),
                  ",\n  \"milliseconds\": ",
                  FormatMilliseconds(result.stage_seconds), "\n}\n");
  return json;
}

std::string FormatMerging(const MergingResult& result) {
  std::vector<std::string> sessions, links, closures;
  for (const MergedSession& session : result.sessions) {
    sessions.push_back(absl::StrFormat(
        R"(    {"path": %s, "group": %d, "merged": %s, "T_merged_session": %s})",
        QuoteJson(session.path), session.group,
        Bool(session.T_merged_session.has_value() && result.refusal.empty()),
        Format(session.T_merged_session)));
  }
  for (const SessionLink& link : result.links) {
    const Relocalization& found = link.relocalization;
    links.push_back(absl::StrFormat(
        R"(    {"first": %d, "second": %d, "connected": %s, "verdict": "%s", )"
        R"("reason": %s, "T_first_second": %s, "score": %s, )"
        R"("runner_up_score": %s, "agreeing": %d, "contradicting": %d})",
        link.first, link.second, Bool(found.T_map_query.has_value()),
        RelocalizationVerdictName(found.verdict), QuoteJson(found.reason),
        Format(found.T_map_query), Format(found.score),
        Format(found.runner_up_score), found.num_agreeing,
        found.num_contradicting));
  }
  std::map<std::string, int> fates;
  for (const ClosureOutcome& outcome : result.closures) {
    ++fates[FateName(outcome.fate)];
  }
  for (const auto& [fate, count] : fates) {
    closures.push_back(absl::StrFormat("\"%s\": %d", fate, count));
  }
  return absl::StrCat(
      "{\n  \"merged\": ", Bool(result.refusal.empty()),
      ",\n  \"reason\": ", QuoteJson(result.refusal), ",\n  \"sessions\": [\n",
      absl::StrJoin(sessions, ",\n"), "\n  ],\n  \"pairs\": [\n",
      absl::StrJoin(links, ",\n"), "\n  ],\n  \"closures\": {",
      absl::StrJoin(closures, ", "),
      "},\n  \"overlapping_pairs\": ", result.num_overlapping,
      ",\n  \"contradicting_pairs\": ", result.contradictions.size(),
      ",\n  \"milliseconds\": ", FormatMilliseconds(result.stage_seconds),
      "\n}\n");
}

}  // namespace cartographer_sdf
