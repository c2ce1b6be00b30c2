// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/file/whole_file.h"

#include <unistd.h>

#include <cerrno>
#include <iostream>

#include "cartographer_sdf/file/pending_file.h"

namespace cartographer_sdf {
namespace {

absl::Status WriteToStandardOutput(const std::string& content) {
  std::cout.flush();
  size_t written = 0;
  while (written < content.size()) {
    const ssize_t count = write(STDOUT_FILENO, content.data() + written,
                                content.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      return absl::ErrnoToStatus(errno, "cannot write to the standard output");
    }
    written += static_cast<size_t>(count);
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status WriteWholeFile(const std::string& path,
                            const std::string& content) {
  if (path == kStandardOutput) return WriteToStandardOutput(content);
  absl::StatusOr<PendingFile> file = PendingFile::Create(path);
  if (!file.ok()) return file.status();
  const absl::Status status = file->Write(content);
  return status.ok() ? file->Commit() : status;
}

}  // namespace cartographer_sdf
