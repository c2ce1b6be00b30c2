// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/audit.h"

#include <iostream>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/report/reports.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/stages.h"
#include "cartographer_sdf/tools/subcommand.h"

DEFINE_string(constraints, "",
              "CSV file to write every inter-submap constraint to, with its "
              "verdict and evidence. None if empty.");

namespace cartographer_sdf {
namespace {

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
  if (audit.num_doubtful > 0) {
    std::cout << "; without the doubtful constraints: "
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
        return WriteAuditReport(ReportRequestOfFlags(options), FLAGS_input,
                                audit, read_submaps);
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
  const Options& options = task->options;
  StageProgress progress(record);
  const absl::StatusOr<Audit> audit =
      AuditMap(options.loop_closing, options.audit, SourceOfFlags(FLAGS_input),
               task->frozen_trajectories, task->executor, progress.Callback());
  if (!audit.ok()) return audit.status();
  const absl::Status status = WriteFiles(options, *audit, &progress);
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

Subcommand AuditSubcommand() {
  Subcommand subcommand{
      "audit",
      "find the constraints of a map that are doubtful",
      "A.pbstream [--output B.pbstream | --in_place] [--report DIR] "
      "[--constraints C.csv] [--result R.json] [--repair]",
      "Checks every inter-submap constraint: whether walls of one submap stand "
      "in free space of the other at the constraint's pose, whether another "
      "pose of the two submaps is as good, whether the constraint agrees with "
      "the others in cycles, and whether the map made without doubtful "
      "constraints contradicts it. With --output, writes the map without the "
      "doubtful constraints, optimised again; every other record of the "
      "file stays as it is. Where the walls of that map would agree less than "
      "those of the map as it is, nothing is written, and the exit code is "
      "3.\n\n"
      "A map without doubtful constraints is copied, byte for byte.",
      {{"input", FileUse::kRead}},
      {{"output",
        FileUse::kCopyMap,
        {},
        "Map to write, a .pbstream without the doubtful constraints."},
       {"report", FileUse::kWriteInto, {"index.html"}},
       {"constraints", FileUse::kWriteText},
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
