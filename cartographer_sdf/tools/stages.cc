// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/stages.h"

#include <filesystem>
#include <iostream>
#include <map>
#include <optional>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/file/pending_file.h"
#include "cartographer_sdf/tools/file_flags.h"
#include "cartographer_sdf/tools/flags.h"

namespace cartographer_sdf {
namespace {

// If the map is changed in place, keeps the old one first. At every moment
// there is a whole map under the name of the input.
absl::Status CommitOutput(RecordWriter* const output) {
  const std::string backup = FLAGS_in_place ? BackupPath(FLAGS_input) : "";
  if (backup.empty()) return output->Commit();
  absl::Status status = KeepAs(FLAGS_input, backup);
  if (!status.ok()) return status;
  status = output->Commit();
  std::error_code ignored;
  if (!status.ok()) std::filesystem::remove(backup, ignored);
  return status;
}

}  // namespace

absl::StatusOr<MapTask> MapTaskOfFlags(const std::string& subcommand) {
  absl::StatusOr<Options> options = LoadOptionsOfFlags();
  if (!options.ok()) return options.status();
  if (options->loop_closing.recognition.match.method != Method::kSdf) {
    return absl::InvalidArgumentError(
        absl::StrCat(subcommand,
                     " needs match.method = \"sdf\": counting inliers does not "
                     "verify a match"));
  }
  const absl::StatusOr<int> num_threads = NumThreadsOfFlags();
  if (!num_threads.ok()) return num_threads.status();
  absl::StatusOr<std::set<int>> frozen = FrozenTrajectoriesOfFlags();
  if (!frozen.ok()) return frozen.status();
  return MapTask{*std::move(options), MakeExecutor(*num_threads),
                 *std::move(frozen)};
}

absl::StatusOr<DescribedMap> DescribeMapOfFlags(
    const LoopClosingOptions& options, const std::string& path,
    const Executor& executor, const PointClouds point_clouds,
    const ProgressCallback& on_progress) {
  const MatchOptions& match = options.recognition.match;
  if (FLAGS_places.empty()) {
    return DescribeMap(options.place, match, SourceOfFlags(path), executor,
                       on_progress, point_clouds);
  }
  absl::StatusOr<RememberedMap> remembered = RememberMap(
      options.place, match, FormatPlaceOptions(options.place, match),
      SourceOfFlags(path), FLAGS_places, executor, on_progress, point_clouds);
  if (!remembered.ok()) return remembered.status();
  if (!remembered->complaint.empty()) {
    std::cerr << "--places: " << remembered->complaint << "\n";
  }
  return std::move(remembered->map);
}

absl::Status WriteMapAndReport(
    const PoseGraph& pose_graph,
    const std::function<absl::Status(const SubmapsReader&)>& write_report,
    StageProgress* const progress) {
  std::optional<RecordWriter> output;
  const auto read_and_write =
      [&](const SubmapCallback& on_submap) -> absl::Status {
    if (FLAGS_output.empty()) {
      return ReadMap(SourceOfFlags(FLAGS_input), {on_submap, {}},
                     progress->Begin("report"))
          .status();
    }
    absl::StatusOr<RecordWriter> map =
        PrepareMap(SourceOfFlags(FLAGS_input), FLAGS_output, pose_graph,
                   {on_submap, {}}, progress->Begin("write"));
    if (map.ok()) output.emplace(*std::move(map));
    return map.status();
  };
  absl::Status status;
  if (!FLAGS_report.empty()) {
    status = write_report(read_and_write);
  } else if (!FLAGS_output.empty()) {
    status = read_and_write({});
  }
  return status.ok() && output ? CommitOutput(&*output) : status;
}

void PrintStages(const std::vector<std::pair<std::string, double>>& seconds) {
  for (const auto& [stage, duration] : seconds) {
    std::cout << absl::StrFormat("  %7.2f s %s\n", duration, stage);
  }
}

void PrintStatuses(const std::string& prefix,
                   const std::vector<Closure>& closures) {
  std::map<ClosureStatus, int> counts;
  for (const Closure& closure : closures) ++counts[closure.status];
  for (const auto& [status, count] : counts) {
    std::cout << absl::StrFormat("  %5d %s%s\n", count, prefix,
                                 ClosureStatusName(status));
  }
}

void PrintConvergence(const std::vector<OptimizationSummary>& summaries) {
  if (summaries.empty() || summaries.back().converged) return;
  std::cout << "The optimisation did not converge: " << summaries.back().message
            << "\n";
}

void PrintPaths() {
  if (!FLAGS_output.empty()) std::cout << FLAGS_output << "\n";
  if (FLAGS_in_place && FLAGS_backup) {
    std::cout << BackupPath(FLAGS_input) << " (the old map)\n";
  }
  if (!FLAGS_report.empty()) std::cout << FLAGS_report << "/index.html\n";
}

}  // namespace cartographer_sdf
