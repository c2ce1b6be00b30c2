// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/file_flags.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/strip.h"
#include "cartographer_sdf/file/pending_file.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/pbstream/record_stream.h"
#include "cartographer_sdf/place_store/place_file.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/subcommand.h"

DEFINE_bool(in_place, false,
            "Replace the map of --input; instead of --output. The old map is "
            "kept beside it, see --backup.");
DEFINE_bool(backup, true,
            "With --in_place: keep the old map under its name with .bak "
            "appended.");
DEFINE_bool(repair, false,
            "Leave out submaps and nodes that the map has poses but no data "
            "of, as after a file was cut. Otherwise it is refused.");
DEFINE_bool(drop_odometry, false,
            "Read and write maps as if they had no odometry. Cartographer "
            "weighs it anew when it loads a map unfrozen, and may bend a map "
            "that is better than its odometry.");

namespace cartographer_sdf {
namespace {

namespace fs = std::filesystem;

constexpr char kBackupSuffix[] = ".bak";
constexpr char kConfigurationFlag[] = "--configuration_basename";

struct UsedFile {
  std::string flag;
  std::string path;
  FileUse use = FileUse::kNone;
  // Whether its directory is made before it is written.
  bool has_own_directory = false;

  [[nodiscard]] bool is_output() const { return use != FileUse::kRead; }
  [[nodiscard]] bool is_map() const {
    return use == FileUse::kWriteMap || use == FileUse::kCopyMap;
  }
};

bool HasFlag(const Subcommand& subcommand, const std::string& name) {
  return subcommand.FindFlag(name) != nullptr;
}

// The configuration file that is read, if there is one.
std::optional<std::string> ConfigurationFile() {
  for (const std::string& directory : ConfigurationDirectories()) {
    const fs::path path = fs::path(directory) / FLAGS_configuration_basename;
    std::error_code error;
    if (fs::exists(path, error)) return path.string();
  }
  return std::nullopt;
}

// What becomes of each file of a list.
FileUse UseOfEach(const FileUse list) {
  if (list == FileUse::kReadList) return FileUse::kRead;
  return list == FileUse::kCacheList ? FileUse::kCache : FileUse::kWriteText;
}

// Appends what a flag names, each file of a list by itself.
void AppendFiles(const SubcommandFlag& flag, std::vector<UsedFile>* const all) {
  const std::string value =
      gflags::GetCommandLineFlagInfoOrDie(flag.name.c_str()).current_value;
  if (value.empty() || flag.use == FileUse::kNone ||
      flag.use == FileUse::kPassList) {
    return;
  }
  const std::string name = absl::StrCat("--", flag.name);
  if (TakesSeveralFiles(flag)) {
    for (const std::string& path : SplitPaths(value)) {
      all->push_back({name, path, UseOfEach(flag.use), false});
    }
    return;
  }
  all->push_back({name, value, flag.use, false});
  for (const std::string& written : flag.written_names) {
    all->push_back({name, (fs::path(value) / written).string(),
                    FileUse::kWriteText, true});
  }
}

std::vector<UsedFile> FilesOfFlags(const Subcommand& subcommand) {
  std::vector<UsedFile> files;
  for (const SubcommandFlag& flag : subcommand.AllFlags()) {
    AppendFiles(flag, &files);
  }
  if (HasFlag(subcommand, "configuration_basename")) {
    if (std::optional<std::string> path = ConfigurationFile()) {
      files.push_back({kConfigurationFlag, *path, FileUse::kRead, false});
    }
  }
  return files;
}

// Also of files that do not exist yet.
bool AreSameFile(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::exists(a, error) && fs::exists(b, error)) {
    return fs::equivalent(a, b, error);
  }
  const auto canonical = [&error](const std::string& path) {
    return fs::weakly_canonical(fs::absolute(FollowLinks(path)), error);
  };
  return canonical(a) == canonical(b);
}

absl::Status CheckInput(const UsedFile& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file.path, error);
  const std::string problem = absl::StrCat("cannot open ", file.path);
  if (status.type() == fs::file_type::not_found) {
    return absl::NotFoundError(
        absl::StrCat(problem, ": there is no such file"));
  }
  if (error) return absl::ErrnoToStatus(error.value(), problem);
  if (status.type() != fs::file_type::regular) {
    return absl::InvalidArgumentError(
        absl::StrCat(problem, ": not a regular file"));
  }
  return access(file.path.c_str(), R_OK) == 0
             ? absl::OkStatus()
             : absl::ErrnoToStatus(errno, problem);
}

std::string Problem(const UsedFile& file) {
  return absl::StrCat("cannot write ", file.path, " (", file.flag, "): ");
}

