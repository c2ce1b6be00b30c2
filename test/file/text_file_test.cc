// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/file/text_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "cartographer_sdf/file/whole_file.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::text_file_test {
namespace {

using ::cartographer_sdf::testing::TemporaryDirectory;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::vector<CsvColumn>& Columns() {
  static const auto* const kColumns =
      new std::vector<CsvColumn>{{"name", CsvType::kWord},
                                 {"count", CsvType::kInteger},
                                 {"size", CsvType::kNumber}};
  return *kColumns;
}

class TextFileTest : public ::testing::Test {
 protected:
  std::string Write(const std::string& content) {
    const std::string path = directory_.File("table.csv");
    EXPECT_TRUE(WriteWholeFile(path, content).ok());
    return path;
  }
  absl::StatusOr<std::vector<CsvRow>> Read(const std::string& content) {
    return ReadCsv(Write(content), Columns());
  }

  testing::TemporaryDirectory directory_;
};

TEST_F(TextFileTest, FindsColumnsByName) {
  const auto rows =
      Read("size, other,count,name\r\n0.5,x,-3, a b \r\n\n1e3,,7,\r\n");
  ASSERT_TRUE(rows.ok()) << rows.status();
  ASSERT_EQ(rows->size(), 2u);
  EXPECT_EQ((*rows)[0].line, 2);
  EXPECT_EQ((*rows)[0].Word(0), "a b");
  EXPECT_EQ((*rows)[0].Integer(1), -3);
  EXPECT_EQ((*rows)[0].Number(2), 0.5);
  EXPECT_EQ((*rows)[1].line, 4);
  EXPECT_EQ((*rows)[1].Word(0), "");
  EXPECT_EQ((*rows)[1].Number(2), 1000.);
}

TEST_F(TextFileTest, AHeaderAloneIsAnEmptyTable) {
  const auto rows = Read("name,count,size");
  ASSERT_TRUE(rows.ok()) << rows.status();
  EXPECT_TRUE(rows->empty());
}

TEST_F(TextFileTest, ErrorsNameTheFileAndTheLine) {
  for (const auto& [content, problem] :
       std::vector<std::pair<std::string, std::string>>{
           {"", "is empty"},
           {"\n \n", "is empty"},
           {"name,count\n", "0 columns named \"size\""},
           {"name,count,size,size\n", "2 columns named \"size\""},
           {"name,count,size\na,1\n", ":2: 2 fields instead of 3"},
           {"name,count,size\na,1,2,3\n", ":2: 4 fields instead of 3"},
           {"name,count,size\n\na,1.5,2\n",
            ":3: \"1.5\" is not an integer number"},
           {"name,count,size\na,9999999999,2\n",
            "\"9999999999\" is not an integer number"},
           {"name,count,size\na,1,\n", ":2: \"\" is not a finite number"},
           {"name,count,size\na,1,nan\n", "\"nan\" is not a finite number"},
           {"name,count,size\na,1,1e999\n", "\"1e999\" is not a finite"},
           {std::string("name,count,size\na,1,2\0", 22),
            "\"2\\x00\" is not a finite number"},
           {"name,count,size\na,1," + std::string(1000, '7') + "x\n",
            "7777...\" is not a finite number"}}) {
    const auto rows = Read(content);
    ASSERT_FALSE(rows.ok()) << content;
    EXPECT_THAT(std::string(rows.status().message()),
                AllOf(HasSubstr("table.csv"), HasSubstr(problem)));
  }
}

TEST_F(TextFileTest, RefusesWhatIsNoFile) {
  EXPECT_THAT(
      std::string(ReadCsv(directory_.File("none"), {}).status().message()),
      AllOf(HasSubstr("none"), HasSubstr("no such file")));
  EXPECT_THAT(std::string(ReadCsv(directory_.path(), {}).status().message()),
              HasSubstr("not a regular file"));
}

TEST_F(TextFileTest, AnyBytesGiveATableOrAnError) {
  std::mt19937 engine(42);
  const std::string alphabet =
      std::string("name,count,size\n0123.-e") + std::string("\0\r\xff\"#", 5);
  for (int k = 0; k != 2000; ++k) {
    std::string content = k % 2 == 0 ? "name,count,size\n" : "";
    for (size_t length = engine() % 60; length != 0; --length) {
      content += alphabet[engine() % alphabet.size()];
    }
    const auto rows = Read(content);
    EXPECT_TRUE(rows.ok() || !rows.status().message().empty());
  }
}

}  // namespace
}  // namespace cartographer_sdf::text_file_test
