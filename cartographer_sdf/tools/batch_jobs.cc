// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/batch_jobs.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "cartographer_sdf/file/sha256.h"
#include "cartographer_sdf/tools/json_members.h"
#include "cartographer_sdf/tools/version.h"

namespace cartographer_sdf {
namespace {

namespace fs = std::filesystem;

constexpr char kJobsSchema[] = "cartographer_sdf.batch";
constexpr int kJobsSchemaVersion = 1;
constexpr const char* kFolders[] = {"maps", "results", "logs", "pictures"};

std::string Absolute(const std::string& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  return error ? path : absolute.lexically_normal().string();
}

BatchJob MakeJob(const BatchSettings& settings, const std::string& name,
                 const std::string& input) {
  const auto file = [&](const std::string& folder, const std::string& ending) {
    return Absolute(
        absl::StrCat(settings.directory, "/", folder, "/", name, ending));
  };
  BatchJob job;
  job.name = name;
  job.input = Absolute(input);
  job.result = file("results", ".json");
  job.log = file("logs", ".txt");
  job.output = file("maps", ".pbstream");
  job.picture = file("pictures", ".png");
  // One argument each, so that no file name looks like a flag.
  job.arguments = {settings.subcommand,
                   absl::StrCat("--input=", job.input),
                   absl::StrCat("--output=", job.output),
                   absl::StrCat("--result=", job.result),
                   absl::StrCat("--picture=", job.picture),
                   "--picture_pixels=320"};
  if (settings.writes_reports) {
    job.arguments.push_back(absl::StrCat("--report=", file("reports", "")));
  }
  job.arguments.insert(job.arguments.end(), settings.more_flags.begin(),
                       settings.more_flags.end());
  return job;
}

std::string Quote(const std::string& word) {
  return absl::StrCat("'", absl::StrReplaceAll(word, {{"'", "'\\''"}}), "'");
}

absl::StatusOr<Json> ReadJson(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return absl::ErrnoToStatus(errno, "cannot read " + path);
  const std::string text{std::istreambuf_iterator<char>(file),
                         std::istreambuf_iterator<char>()};
  Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) {
    return absl::InvalidArgumentError(path + " is no JSON object");
  }
  return json;
}

std::vector<std::string> Texts(const Json& json) {
  std::vector<std::string> texts;
  if (!json.is_array()) return texts;
  for (const Json& element : json) {
    if (element.is_string()) texts.push_back(element.get<std::string>());
  }
  return texts;
}

// Only calls what is safe between fork and exec.
[[noreturn]] void BecomeJob(char* const* const argv, const char* const log) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  const int nothing = open("/dev/null", O_RDONLY);
  const int output = open(log, O_CREAT | O_TRUNC | O_WRONLY, 0666);
  if (nothing < 0 || output < 0 || dup2(nothing, STDIN_FILENO) < 0 ||
      dup2(output, STDOUT_FILENO) < 0 || dup2(output, STDERR_FILENO) < 0) {
    _exit(126);
  }
  execv(argv[0], argv);
  _exit(127);
}

absl::StatusOr<pid_t> Start(const std::string& program, const BatchJob& job) {
  // An earlier result says nothing about this run.
  std::error_code ignored;
  fs::remove(job.result, ignored);
  std::vector<std::string> words = {program};
  words.insert(words.end(), job.arguments.begin(), job.arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child < 0) return absl::ErrnoToStatus(errno, "cannot start a process");
  if (child == 0) BecomeJob(argv.data(), job.log.c_str());
  return child;
}

absl::Status WaitForOne() {
  int status = 0;
  pid_t child = 0;
  do {
    child = waitpid(-1, &status, 0);
  } while (child < 0 && errno == EINTR);
  return child < 0 ? absl::ErrnoToStatus(errno, "cannot wait for a process")
                   : absl::OkStatus();
}

}  // namespace

std::vector<BatchJob> MakeJobs(const BatchSettings& settings,
                               const std::vector<std::string>& maps) {
  constexpr size_t kNumDigits = 8;
  std::vector<std::string> different;
  for (const std::string& map : maps) {
    const std::string path = Absolute(map);
    if (std::find(different.begin(), different.end(), path) ==
        different.end()) {
      different.push_back(path);
    }
  }
  std::map<std::string, int> counts;
  for (const std::string& map : different) {
    ++counts[fs::path(map).stem().string()];
  }
  std::vector<BatchJob> jobs;
  for (const std::string& map : different) {
    std::string name = fs::path(map).stem().string();
    if (counts[name] > 1) {
      absl::StrAppend(&name, "-", Sha256(map).substr(0, kNumDigits));
    }
    jobs.push_back(MakeJob(settings, name, map));
  }
  return jobs;
}