// By what the target is now.
absl::Status CheckKind(const UsedFile& file) {
  std::error_code error;
  if (!fs::is_regular_file(file.path, error) ||
      fs::file_size(file.path, error) == 0) {
    return absl::OkStatus();
  }
  if (file.use == FileUse::kCache && !IsPlaceFile(file.path)) {
    return absl::AlreadyExistsError(
        absl::StrCat(Problem(file), "it exists, and is no file of places"));
  }
  if (file.is_map() && !HasMagicNumber(file.path)) {
    return absl::AlreadyExistsError(
        absl::StrCat(Problem(file), "it exists, and is no map"));
  }
  if (file.use == FileUse::kWriteText && HasMagicNumber(file.path)) {
    return absl::AlreadyExistsError(absl::StrCat(
        Problem(file), "it is a map, and something else would replace it"));
  }
  return absl::OkStatus();
}

// The directory itself, or the one in which it will be made.
absl::Status CheckDirectory(const UsedFile& file) {
  fs::path directory = fs::absolute(file.path);
  std::error_code error;
  while (!fs::exists(directory, error) && directory.has_relative_path()) {
    directory = directory.parent_path();
  }
  if (!fs::is_directory(directory, error)) {
    return absl::InvalidArgumentError(
        absl::StrCat(Problem(file), directory.string(), " is not a directory"));
  }
  const absl::Status status =
      PendingFile::Create((directory / "cartographer_sdf").string()).status();
  return status.ok()
             ? status
             : absl::Status(status.code(),
                            absl::StrCat(Problem(file), status.message()));
}

absl::Status CheckOutput(const UsedFile& file) {
  if (file.path == kStandardOutput) {
    if (file.use == FileUse::kWriteText) return absl::OkStatus();
    return UsageError(absl::StrCat(
        file.flag, ": only tables can be written to the standard output"));
  }
  if (file.use == FileUse::kWriteInto) return CheckDirectory(file);
  std::error_code error;
  if (file.has_own_directory && !fs::exists(file.path, error)) {
    return absl::OkStatus();
  }
  const absl::Status status = CheckKind(file);
  // Removes what it creates.
  return status.ok() ? PendingFile::Create(file.path).status() : status;
}

// A map that copies others is no smaller, but for what is dropped.
absl::Status CheckSpace(const std::vector<UsedFile>& files) {
  uintmax_t needed = 0;
  for (const UsedFile& file : files) {
    std::error_code error;
    const bool is_map =
        file.use == FileUse::kRead && file.flag != kConfigurationFlag;
    if (is_map) needed += fs::file_size(file.path, error);
  }
  for (const UsedFile& file : files) {
    if (file.use != FileUse::kCopyMap) continue;
    std::error_code error;
    const fs::space_info space =
        fs::space(fs::absolute(file.path).parent_path(), error);
    if (error || space.available >= needed) continue;
    return absl::ResourceExhaustedError(absl::StrFormat(
        "%sit needs %.1f MB or more, and its disk has %.1f MB left",
        Problem(file), static_cast<double>(needed) / 1e6,
        static_cast<double>(space.available) / 1e6));
  }
  return absl::OkStatus();
}

absl::Status CheckIsNot(const UsedFile& output, const UsedFile& other) {
  if (!AreSameFile(output.path, other.path)) return absl::OkStatus();
  if (output.is_map() && other.use == FileUse::kRead && FLAGS_in_place &&
      other.flag == "--input") {
    return absl::OkStatus();
  }
  const bool is_input = other.use == FileUse::kRead;
  return absl::InvalidArgumentError(absl::StrCat(
      Problem(output), "it is ",
      is_input ? "one of the files that are read (" : "also written by (",
      other.flag, ")"));
}

// Each output against every input, and against the outputs before it.
absl::Status CheckNothingIsLost(const std::vector<UsedFile>& files) {
  for (size_t a = 0; a < files.size(); ++a) {
    if (!files[a].is_output()) continue;
    for (size_t b = 0; b < files.size(); ++b) {
      const bool is_earlier = b < a && files[b].is_output();
      if (a == b || !(is_earlier || files[b].use == FileUse::kRead)) continue;
      absl::Status status = CheckIsNot(files[a], files[b]);
      if (!status.ok()) return status;
    }
  }
  return absl::OkStatus();
}

absl::Status CheckBackup(const Subcommand& subcommand) {
  if (!HasFlag(subcommand, "in_place") || !FLAGS_in_place) {
    return absl::OkStatus();
  }
  const std::string backup = BackupPath(FLAGS_input);
  std::error_code error;
  if (backup.empty() || !fs::exists(fs::symlink_status(backup, error)) ||
      fs::equivalent(FLAGS_input, backup, error)) {
    return absl::OkStatus();
  }
  return absl::AlreadyExistsError(
      absl::StrCat("cannot keep ", FLAGS_input, " as ", backup,
                   ": it exists; move it away, or say --nobackup"));
}

