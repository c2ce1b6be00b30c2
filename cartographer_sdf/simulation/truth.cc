// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/truth.h"

#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/file/text_file.h"
#include "cartographer_sdf/file/whole_file.h"

namespace cartographer_sdf {
namespace {

constexpr char kSubmap[] = "submap";
constexpr char kNode[] = "node";
// [m], as in maps: beyond it, cells could not be counted.
constexpr double kMaxTruthCoordinate = 1e9;

template <typename Id>
void AppendRows(const char* const kind, const std::map<Id, Rigid2>& poses,
                std::string* const content) {
  for (const auto& [id, pose] : poses) {
    absl::StrAppendFormat(content, "%s,%d,%d,%.9f,%.9f,%.9f\n", kind,
                          id.trajectory, id.index, pose.translation().x(),
                          pose.translation().y(), pose.rotation());
  }
}

}  // namespace

absl::StatusOr<Truth> ReadTruth(const std::string& path) {
  const absl::StatusOr<std::vector<CsvRow>> rows =
      ReadCsv(path, {{"kind", CsvType::kWord},
                     {"trajectory", CsvType::kInteger},
                     {"index", CsvType::kInteger},
                     {"x", CsvType::kNumber},
                     {"y", CsvType::kNumber},
                     {"yaw", CsvType::kNumber}});
  if (!rows.ok()) return rows.status();
  Truth truth;
  for (const CsvRow& row : *rows) {
    const std::string& kind = row.Word(0);
    const int trajectory = row.Integer(1);
    const int index = row.Integer(2);
    const Rigid2 pose(row.Number(3), row.Number(4), row.Number(5));
    if (pose.translation().cwiseAbs().maxCoeff() > kMaxTruthCoordinate) {
      return LineError(path, row.line, "the position is beyond 1e9 m");
    }
    bool is_new = false;
    if (kind == kSubmap) {
      is_new = truth.T_world_submap.emplace(SubmapId{trajectory, index}, pose)
                   .second;
    } else if (kind == kNode) {
      is_new = truth.T_world_tracking.emplace(NodeId{trajectory, index}, pose)
                   .second;
    } else {
      return LineError(path, row.line,
                       "the kind is neither \"submap\" nor \"node\"");
    }
    if (!is_new) {
      return LineError(path, row.line,
                       absl::StrCat("there is a second pose of ", kind, " ",
                                    trajectory, ",", index));
    }
  }
  return truth;
}

absl::Status WriteTruth(const std::string& path, const Truth& truth) {
  std::string content = "kind,trajectory,index,x,y,yaw\n";
  AppendRows(kSubmap, truth.T_world_submap, &content);
  AppendRows(kNode, truth.T_world_tracking, &content);
  return WriteWholeFile(path, content);
}

}  // namespace cartographer_sdf
