// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/file/whole_file.h"

#include <filesystem>
#include <iterator>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::whole_file_test {
namespace {

using ::testing::HasSubstr;

class WholeFileTest : public ::testing::Test {
 protected:
  [[nodiscard]] long NumFiles() const {
    return std::distance(std::filesystem::directory_iterator(directory_.path()),
                         {});
  }

  testing::TemporaryDirectory directory_;
};

TEST_F(WholeFileTest, ReplacesAndLeavesNothingElse) {
  ASSERT_TRUE(WriteWholeFile(directory_.File("a"), "first").ok());
  ASSERT_TRUE(WriteWholeFile(directory_.File("a"), "second\n").ok());
  EXPECT_EQ(directory_.Read("a"), "second\n");
  EXPECT_EQ(NumFiles(), 1);
}

TEST_F(WholeFileTest, AFailingWriteLeavesTheOldFileAndNothingElse) {
  const std::string path = directory_.File("taken");
  std::filesystem::create_directory(path);
  const absl::Status status = WriteWholeFile(path, "content");
  EXPECT_THAT(std::string(status.message()), HasSubstr("taken"));
  EXPECT_TRUE(std::filesystem::is_directory(path));
  EXPECT_EQ(NumFiles(), 1);
  EXPECT_FALSE(
      WriteWholeFile(directory_.File("missing/table.csv"), "content").ok());
}

}  // namespace
}  // namespace cartographer_sdf::whole_file_test
