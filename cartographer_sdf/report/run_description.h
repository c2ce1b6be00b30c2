// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_REPORT_RUN_DESCRIPTION_H_
#define CARTOGRAPHER_SDF_REPORT_RUN_DESCRIPTION_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace cartographer_sdf {

// A file as it was before the run.
struct InputFile {
  std::string flag;  // without dashes
  std::string path;
  std::optional<uint64_t> num_bytes;
  std::string sha256;
};

// What ran, on what: known before the work.
struct RunDescription {
  std::string program;
  std::string version;
  std::string commit;
  std::string command;  // the subcommand; empty if the program has only one
  std::vector<std::string> arguments;
  std::string started;  // UTC, e.g. "2026-11-27T03:05:01Z"
  std::vector<InputFile> inputs;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_RUN_DESCRIPTION_H_
