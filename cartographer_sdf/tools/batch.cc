// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// `batch`: one task on many maps, as every night.

#include <algorithm>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/tools/batch_jobs.h"
#include "cartographer_sdf/tools/batch_summary.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/progress.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "gflags/gflags.h"

DECLARE_string(inputs);

DEFINE_string(output_dir, "",
              "Directory for maps, results, logs, pictures and the summary; "
              "made if it is missing.");
DEFINE_int32(jobs, 0,
             "Number of maps at a time, each in a process of its own; 0: as "
             "many as the machine has cores.");
DEFINE_string(task, "close_loops",
              "What to do with each map: close_loops or audit.");
DEFINE_bool(reports, false, "Also make the HTML report of each map.");
DEFINE_string(plan, "",
              "Do not run anything: write a shell command for each map that is "
              "not finished to this file, one a line, -: the standard output. "
              "Run them anywhere, then --collect.");
DEFINE_bool(collect, false,
            "Do not run anything: make the summary of what an earlier run or "
            "the commands of --plan left in --output_dir.");
DEFINE_string(program, "",
              "Path of this program on the machines that run the commands of "
              "--plan. If empty, its path here.");

namespace cartographer_sdf {
namespace {

constexpr int kMaxNumProcesses = 1024;

std::string InDirectory(const std::string& name) {
  return absl::StrCat(FLAGS_output_dir, "/", name);
}

absl::Status CheckFlagsOfBatch() {
  if (FLAGS_collect != FLAGS_inputs.empty()) {
    return UsageError(FLAGS_collect
                          ? "--collect takes no maps, only --output_dir"
                          : "batch needs maps, or --collect");
  }
  if (FLAGS_collect && !FLAGS_plan.empty()) {
    return UsageError("--plan and --collect exclude each other");
  }
  if (FLAGS_task != "close_loops" && FLAGS_task != "audit") {
    return UsageError(absl::StrCat(
        "--task must be close_loops or audit, it is ", FLAGS_task));
  }
  if (FLAGS_jobs < 0 || FLAGS_jobs > kMaxNumProcesses) {
    return UsageError(absl::StrCat("--jobs must be from 0 to ",
                                   kMaxNumProcesses, ", it is ", FLAGS_jobs));
  }
  return NumThreadsOfFlags().status();
}

BatchSettings SettingsOfFlags() {
  BatchSettings settings;
  settings.directory = FLAGS_output_dir;
  settings.subcommand = FLAGS_task;
  settings.writes_reports = FLAGS_reports;
  // The maps fill the cores; the result does not depend on it.
  settings.more_flags = {
      absl::StrCat("--threads=", FLAGS_threads > 0 ? FLAGS_threads : 1)};
  for (const char* const name :
       {"repair", "drop_odometry", "configuration_directory",
        "configuration_basename"}) {
    const gflags::CommandLineFlagInfo info =
        gflags::GetCommandLineFlagInfoOrDie(name);
    if (info.is_default) continue;
    settings.more_flags.push_back(
        absl::StrCat("--", name, "=", info.current_value));
  }
  return settings;
}

int NumProcesses() {
  if (FLAGS_jobs > 0) return FLAGS_jobs;
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1,
                    kMaxNumProcesses);
}

absl::Status WriteSummary(const std::vector<BatchRow>& rows) {
  const std::pair<const char*, std::string> files[] = {
      {"summary.csv", FormatSummaryCsv(rows)},
      {"summary.json", FormatJson({{"maps", SummaryJson(rows)}})},
      {"failures.txt", FormatFailures(rows)},
      {"index.html", FormatSummaryPage(rows)}};
  for (const auto& [name, content] : files) {
    absl::Status status = WriteWholeFile(InDirectory(name), content);
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

// Of what all jobs left.
absl::Status Summarize(const std::vector<BatchJob>& jobs,
                       RunRecord* const record) {
  std::vector<BatchRow> rows;
  size_t num_failed = 0, num_nothing = 0;
  for (const BatchJob& job : jobs) {
    rows.push_back(MakeRow(job));
    num_failed += rows.back().has_failed();
    num_nothing += rows.back().status == OutcomeName(Outcome::kNothing);
  }
  const absl::Status status = WriteSummary(rows);
  if (!status.ok()) return status;
  record->Count("maps", rows.size());
  record->Count("failed", num_failed);
  record->Count("nothing", num_nothing);
  record->answer["maps"] = SummaryJson(rows);
  std::cout << absl::StrFormat("%d maps, %d failed, nothing found in %d\n%s\n",
                               rows.size(), num_failed, num_nothing,
                               InDirectory("index.html"));
  if (num_failed == 0) return absl::OkStatus();
  const std::string sentence =
      absl::StrFormat("%d of %d maps failed, see %s", num_failed, rows.size(),
                      InDirectory("failures.txt"));
  record->Warn(RunWarning::kMapsFailed, sentence);
  return absl::UnknownError(sentence);
}

absl::Status WritePlan(const std::vector<const BatchJob*>& jobs) {
  const std::string program =
      FLAGS_program.empty() ? ThisProgram() : FLAGS_program;
  std::string lines;
  for (const BatchJob* const job : jobs) {
    absl::StrAppend(&lines, ShellCommand(program, *job), "\n");
  }
  return WriteWholeFile(FLAGS_plan, lines);
}

absl::Status RunBatch(RunRecord* const record) {
  if (FLAGS_collect) {
    const absl::StatusOr<std::vector<BatchJob>> jobs =
        ReadJobs(InDirectory("batch.json"));
    return jobs.ok() ? Summarize(*jobs, record) : jobs.status();
  }
  StageProgress progress(record);
  const BatchSettings settings = SettingsOfFlags();
  const std::vector<BatchJob> jobs =
      MakeJobs(settings, SplitPaths(FLAGS_inputs));
  absl::Status status = MakeDirectories(settings);
  if (status.ok()) {
    status = WriteWholeFile(InDirectory("batch.json"), FormatJobs(jobs));
  }
  if (!status.ok()) return status;
  const ProgressCallback on_look = progress.Begin("look for finished maps");
  std::vector<const BatchJob*> unfinished;
  for (size_t k = 0; k < jobs.size(); ++k) {
    if (!IsFinished(jobs[k])) unfinished.push_back(&jobs[k]);
    on_look((static_cast<double>(k) + 1.) / static_cast<double>(jobs.size()));
  }
  record->Count("finished_before", jobs.size() - unfinished.size());
  if (!FLAGS_plan.empty()) return WritePlan(unfinished);
  const ProgressCallback on_progress = progress.Begin("maps");
  status = RunJobs(ThisProgram(), unfinished, NumProcesses(),
                   [&](const size_t num_ended) {
                     on_progress(static_cast<double>(num_ended) /
                                 static_cast<double>(unfinished.size()));
                   });
  progress.End();
  return status.ok() ? Summarize(jobs, record) : status;
}

}  // namespace

// Long: a description, with all flags.
Subcommand BatchSubcommand() {
  Subcommand subcommand{
      "batch",
      "do one task on many maps, and summarise",
      "MAP.pbstream... --output_dir DIR [--jobs N] [--task close_loops|audit] "
      "[--plan FILE | --collect]",
      "Runs close_loops or audit on each map, in a process of its own, so that "
      "one map that fails leaves the others alone. --output_dir gets maps/, "
      "results/ (JSON of --result), logs/, pictures/, and the summary: "
      "index.html with pictures, summary.csv, summary.json, and failures.txt "
      "with the paths of the maps that failed. The exit code is 1 if one "
      "failed.\n\n"
      "What is finished is not done again: maps with a result of the same "
      "program, flags and input. Beyond one machine, --plan writes the "
      "commands "
      "that are left, for GNU parallel, an array of Slurm, or jobs of "
      "Kubernetes; --collect then makes the summary.",
      {{"output_dir",
        FileUse::kWriteInto,
        {"batch.json", "summary.csv", "summary.json", "failures.txt",
         "index.html"}}},
      {{"inputs",
        FileUse::kPassList,
        {},
        "Maps, separated by commas; a comma in a path is written \\,. Maps "
        "that are given without a flag are taken as they are."},
       "jobs",
       "task",
       "reports",
       {"plan", FileUse::kWriteText},
       "collect",
       "program",
       "repair",
       "drop_odometry",
       "configuration_directory",
       "configuration_basename",
       {"threads",
        FileUse::kNone,
        {},
        "Number of threads for each map; 0: one. The result does not depend on "
        "it."}},
      &RunBatch};
  subcommand.check_flags = &CheckFlagsOfBatch;
  subcommand.positional_flags = {"inputs"};
  return subcommand;
}

}  // namespace cartographer_sdf
