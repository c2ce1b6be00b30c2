// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/audit.h"

#include <iostream>
#include <map>
#include <set>
#include <string>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/report/audit_report.h"
#include "cartographer_sdf/report/audit_table.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/stages.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "gflags/gflags.h"

DEFINE_string(constraints, "",
              "CSV file for every inter-submap constraint, with its verdict "
              "and evidence. None if empty.");

namespace cartographer_sdf {
namespace {

void PrintSummary(const Audit& audit) {
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
  for (const auto& [stage, seconds] : audit.stage_seconds) {
    std::cout << absl::StrFormat("  %7.2f s %s\n", seconds, stage);
  }
  if (!audit.optimizations.empty() && !audit.optimizations.back().converged) {
    std::cout << "The optimisation did not converge: "
              << audit.optimizations.back().message << "\n";
  }
}

// The map last: it stands for all having gone well.
absl::Status WriteFiles(const Options& options, const Audit& audit,
                        StageProgress* const progress) {
  absl::Status status;
  if (!FLAGS_constraints.empty()) {
    status = WriteAuditTable(FLAGS_constraints, audit);
  }
  std::optional<RecordWriter> output;
  const auto read_and_write =
      [&](const SubmapCallback& on_submap) -> absl::Status {
    if (FLAGS_output.empty()) {
      return ReadMap(FLAGS_input, {on_submap, {}}, progress->Begin("report"))
          .status();
    }
    absl::StatusOr<RecordWriter> map =
        PrepareMap(FLAGS_input, FLAGS_output, audit.pose_graph, {on_submap, {}},
                   progress->Begin("write"));
    if (map.ok()) output.emplace(*std::move(map));
    return map.status();
  };
  if (status.ok() && !FLAGS_report.empty()) {
    status = WriteAuditReport(ReportRequestOfFlags(options), FLAGS_input, audit,
                              read_and_write);
  } else if (status.ok() && !FLAGS_output.empty()) {
    status = read_and_write({});
  }
  if (status.ok() && output) status = output->Commit();
  return status;
}

absl::Status RunAudit() {
  const absl::StatusOr<Options> options = LoadOptionsOfFlags();
  if (!options.ok()) return options.status();
  if (absl::Status status = RequireVerification(options->loop_closing, "audit");
      !status.ok()) {
    return status;
  }
  const absl::StatusOr<int> num_threads = NumThreadsOfFlags();
  if (!num_threads.ok()) return num_threads.status();
  const absl::StatusOr<std::set<int>> frozen = FrozenTrajectoriesOfFlags();
  if (!frozen.ok()) return frozen.status();

  StageProgress progress;
  const absl::StatusOr<Audit> audit =
      AuditMap(options->loop_closing, options->audit, FLAGS_input, *frozen,
               MakeExecutor(*num_threads), progress.Callback());
  if (!audit.ok()) return audit.status();
  const absl::Status status = WriteFiles(*options, *audit, &progress);
  if (!status.ok()) return status;
  PrintSummary(*audit);
  if (!FLAGS_output.empty()) std::cout << FLAGS_output << "\n";
  if (!FLAGS_report.empty()) std::cout << FLAGS_report << "/index.html\n";
  return absl::OkStatus();
}

}  // namespace

Subcommand AuditSubcommand() {
  return Subcommand{
      "audit",
      "find the constraints of a map that are doubtful",
      "--input A.pbstream [--output B.pbstream] [--report DIR] "
      "[--constraints C.csv]",
      "Checks every inter-submap constraint: whether walls of one submap stand "
      "in free space of the other at the constraint's own pose, whether "
      "another pose of the two is as good, whether it agrees with the others "
      "in cycles, and whether the map that is made without the doubtful ones "
      "has it elsewhere. With --output, writes the map without the doubtful "
      "ones, optimised anew; everything else in the file stays as it is.\n\n"
      "A map without a doubtful constraint comes out as it went in.",
      {"input"},
      {"output", "report", "constraints", "frozen_trajectories",
       "configuration_directory", "configuration_basename", "threads"},
      &RunAudit};
}

}  // namespace cartographer_sdf
