// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/audit.h"

#include <iostream>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/file/text_file.h"
#include "cartographer_sdf/report/reports.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/stages.h"
#include "cartographer_sdf/tools/subcommand.h"

DEFINE_string(constraints, "",
              "CSV file to write every inter-submap constraint to, with its "
              "verdict and evidence. None if empty.");

DEFINE_string(drop, "",
              "CSV file with the constraints to drop, in place of those that "
              "are doubtful: as the report saves it, or rows of "
              "--constraints. None if empty.");

namespace cartographer_sdf {
namespace {

// None without --drop.
absl::StatusOr<std::optional<std::vector<ListedConstraint>>> DropListOfFlags() {
  if (FLAGS_drop.empty()) return std::optional<std::vector<ListedConstraint>>();
  const absl::StatusOr<std::vector<CsvRow>> rows =
      ReadCsv(FLAGS_drop, {{"constraint", CsvType::kInteger},
                           {"submap_trajectory", CsvType::kInteger},
                           {"submap_index", CsvType::kInteger},
                           {"node_trajectory", CsvType::kInteger},
                           {"node_index", CsvType::kInteger}});
  if (!rows.ok()) return rows.status();
  std::vector<ListedConstraint> list;
  for (const CsvRow& row : *rows) {
    if (row.Integer(0) < 0) {
      return LineError(FLAGS_drop, row.line,
                       "the number of a constraint must not be negative");
    }
    list.push_back({static_cast<size_t>(row.Integer(0)),
                    {row.Integer(1), row.Integer(2)},
                    {row.Integer(3), row.Integer(4)}});
  }
  return std::make_optional(std::move(list));
}

std::string DescribeWalls(const MapQuality& quality) {
  return absl::StrFormat("%.2f %% in free space, %.3f m apart",
                         100. * quality.contradiction_ratio,
                         quality.wall_distance);
}

// How well the walls agree where submaps lie over each other.
void PrintQuality(const Audit& audit) {
  if (audit.quality_before.num_pairs == 0) return;
  std::cout << "walls where submaps overlap: "
            << DescribeWalls(audit.quality_before);
  if (!audit.dropped.empty()) {
    std::cout << "; without the dropped constraints: "
              << DescribeWalls(audit.quality_after);
  }
  std::cout << "\n";
}

void PrintSummary(const Audit& audit) {
  PrintRepair(audit.state);
  std::map<AuditVerdict, int> verdicts;
  for (const AuditedConstraint& constraint : audit.constraints) {
    ++verdicts[constraint.verdict];
  }
  std::cout << absl::StrFormat(
      "%d inter-submap constraints in %d groups, %d of them doubtful\n",
      audit.constraints.size(), audit.groups.size(), audit.num_doubtful);
  for (const auto& [verdict, count] : verdicts) {
    std::cout << absl::StrFormat("  %5d %s%s\n", count,
                                 IsDoubtful(verdict) ? "doubtful: " : "",
                                 AuditVerdictName(verdict));
  }
  if (!FLAGS_drop.empty()) {
    std::cout << audit.dropped.size() << " constraints are dropped, as "
              << FLAGS_drop << " says\n";
  }
  PrintQuality(audit);
  PrintStages(audit.stage_seconds);
  PrintConvergence(audit.optimizations);
  PrintPaths();
}

void RecordAudit(const Audit& audit, RunRecord* const record) {
  RecordMap(audit.state, record);
  record->Count("inter_submap_constraints", audit.constraints.size());
  record->Count("groups", audit.groups.size());
  record->Count("doubtful", audit.num_doubtful);
  Json verdicts = Json::object();
  for (const AuditedConstraint& constraint : audit.constraints) {
    const char* const name = AuditVerdictName(constraint.verdict);
    verdicts[name] = verdicts.value(name, 0) + 1;
  }
  record->answer["verdicts"] = std::move(verdicts);
  record->answer["walls_before"] = ToJson(audit.quality_before);
  record->answer["walls_after"] = ToJson(audit.quality_after);
  RecordConvergence(audit.optimizations, record);
  if (audit.leaves_out_odometry) {
    record->Warn(RunWarning::kOdometryLeftOut,
                 "odometry contradicts constraints that are kept, and is left "
                 "out of the optimisation");
  }
  if (audit.num_doubtful > 0) {
    record->Warn(RunWarning::kDoubtful,
                 absl::StrFormat("%d of %d inter-submap constraints are "
                                 "doubtful",
                                 audit.num_doubtful, audit.constraints.size()));
  }
  if (audit.constraints.empty()) {
    record->End(Outcome::kNothing,
                "the map has no inter-submap constraints to check");
  }
}

// Writes the files that the flags ask for. If the map without the doubtful
// constraints is worse than the one that was read, it is not written, which is
// a refusal; the report is.
absl::Status WriteFiles(const Options& options, const Audit& audit,
                        const RunDescription& run,
                        StageProgress* const progress) {
  absl::Status status;
  if (!FLAGS_constraints.empty()) {
    status = WriteAuditTable(FLAGS_constraints, audit);
  }
  if (!status.ok()) return status;
  const std::string output =
      audit.refusal.empty() ? "" : std::exchange(FLAGS_output, "");
  status = WriteMapAndReport(
      audit.state, audit.pose_graph,
      [&](const SubmapsReader& read_submaps) {
        return WriteAuditReport(ReportRequestOfFlags(options, run),
                                options.loop_closing, options.audit,
                                FLAGS_input, audit, read_submaps);
      },
      progress);
  if (!status.ok() || output.empty()) return status;
  PrintSummary(audit);
  return RefusalError(
      absl::StrCat("nothing is written to ", output, ": ", audit.refusal));
}

absl::Status RunAudit(RunRecord* const record) {
  const absl::StatusOr<MapTask> task = MapTaskOfFlags("audit");
  if (!task.ok()) return task.status();
  const absl::StatusOr<std::optional<std::vector<ListedConstraint>>> drop_list =
      DropListOfFlags();
  if (!drop_list.ok()) return drop_list.status();
  const Options& options = task->options;
  StageProgress progress(record);
  const absl::StatusOr<Audit> audit =
      AuditMap(options.loop_closing, options.audit, SourceOfFlags(FLAGS_input),
               task->frozen_trajectories, task->executor, progress.Callback(),
               *drop_list);
  if (!audit.ok()) return audit.status();
  const absl::Status status =
      WriteFiles(options, *audit, record->run, &progress);
  RecordAudit(*audit, record);
  if (!status.ok()) return status;
  PrintSummary(*audit);
  if (!FLAGS_output.empty()) {
    WarnOfHostMotion(options.loop_closing.closing, audit->optimization,
                     audit->pose_graph, record);
  }
  return absl::OkStatus();
}

absl::Status CheckFlagsOfAudit() {
  const absl::Status status = CheckPictureFlags();
  return status.ok() ? CheckDropOdometry() : status;
}

}  // namespace

// Long: a description, with all flags.
Subcommand AuditSubcommand() {
  Subcommand subcommand{
      "audit",
      "find the constraints of a map that are doubtful",
      "A.pbstream [--output B.pbstream | --in_place] [--report DIR] "
      "[--constraints C.csv] [--drop D.csv] [--result R.json] [--repair]",
      "Checks every inter-submap constraint: whether walls of one submap stand "
      "in free space of the other at the constraint's pose, whether another "
      "pose of the two submaps is as good, whether the constraint agrees with "
      "the others in cycles, and whether the map made without doubtful "
      "constraints contradicts it. With --output, writes the map without the "
      "doubtful constraints, optimised again; every other record of the "
      "file stays as it is. Where the walls of that map would agree less than "
      "those of the map as it is, nothing is written, and the exit code is "
      "3.\n\n"
      "With --drop, a list says which constraints are dropped, and no others: "
      "that of doubtful ones which the report saves, or part of it.\n\n"
      "A map without doubtful constraints is copied, byte for byte, unless "
      "--drop_odometry leaves its odometry out.",
      {{"input", FileUse::kRead}},
      {{"output",
        FileUse::kCopyMap,
        {},
        "Map to write, a .pbstream without the doubtful constraints."},
       {"report", FileUse::kWriteInto, {"index.html"}},
       {"constraints", FileUse::kWriteText},
       {"drop", FileUse::kRead},
       {"picture", FileUse::kWriteText},
       "picture_pixels",
       "in_place",
       "backup",
       "repair",
       "drop_odometry",
       "frozen_trajectories",
       "configuration_directory",
       "configuration_basename",
       "threads"},
      &RunAudit};
  subcommand.check_flags = &CheckFlagsOfAudit;
  subcommand.positional_flags = {"input"};
  return subcommand;
}

}  // namespace cartographer_sdf
