// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/file/pending_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr char kTemporaryInfix[] = ".tmp-";
// Names may have 255 bytes, the temporary one included.
constexpr size_t kMaxNameLength = 200;

// The temporary paths of this process, for a signal handler, which must neither
// lock nor allocate. Files beyond the last slot are only not removed by it.
struct PathSlot {
  enum State { kFree, kChanging, kUsed };
  std::atomic<int> state{kFree};
  std::array<char, 4096> path{};
};
std::array<PathSlot, 32> path_slots;

int TakeSlot(const std::string& path) {
  for (size_t k = 0; k < path_slots.size(); ++k) {
    PathSlot& slot = path_slots[k];
    int expected = PathSlot::kFree;
    if (path.size() >= slot.path.size() ||
        !slot.state.compare_exchange_strong(expected, PathSlot::kChanging)) {
      continue;
    }
    std::memcpy(slot.path.data(), path.c_str(), path.size() + 1);
    slot.state = PathSlot::kUsed;
    return static_cast<int>(k);
  }
  return -1;
}

void FreeSlot(const int slot) {
  if (slot >= 0) path_slots[static_cast<size_t>(slot)].state = PathSlot::kFree;
}

void RemovePendingFilesAndDie(const int signal) {
  for (PathSlot& slot : path_slots) {
    if (slot.state == PathSlot::kUsed) unlink(slot.path.data());
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

std::string DirectoryOf(const std::string& path) {
  const std::string directory =
      std::filesystem::path(path).parent_path().string();
  return directory.empty() ? "." : directory;
}

// What the temporary files of a target begin with, without the directory.
std::string TemporaryPrefix(const std::string& target) {
  const std::string name = std::filesystem::path(target).filename().string();
  return absl::StrCat(name.substr(0, kMaxNameLength), kTemporaryInfix);
}

bool IsTemporaryName(const std::string& name, const std::string& prefix) {
  if (!absl::StartsWith(name, prefix)) return false;
  const std::vector<std::string> numbers =
      absl::StrSplit(name.substr(prefix.size()), '-');
  int64_t ignored = 0;
  return numbers.size() == 2 && absl::SimpleAtoi(numbers[0], &ignored) &&
         absl::SimpleAtoi(numbers[1], &ignored);
}

// Removes the temporary files of a target that no process holds the lock of.
void RemoveLeftovers(const std::string& target) {
  const std::string prefix = TemporaryPrefix(target);
  std::error_code error;
  std::vector<std::string> leftovers;
  for (std::filesystem::directory_iterator it(DirectoryOf(target), error), end;
       !error && it != end; it.increment(error)) {
    if (IsTemporaryName(it->path().filename().string(), prefix)) {
      leftovers.push_back(it->path().string());
    }
  }
  for (const std::string& path : leftovers) {
    const int file = open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW);
    if (file < 0) continue;
    if (flock(file, LOCK_EX | LOCK_NB) == 0) unlink(path.c_str());
    close(file);
  }
}

// Whether the open file still has a name.
bool HasName(const int file) {
  struct stat info = {};
  return fstat(file, &info) == 0 && info.st_nlink > 0;
}

void SyncDirectory(const std::string& path) {
  const int directory =
      open(DirectoryOf(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory < 0) return;
  fsync(directory);
  close(directory);
}

// Not all file systems can.
bool Sync(const int file) { return fsync(file) == 0 || errno == EINVAL; }

absl::Status CopyTo(const std::string& path, const std::string& second_path) {
  absl::StatusOr<PendingFile> copy = PendingFile::Create(second_path);
  if (!copy.ok()) return copy.status();
  std::ifstream file(path, std::ios::binary);
  std::vector<char> buffer(1 << 16);
  while (file.good()) {
    file.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    const absl::Status status = copy->Write(
        {buffer.data(), static_cast<size_t>(std::max<long>(file.gcount(), 0))});
    if (!status.ok()) return status;
  }
  if (!file.eof()) {
    return absl::UnavailableError(absl::StrCat("cannot read ", path));
  }
  return copy->Commit();
}

}  // namespace

std::string FollowLinks(const std::string& path) {
  // As many as the system follows.
  constexpr int kMaxLinks = 40;
  std::filesystem::path target(path);
  for (int k = 0; k < kMaxLinks; ++k) {
    std::error_code error;
    const std::filesystem::path next =
        std::filesystem::read_symlink(target, error);
    if (error) break;
    // An absolute one replaces the directory.
    target = target.parent_path() / next;
  }
  return target.string();
}

absl::StatusOr<PendingFile> PendingFile::Create(const std::string& path) {
  PendingFile file;
  file.path_ = path;
  file.target_path_ = FollowLinks(path);
  const absl::Status status = file.Open();
  if (!status.ok()) return status;
  return file;
}

PendingFile::PendingFile(PendingFile&& other) noexcept
    : path_(std::move(other.path_)),
      target_path_(std::move(other.target_path_)),
      temporary_path_(std::move(other.temporary_path_)),
      file_descriptor_(std::exchange(other.file_descriptor_, -1)),
      slot_(std::exchange(other.slot_, -1)) {}

PendingFile::~PendingFile() {
  if (file_descriptor_ >= 0) {
    unlink(temporary_path_.c_str());
    close(file_descriptor_);
  }
  FreeSlot(slot_);
}

absl::Status PendingFile::Failure(const int error) const {
  const std::string directory = DirectoryOf(target_path_);
  std::error_code ignored;
  if (error == ENOENT && !std::filesystem::exists(directory, ignored)) {
    return absl::NotFoundError(absl::StrCat(
        "cannot write ", path_, ": there is no directory ", directory));
  }
  return absl::ErrnoToStatus(error, absl::StrCat("cannot write ", path_));
}

// Leaves a reason in errno if it fails.
bool PendingFile::TryToOpen(const int number) {
  temporary_path_ =
      (std::filesystem::path(DirectoryOf(target_path_)) /
       absl::StrCat(TemporaryPrefix(target_path_), getpid(), "-", number))
          .string();
  // Before it exists: a signal may come at any moment.
  slot_ = TakeSlot(temporary_path_);
  file_descriptor_ = open(temporary_path_.c_str(),
                          O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file_descriptor_ < 0) {
    FreeSlot(std::exchange(slot_, -1));
    return false;
  }
  // Another process that found it before the lock was taken removes it. Where
  // there are no locks, nobody removes anything.
  if (flock(file_descriptor_, LOCK_EX) != 0 || HasName(file_descriptor_)) {
    return true;
  }
  close(std::exchange(file_descriptor_, -1));
  FreeSlot(std::exchange(slot_, -1));
  errno = EEXIST;
  return false;
}

absl::Status PendingFile::Open() {
  struct stat existing = {};
  const bool exists = stat(target_path_.c_str(), &existing) == 0;
  if (exists && !S_ISREG(existing.st_mode)) {
    return absl::InvalidArgumentError(
        absl::StrCat("cannot write ", path_, ": not a regular file"));
  }
  if (exists && access(target_path_.c_str(), W_OK) != 0) return Failure(errno);
  RemoveLeftovers(target_path_);
  constexpr int kMaxAttempts = 1000;
  for (int i = 0; i < kMaxAttempts; ++i) {
    if (TryToOpen(i) || errno != EEXIST) break;
  }
  if (file_descriptor_ < 0) return Failure(errno);
  if (!exists) return absl::OkStatus();
  if (existing.st_uid != geteuid() || existing.st_gid != getegid()) {
    // Only root may.
    [[maybe_unused]] const int ignored =
        fchown(file_descriptor_, existing.st_uid, existing.st_gid);
  }
  return fchmod(file_descriptor_, existing.st_mode & 07777) == 0
             ? absl::OkStatus()
             : Failure(errno);
}

absl::Status PendingFile::Write(const absl::string_view bytes) {
  CHECK_GE(file_descriptor_, 0) << "written after Commit()";
  size_t written = 0;
  while (written < bytes.size()) {
    const ssize_t count =
        write(file_descriptor_, bytes.data() + written, bytes.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return Failure(errno);
    written += static_cast<size_t>(count);
  }
  return absl::OkStatus();
}

absl::Status PendingFile::Commit() {
  CHECK_GE(file_descriptor_, 0) << "committed twice";
  // Without the first, a crash of the machine could leave an empty file under
  // the new name. The lock is held until the file has that name.
  if (!Sync(file_descriptor_) ||
      rename(temporary_path_.c_str(), target_path_.c_str()) != 0) {
    return Failure(errno);
  }
  close(std::exchange(file_descriptor_, -1));
  FreeSlot(std::exchange(slot_, -1));
  SyncDirectory(target_path_);
  return absl::OkStatus();
}

void RemovePendingFilesOnSignals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    // Of nohup and the like.
    if (std::signal(signal, &RemovePendingFilesAndDie) == SIG_IGN) {
      std::signal(signal, SIG_IGN);
    }
  }
}

absl::Status KeepAs(const std::string& path, const std::string& second_path) {
  // Of the file, not of a link to it.
  if (linkat(AT_FDCWD, path.c_str(), AT_FDCWD, second_path.c_str(),
             AT_SYMLINK_FOLLOW) == 0) {
    SyncDirectory(second_path);
    return absl::OkStatus();
  }
  if (errno == EEXIST) {
    std::error_code error;
    // As a process left it that was killed before the first was replaced.
    if (std::filesystem::equivalent(path, second_path, error)) {
      return absl::OkStatus();
    }
    return absl::AlreadyExistsError(
        absl::StrCat("cannot write ", second_path, ": it exists"));
  }
  return CopyTo(path, second_path);
}

}  // namespace cartographer_sdf
