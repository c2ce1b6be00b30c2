// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/result_file.h"

#include <sys/resource.h>

#include <ctime>
#include <filesystem>
#include <optional>

#include "cartographer_sdf/file/sha256.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/version.h"

DEFINE_string(result, "",
              "JSON file to write the result to, -: the standard output. The "
              "same members for every subcommand, and then those of this one; "
              "also after an error. None if empty.");

namespace cartographer_sdf {
namespace {

int64_t PeakMemoryBytes() {
  constexpr int64_t kKibibyte = 1024;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss * kKibibyte;
}

// E.g. "2026-11-27T03:05:01Z".
std::string FormatIsoTime(const std::chrono::system_clock::time_point time) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(time);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[32];
  const size_t length =
      std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return std::string(text, length);
}

std::string StatusName(const RunRecord& record, const absl::Status& status) {
  if (status.ok()) return OutcomeName(record.outcome);
  if (IsRefusal(status)) return OutcomeName(Outcome::kRefused);
  return IsUsageError(status) ? "wrong_usage" : "failed";
}

std::optional<uint64_t> BytesOf(const std::string& path) {
  std::error_code error;
  const uintmax_t bytes = std::filesystem::file_size(path, error);
  return error ? std::nullopt : std::make_optional<uint64_t>(bytes);
}

Json OutputsJson(const Subcommand& subcommand) {
  Json json = Json::array();
  for (const NamedFile& file : FilesThatAreWritten(subcommand)) {
    std::error_code error;
    if (file.flag == "result" ||
        !std::filesystem::is_regular_file(file.path, error)) {
      continue;
    }
    json.push_back({{"flag", file.flag},
                    {"path", file.path},
                    {"bytes", ToJson(BytesOf(file.path))}});
  }
  return json;
}

// Stages that ran several times have one entry, with the sum.
Json SecondsJson(const RunRecord& record, const double total) {
  Json stages = Json::object();
  for (const auto& [stage, seconds] : record.stage_seconds) {
    stages[stage] = stages.value(stage, 0.) + seconds;
  }
  return {{"total", total}, {"stages", std::move(stages)}};
}

Json WarningsJson(const RunRecord& record) {
  Json json = Json::array();
  for (const auto& [warning, sentence] : record.warnings) {
    json.push_back({{"code", RunWarningCode(warning)}, {"message", sentence}});
  }
  return json;
}

Json CountsJson(const RunRecord& record) {
  Json json = Json::object();
  for (const auto& [name, number] : record.counts) json[name] = number;
  return json;
}

}  // namespace

RunDescription DescribeRun(const Subcommand& subcommand,
                           const std::vector<std::string>& arguments) {
  return {subcommand.program,
          ProgramVersion(),
          ProgramCommit(),
          subcommand.name,
          arguments,
          FormatIsoTime(std::chrono::system_clock::now()),
          {}};
}

absl::Status DescribeInputs(const Subcommand& subcommand,
                            RunDescription* const run) {
  if (FLAGS_result.empty() && FLAGS_report.empty()) return absl::OkStatus();
  for (const NamedFile& file : FilesThatAreRead(subcommand)) {
    const absl::StatusOr<std::string> sum = Sha256OfFile(file.path);
    if (!sum.ok()) return sum.status();
    run->inputs.push_back({file.flag, file.path, BytesOf(file.path), *sum});
  }
  return absl::OkStatus();
}

ResultFile::ResultFile(const Subcommand& subcommand)
    : subcommand_(subcommand), begin_(std::chrono::steady_clock::now()) {}

absl::Status ResultFile::Write(const RunRecord& record,
                               const RunEnd& end) const {
  if (FLAGS_result.empty()) return absl::OkStatus();
  const double total =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_)
          .count();
  const std::string message =
      end.status.ok() ? record.reason : std::string(end.status.message());
  Json json = {{"schema", kResultSchema},
               {"schema_version", kResultSchemaVersion}};
  json.update(ToJson(record.run));
  json.update(
      {{"status", StatusName(record, end.status)},
       {"exit_code", static_cast<int>(end.exit_code)},
       {"message", message},
       {"outputs", end.status.ok() ? OutputsJson(subcommand_) : Json::array()},
       {"counts", CountsJson(record)},
       {"warnings", WarningsJson(record)},
       {"seconds", SecondsJson(record, total)},
       {"peak_memory_bytes", PeakMemoryBytes()}});
  json.update(record.answer);
  return WriteWholeFile(FLAGS_result, FormatJson(json));
}

}  // namespace cartographer_sdf
