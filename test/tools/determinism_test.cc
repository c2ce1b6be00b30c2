// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The same input gives the same bytes: with any number of threads, and in any
// order of submaps in the file.

#include <algorithm>
#include <string>
#include <vector>

#include "cartographer_sdf/report/json.h"
#include "cartographer_sdf/serialized_state.pb.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/program.h"
#include "test/testing/small_map.h"
#include "test/testing/two_offices.h"

namespace cartographer_sdf::determinism_test {
namespace {

class DeterminismTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { offices_ = new testing::TwoOffices; }
  static void TearDownTestSuite() { delete offices_; }
  static std::string File(const std::string& name) {
    return offices_->File(name);
  }

  // Runs a subcommand with each number of threads and compares the files that
  // it writes, by flags and endings. Of results, what is measured and the
  // arguments themselves are left out.
  static void ExpectSame(const std::vector<std::string>& arguments,
                         const std::vector<std::string>& flags) {
    std::vector<std::string> expected;
    for (const std::string threads : {"1", "2", "8"}) {
      std::vector<std::string> all = arguments;
      all.insert(all.end(), {"--threads", threads});
      for (const std::string& flag : flags) {
        all.insert(all.end(), {"--" + flag, File("determinism_" + flag)});
      }
      const ProgramResult result = RunTestProgram(all);
      ASSERT_EQ(result.exit_code, 0) << result.error;
      std::vector<std::string> contents;
      for (const std::string& flag : flags) {
        contents.push_back(Content(flag));
        std::filesystem::remove(File("determinism_" + flag));
      }
      if (expected.empty()) expected = contents;
      for (size_t k = 0; k < flags.size(); ++k) {
        EXPECT_TRUE(contents[k] == expected[k])
            << "--" << flags[k] << " differs with " << threads << " threads";
      }
    }
  }

  static std::string Content(const std::string& flag) {
    const std::string content = offices_->Read("determinism_" + flag);
    EXPECT_NE(content, "");
    if (flag != "result") return content;
    Json json = Json::parse(content);
    for (const char* const member :
         {"milliseconds", "seconds", "started", "peak_memory_bytes"}) {
      json.erase(member);
    }
    json["command"].erase("arguments");
    return json.dump();
  }

  static testing::TwoOffices* offices_;
};
testing::TwoOffices* DeterminismTest::offices_;

TEST_F(DeterminismTest, AnyNumberOfThreads) {
  const std::string morning = offices_->Morning();
  const std::string evening = offices_->Evening();
  ExpectSame({"close_loops", "--input", morning},
             {"output", "closures", "places", "result"});
  ExpectSame({"match", "--input", morning, "--query", evening},
             {"output", "terms", "places", "result"});
  ExpectSame({"audit", "--input", morning},
             {"output", "constraints", "result"});
  ExpectSame({"relocalize", "--map", morning, "--query", evening},
             {"output", "result"});
  ExpectSame({"merge", "--inputs", morning + "," + evening},
             {"output", "result"});
}

TEST_F(DeterminismTest, AnyOrderOfSubmapsInTheFile) {
  std::vector<std::string> records = testing::ReadRecords(offices_->Morning());
  const auto is_submap = [](const std::string& record) {
    proto::SerializedData data;
    return data.ParseFromString(record) && data.has_submap();
  };
  const auto begin = std::find_if(records.begin(), records.end(), is_submap);
  const auto end = std::find_if_not(begin, records.end(), is_submap);
  ASSERT_GT(end - begin, 5);
  std::reverse(begin, end);
  testing::WriteFile(File("reversed.pbstream"), testing::Container(records));
  std::vector<std::string> closures;
  std::vector<std::string> graphs;
  for (const std::string& input :
       {offices_->Morning(), File("reversed.pbstream")}) {
    const ProgramResult result = RunTestProgram(
        {"close_loops", "--input", input, "--output", File("closed.pbstream"),
         "--closures", File("closures.csv")});
    ASSERT_EQ(result.exit_code, 0) << result.error;
    closures.push_back(offices_->Read("closures.csv"));
    graphs.push_back(testing::ReadRecords(File("closed.pbstream"))[1]);
  }
  EXPECT_GT(std::count(closures[0].begin(), closures[0].end(), '\n'), 5);
  EXPECT_EQ(closures[0], closures[1]);
  EXPECT_TRUE(graphs[0] == graphs[1]);
}

}  // namespace
}  // namespace cartographer_sdf::determinism_test
