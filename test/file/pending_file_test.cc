// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/file/pending_file.h"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <set>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::pending_file_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class PendingFileTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::set<std::string> Files() const {
    std::set<std::string> names;
    for (const auto& entry :
         std::filesystem::directory_iterator(directory_.path())) {
      names.insert(entry.path().filename().string());
    }
    return names;
  }

  // A process writes to the target and is ended by a signal.
  void WriteAndEndBy(const int signal) const {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      RemovePendingFilesOnSignals();
      absl::StatusOr<PendingFile> file = PendingFile::Create(target_);
      if (!file.ok() || !file->Write("half").ok()) _exit(1);
      std::raise(signal);
      _exit(2);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), signal);
  }

  const testing::TemporaryDirectory directory_;
  const std::string target_ = directory_.File("target");
};

TEST_F(PendingFileTest, SignalsLeaveNothing) {
  directory_.Write("target", "old");
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
    WriteAndEndBy(signal);
    EXPECT_THAT(Files(), ElementsAre("target"));
    EXPECT_EQ(directory_.Read("target"), "old");
  }
}

TEST_F(PendingFileTest, WhatDeadProcessesLeftIsRemoved) {
  directory_.Write("target", "old");
  for (int k = 0; k < 3; ++k) {
    WriteAndEndBy(SIGKILL);
    // Those before are gone.
    EXPECT_EQ(Files().size(), 2u);
    EXPECT_EQ(directory_.Read("target"), "old");
  }
  // What only looks alike stays.
  directory_.Write("target.tmp-", "");
  directory_.Write("target.tmp-1-x", "");
  directory_.Write("other.tmp-1-1", "");
  absl::StatusOr<PendingFile> file = PendingFile::Create(target_);
  ASSERT_TRUE(file.ok()) << file.status();
  ASSERT_TRUE(file->Write("new").ok());
  ASSERT_TRUE(file->Commit().ok());
  EXPECT_EQ(directory_.Read("target"), "new");
  EXPECT_THAT(Files(), ElementsAre("other.tmp-1-1", "target", "target.tmp-",
                                   "target.tmp-1-x"));
}

TEST_F(PendingFileTest, AnotherWriterIsLeftAlone) {
  absl::StatusOr<PendingFile> first = PendingFile::Create(target_);
  absl::StatusOr<PendingFile> second = PendingFile::Create(target_);
  ASSERT_TRUE(first.ok() && second.ok());
  ASSERT_TRUE(first->Write("first").ok());
  ASSERT_TRUE(second->Write("second").ok());
  ASSERT_TRUE(second->Commit().ok());
  EXPECT_EQ(directory_.Read("target"), "second");
  ASSERT_TRUE(first->Commit().ok());
  EXPECT_EQ(directory_.Read("target"), "first");
  EXPECT_THAT(Files(), ElementsAre("target"));
}

TEST_F(PendingFileTest, NamesMayBeAsLongAsTheyCan) {
  const std::string name(255, 'n');
  absl::StatusOr<PendingFile> file = PendingFile::Create(directory_.File(name));
  ASSERT_TRUE(file.ok()) << file.status();
  ASSERT_TRUE(file->Commit().ok());
  EXPECT_THAT(Files(), ElementsAre(name));
}

TEST_F(PendingFileTest, SaysWhatIsMissing) {
  EXPECT_EQ(
      std::string(
          PendingFile::Create(directory_.File("no/a")).status().message()),
      "cannot write " + directory_.File("no/a") + ": there is no directory " +
          directory_.File("no"));
  EXPECT_THAT(std::string(PendingFile::Create("/dev/null").status().message()),
              HasSubstr("not a regular file"));
  EXPECT_THAT(Files(), IsEmpty());
}

TEST_F(PendingFileTest, KeepsAFileUnderASecondName) {
  directory_.Write("target", "old");
  const std::string second = directory_.File("second");
  std::filesystem::create_symlink(target_, directory_.File("link"));
  ASSERT_TRUE(KeepAs(directory_.File("link"), second).ok());
  EXPECT_FALSE(std::filesystem::is_symlink(second));
  // As after a process that was killed at this moment.
  ASSERT_TRUE(KeepAs(target_, second).ok());
  absl::StatusOr<PendingFile> file = PendingFile::Create(target_);
  ASSERT_TRUE(file.ok() && file->Write("new").ok() && file->Commit().ok());
  EXPECT_EQ(directory_.Read("target"), "new");
  EXPECT_EQ(directory_.Read("second"), "old");
  EXPECT_THAT(std::string(KeepAs(target_, second).message()),
              HasSubstr("second: it exists"));
  EXPECT_EQ(directory_.Read("second"), "old");
}

}  // namespace
}  // namespace cartographer_sdf::pending_file_test
