// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The files that a subcommand reads and writes, checked before any work: that
// inputs are there, that outputs can be written, and that nothing is lost which
// should not be.

#ifndef CARTOGRAPHER_SDF_TOOLS_FILE_FLAGS_H_
#define CARTOGRAPHER_SDF_TOOLS_FILE_FLAGS_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "gflags/gflags.h"

DECLARE_bool(in_place);
DECLARE_bool(backup);
DECLARE_bool(repair);
DECLARE_bool(drop_odometry);

namespace cartographer_sdf {

struct Subcommand;

// What becomes of the file that a flag names.
enum class FileUse {
  kNone,       // it names no file
  kRead,       // a file to read
  kReadList,   // several, see SplitPaths
  kPassList,   // several, which other processes read, or fail to
  kWriteText,  // a table or the like; "-" is the standard output
  kWriteTextList,
  kWriteMap,  // a .pbstream
  kCopyMap,   // a .pbstream with all that the maps which are read contain
  kCache,     // a place file: read where it fits, else written
  kCacheList,
  kWriteInto,  // a directory, made if it is missing
};

// A flag of a subcommand, by its name in gflags.
struct SubcommandFlag {
  SubcommandFlag(const char* const name,  // NOLINT: most are no more than that
                 const FileUse use = FileUse::kNone,
                 std::vector<std::string> written_names = {},
                 std::string help = "")
      : name(name),
        use(use),
        written_names(std::move(written_names)),
        help(std::move(help)) {}

  std::string name;
  FileUse use;
  // Of kWriteInto: the names of the files that are written there.
  std::vector<std::string> written_names;
  // What it means to this subcommand; if empty, the flag's own description.
  std::string help;
};

[[nodiscard]] bool TakesSeveralFiles(const SubcommandFlag& flag);

struct NamedFile {
  std::string flag;  // without dashes
  std::string path;
};

// Splits a list of paths at commas. A comma that belongs to a path is written
// "\,", and a backslash before a comma or a backslash "\\".
[[nodiscard]] std::vector<std::string> SplitPaths(const std::string& list);
// The inverse of SplitPaths.
[[nodiscard]] std::string JoinPaths(const std::vector<std::string>& paths);

// With --in_place, makes the input the output.
[[nodiscard]] absl::Status ApplyInPlace(const Subcommand& subcommand);

// Returns an error, before any work and without reading an input, if
//
// - an input is missing, cannot be read, or is no regular file: pipes cannot be
//   read twice;
// - an output is an input, by whatever name, but for --in_place; or two outputs
//   are one file;
// - an output could not be written: its directory is missing or
// write-protected,
//   it is a device, the disk lacks space for what is copied;
// - an output exists and is a file of another kind: a table would replace a
// map,
//   or a map something else; or the backup of --in_place exists.
[[nodiscard]] absl::Status CheckFiles(const Subcommand& subcommand);

// The same for the file of --result alone, inputs aside: whatever is wrong with
// others, it may be written.
[[nodiscard]] absl::Status CheckResultFile(const Subcommand& subcommand);

// The files that the flags name; those that are read include the configuration
// file that is found, and not the standard output.
[[nodiscard]] std::vector<NamedFile> FilesThatAreRead(
    const Subcommand& subcommand);
[[nodiscard]] std::vector<NamedFile> FilesThatAreWritten(
    const Subcommand& subcommand);

// Whether an output of the subcommand is the standard output.
[[nodiscard]] bool WritesToStandardOutput(const Subcommand& subcommand);

// The name under which --in_place keeps the old map; empty with --nobackup.
[[nodiscard]] std::string BackupPath(const std::string& path);

// The map at a path, as --repair and --drop_odometry say.
[[nodiscard]] MapSource SourceOfFlags(const std::string& path);

// Prints what was left out of a map, if anything.
void PrintRepair(const MapState& map);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_FILE_FLAGS_H_
