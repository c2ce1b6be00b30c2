// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Files that appear complete or not at all, whatever happens to the process
// while it writes them.

#ifndef CARTOGRAPHER_SDF_FILE_PENDING_FILE_H_
#define CARTOGRAPHER_SDF_FILE_PENDING_FILE_H_

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace cartographer_sdf {

// The file that a path leads to, through links whose end need not exist.
[[nodiscard]] std::string FollowLinks(const std::string& path);

// A file that is written beside its target, as TARGET.tmp-PID-N, and replaces
// it when it is committed. Without a commit, the destructor leaves nothing
// behind. What a process left that was killed is removed when the same target
// is written again: the lock on it died with the process.
//
// Errors have the message "cannot write PATH: REASON".
class PendingFile {
 public:
  // Fails if the target cannot be replaced: a directory, a device, a
  // write-protected file, a folder that is missing or cannot be written to.
  // Follows symbolic links; keeps permissions, and the owner where it may.
  [[nodiscard]] static absl::StatusOr<PendingFile> Create(
      const std::string& path);
  PendingFile(PendingFile&& other) noexcept;
  PendingFile& operator=(PendingFile&&) = delete;
  ~PendingFile();

  // After an error or Commit(), the file must not be used any more.
  [[nodiscard]] absl::Status Write(absl::string_view bytes);
  // Waits until the disk has the file, and renames it.
  [[nodiscard]] absl::Status Commit();

  [[nodiscard]] const std::string& path() const { return path_; }
  // What has been written, until it is committed.
  [[nodiscard]] const std::string& temporary_path() const {
    return temporary_path_;
  }

 private:
  PendingFile() = default;

  [[nodiscard]] absl::Status Open();
  [[nodiscard]] bool TryToOpen(int number);
  [[nodiscard]] absl::Status Failure(int error) const;

  // The path as given, for messages, and the path with links resolved.
  std::string path_;
  std::string target_path_;
  std::string temporary_path_;
  int file_descriptor_ = -1;
  int slot_ = -1;
};

// Has all pending files of the process removed before SIGINT, SIGTERM or SIGHUP
// ends it. Call it at the beginning of a program, if at all.
void RemovePendingFilesOnSignals();

// Gives a file a second name, by a hard link or, where the file system has
// none, as a copy that the disk has when it returns. The first name may then be
// replaced. Fails if there is another file of the second name.
[[nodiscard]] absl::Status KeepAs(const std::string& path,
                                  const std::string& second_path);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_FILE_PENDING_FILE_H_