std::vector<NamedFile> FilesWhere(
    const Subcommand& subcommand,
    const std::function<bool(const UsedFile&)>& is_wanted) {
  std::vector<NamedFile> named;
  for (const UsedFile& file : FilesOfFlags(subcommand)) {
    if (!is_wanted(file)) continue;
    named.push_back(
        {std::string(absl::StripPrefix(file.flag, "--")), file.path});
  }
  return named;
}

}  // namespace

bool TakesSeveralFiles(const SubcommandFlag& flag) {
  return flag.use == FileUse::kReadList || flag.use == FileUse::kPassList ||
         flag.use == FileUse::kWriteTextList || flag.use == FileUse::kCacheList;
}

std::vector<std::string> SplitPaths(const std::string& list) {
  std::vector<std::string> paths;
  std::string path;
  const auto end_path = [&] {
    if (!path.empty()) paths.push_back(std::exchange(path, ""));
  };
  for (size_t k = 0; k < list.size(); ++k) {
    const bool is_escaped = list[k] == '\\' && k + 1 < list.size() &&
                            (list[k + 1] == ',' || list[k + 1] == '\\');
    if (list[k] == ',') {
      end_path();
    } else {
      path += is_escaped ? list[++k] : list[k];
    }
  }
  end_path();
  return paths;
}

std::string JoinPaths(const std::vector<std::string>& paths) {
  std::vector<std::string> escaped;
  for (const std::string& path : paths) {
    escaped.push_back(
        absl::StrReplaceAll(path, {{"\\", "\\\\"}, {",", "\\,"}}));
  }
  return absl::StrJoin(escaped, ",");
}

absl::Status ApplyInPlace(const Subcommand& subcommand) {
  if (!HasFlag(subcommand, "in_place")) return absl::OkStatus();
  if (!FLAGS_in_place) {
    return FLAGS_backup ? absl::OkStatus()
                        : UsageError("--nobackup needs --in_place");
  }
  if (!FLAGS_output.empty()) {
    return UsageError("--in_place and --output exclude each other");
  }
  FLAGS_output = FLAGS_input;
  return absl::OkStatus();
}

absl::Status CheckFiles(const Subcommand& subcommand) {
  const std::vector<UsedFile> files = FilesOfFlags(subcommand);
  for (const UsedFile& file : files) {
    if (file.use != FileUse::kRead) continue;
    absl::Status status = CheckInput(file);
    if (!status.ok()) return status;
  }
  absl::Status status = CheckNothingIsLost(files);
  if (!status.ok()) return status;
  for (const UsedFile& file : files) {
    if (!file.is_output()) continue;
    status = CheckOutput(file);
    if (!status.ok()) return status;
  }
  status = CheckBackup(subcommand);
  return status.ok() ? CheckSpace(files) : status;
}

absl::Status CheckResultFile(const Subcommand& subcommand) {
  const std::vector<UsedFile> files = FilesOfFlags(subcommand);
  for (const UsedFile& result : files) {
    if (result.flag != "--result") continue;
    for (const UsedFile& other : files) {
      if (other.flag == result.flag) continue;
      absl::Status status = CheckIsNot(result, other);
      if (!status.ok()) return status;
    }
    return CheckOutput(result);
  }
  return absl::OkStatus();
}

std::vector<NamedFile> FilesThatAreRead(const Subcommand& subcommand) {
  return FilesWhere(subcommand, [](const UsedFile& file) {
    return file.use == FileUse::kRead;
  });
}

std::vector<NamedFile> FilesThatAreWritten(const Subcommand& subcommand) {
  return FilesWhere(subcommand, [](const UsedFile& file) {
    return file.is_output() && file.path != kStandardOutput;
  });
}

bool WritesToStandardOutput(const Subcommand& subcommand) {
  const std::vector<UsedFile> files = FilesOfFlags(subcommand);
  return std::any_of(files.begin(), files.end(), [](const UsedFile& file) {
    return file.use == FileUse::kWriteText && file.path == kStandardOutput;
  });
}

std::string BackupPath(const std::string& path) {
  if (!FLAGS_backup) return "";
  return absl::StrCat(FollowLinks(path), kBackupSuffix);
}

MapSource SourceOfFlags(const std::string& path) {
  return {
      path, FLAGS_repair ? MissingRecords::kDrop : MissingRecords::kRefuse,
      FLAGS_drop_odometry ? OdometryRecords::kDrop : OdometryRecords::kKeep};
}

void PrintRepair(const MapState& map) {
  if (map.num_unrecorded_submaps + map.num_unrecorded_nodes == 0) return;
  std::cout << absl::StrFormat(
      "repaired: %d submaps and %d nodes without data were left out\n",
      map.num_unrecorded_submaps, map.num_unrecorded_nodes);
}

}  // namespace cartographer_sdf