absl::Status MakeDirectories(const BatchSettings& settings) {
  for (const char* const folder : kFolders) {
    std::error_code error;
    const fs::path path = fs::path(settings.directory) / folder;
    fs::create_directories(path, error);
    if (!fs::is_directory(path, error)) {
      return absl::UnavailableError(
          absl::StrCat("cannot make the directory ", path.string()));
    }
  }
  return absl::OkStatus();
}

std::string FormatJobs(const std::vector<BatchJob>& jobs) {
  Json list = Json::array();
  for (const BatchJob& job : jobs) {
    list.push_back({{"name", job.name},
                    {"input", job.input},
                    {"arguments", job.arguments},
                    {"result", job.result},
                    {"log", job.log},
                    {"output", job.output},
                    {"picture", job.picture}});
  }
  return FormatJson({{"schema", kJobsSchema},
                     {"schema_version", kJobsSchemaVersion},
                     {"jobs", std::move(list)}});
}

absl::StatusOr<std::vector<BatchJob>> ReadJobs(const std::string& path) {
  const absl::StatusOr<Json> json = ReadJson(path);
  if (!json.ok()) return json.status();
  const Json list = MemberOf(*json, "jobs");
  if (TextOf(*json, "schema") != kJobsSchema || !list.is_array()) {
    return absl::InvalidArgumentError(path + " is no list of jobs of batch");
  }
  std::vector<BatchJob> jobs;
  for (const Json& entry : list) {
    jobs.push_back({TextOf(entry, "name"), TextOf(entry, "input"),
                    Texts(MemberOf(entry, "arguments")),
                    TextOf(entry, "result"), TextOf(entry, "log"),
                    TextOf(entry, "output"), TextOf(entry, "picture")});
  }
  return jobs;
}

std::optional<Json> ReadResult(const BatchJob& job) {
  absl::StatusOr<Json> json = ReadJson(job.result);
  if (!json.ok()) return std::nullopt;
  return *std::move(json);
}

bool IsFinished(const BatchJob& job) {
  const std::optional<Json> result = ReadResult(job);
  if (!result || MemberOf(*result, "exit_code") != 0) return false;
  const Json program = MemberOf(*result, "program");
  std::vector<std::string> arguments = {
      TextOf(MemberOf(*result, "command"), "name")};
  for (std::string& argument :
       Texts(MemberOf(MemberOf(*result, "command"), "arguments"))) {
    arguments.push_back(std::move(argument));
  }
  std::error_code error;
  if (arguments != job.arguments ||
      TextOf(program, "version") != ProgramVersion() ||
      TextOf(program, "commit") != ProgramCommit() ||
      !fs::exists(job.output, error)) {
    return false;
  }
  const Json inputs = MemberOf(*result, "inputs");
  const absl::StatusOr<std::string> sum = Sha256OfFile(job.input);
  return sum.ok() && inputs.is_array() && !inputs.empty() &&
         TextOf(inputs[0], "sha256") == *sum;
}

std::string ShellCommand(const std::string& program, const BatchJob& job) {
  std::string line = Quote(program);
  for (const std::string& argument : job.arguments) {
    absl::StrAppend(&line, " ", Quote(argument));
  }
  return absl::StrCat(line, " > ", Quote(job.log), " 2>&1");
}

absl::Status RunJobs(const std::string& program,
                     const std::vector<const BatchJob*>& jobs,
                     const int num_processes,
                     const std::function<void(size_t)>& on_ended) {
  size_t num_running = 0, num_ended = 0;
  absl::Status status;
  for (const BatchJob* const job : jobs) {
    if (num_running == static_cast<size_t>(num_processes)) {
      status = WaitForOne();
      if (!status.ok()) return status;
      --num_running;
      on_ended(++num_ended);
    }
    const absl::StatusOr<pid_t> child = Start(program, *job);
    if (!child.ok()) {
      status = child.status();
      break;
    }
    ++num_running;
  }
  for (; num_running > 0; --num_running) {
    if (absl::Status waited = WaitForOne(); !waited.ok()) return waited;
    on_ended(++num_ended);
  }
  return status;
}

std::string ThisProgram() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? "cartographer_sdf" : program.string();
}

}  // namespace cartographer_sdf
