// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/match_table.h"

#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "cartographer_sdf/file/text_file.h"
#include "cartographer_sdf/file/whole_file.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

const std::vector<CsvColumn>& Columns() {
  static const auto* const kColumns =
      new std::vector<CsvColumn>{{"reference_trajectory", CsvType::kInteger},
                                 {"reference_index", CsvType::kInteger},
                                 {"query_trajectory", CsvType::kInteger},
                                 {"query_index", CsvType::kInteger},
                                 {"accepted", CsvType::kInteger},
                                 {"score", CsvType::kNumber},
                                 {"x", CsvType::kNumber},
                                 {"y", CsvType::kNumber},
                                 {"yaw", CsvType::kNumber},
                                 {"verdict", CsvType::kWord},
                                 {"inliers", CsvType::kInteger},
                                 {"overlap", CsvType::kNumber},
                                 {"hit_ratio", CsvType::kNumber},
                                 {"contradiction_ratio", CsvType::kNumber}};
  return *kColumns;
}

}  // namespace

MatchRow ToRow(const Match& match, const bool accepted,
               const std::string& verdict) {
  MatchRow row;
  row.reference = match.pair.reference;
  row.query = match.pair.query;
  row.accepted = accepted;
  row.score = match.pair.score;
  row.T_reference_query = match.pair.T_reference_query;
  row.verdict = verdict;
  row.inliers = static_cast<int>(match.inliers.size());
  row.overlap = match.evidence.overlap;
  row.hit_ratio = match.evidence.HitRatio();
  row.contradiction_ratio = match.evidence.ContradictionRatio();
  return row;
}

absl::StatusOr<std::vector<MatchRow>> ReadMatches(const std::string& path) {
  const absl::StatusOr<std::vector<CsvRow>> rows = ReadCsv(path, Columns());
  if (!rows.ok()) return rows.status();
  std::vector<MatchRow> matches;
  for (const CsvRow& row : *rows) {
    if (row.Integer(4) != 0 && row.Integer(4) != 1) {
      return LineError(path, row.line, "\"accepted\" is neither 0 nor 1");
    }
    MatchRow match;
    match.reference = SubmapId{row.Integer(0), row.Integer(1)};
    match.query = SubmapId{row.Integer(2), row.Integer(3)};
    match.accepted = row.Integer(4) == 1;
    match.score = row.Number(5);
    match.T_reference_query =
        Rigid2(row.Number(6), row.Number(7), row.Number(8));
    match.verdict = row.Word(9);
    match.inliers = row.Integer(10);
    match.overlap = row.Number(11);
    match.hit_ratio = row.Number(12);
    match.contradiction_ratio = row.Number(13);
    matches.push_back(match);
  }
  return matches;
}

absl::Status WriteMatches(const std::string& path,
                          const std::vector<MatchRow>& matches) {
  std::string content = absl::StrJoin(
      Columns(), ",", [](std::string* const out, const CsvColumn& column) {
        out->append(column.name);
      });
  content += "\n";
  for (const MatchRow& match : matches) {
    CHECK_EQ(match.verdict.find_first_of(",\r\n"), std::string::npos)
        << match.verdict;
    absl::StrAppendFormat(
        &content, "%d,%d,%d,%d,%d,%.6f,%.6f,%.6f,%.6f,%s,%d,%.6f,%.6f,%.6f\n",
        match.reference.trajectory, match.reference.index,
        match.query.trajectory, match.query.index, match.accepted ? 1 : 0,
        match.score, match.T_reference_query.translation().x(),
        match.T_reference_query.translation().y(),
        match.T_reference_query.rotation(), match.verdict, match.inliers,
        match.overlap, match.hit_ratio, match.contradiction_ratio);
  }
  return WriteWholeFile(path, content);
}

}  // namespace cartographer_sdf
