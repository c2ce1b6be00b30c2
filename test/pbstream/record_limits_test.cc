// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/record_limits.h"

#include <string>
#include <vector>

#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/serialized_state.pb.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/small_map.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::record_limits_test {
namespace {

using ::cartographer_sdf::testing::SmallMap;
using ::testing::HasSubstr;

bool HasMoreThan(const int64_t limit, const std::string& record) {
  return HasTooManyFields(*proto::SerializedData::descriptor(), record, limit);
}

TEST(RecordLimitsTest, CountsFieldsOfMessagesInMessages) {
  proto::SerializedData data;
  // 1 graph, 1 constraint, 1 id with 2 numbers, 1 weight.
  proto::Constraint& constraint = *data.mutable_pose_graph()->add_constraint();
  constraint.mutable_submap_id()->set_trajectory_id(3);
  constraint.mutable_submap_id()->set_index(4);
  constraint.set_translation_weight(2.);
  const std::string record = data.SerializeAsString();
  EXPECT_FALSE(HasMoreThan(6, record));
  EXPECT_TRUE(HasMoreThan(5, record));
  // One that is unknown, of each kind.
  EXPECT_FALSE(HasMoreThan(7, record + "\xc2\x3e\x03xyz"));
  EXPECT_TRUE(HasMoreThan(6, record + "\xc2\x3e\x03xyz"));
  EXPECT_TRUE(HasMoreThan(6, record + "\x78\x01"));
  // Packed numbers are one field.
  data.mutable_submap()
      ->mutable_submap_2d()
      ->mutable_grid()
      ->mutable_cells()
      ->Resize(1000, 7);
  EXPECT_FALSE(HasMoreThan(4, data.SerializeAsString()));
}

TEST(RecordLimitsTest, MalformedBytesAreNoMore) {
  for (const std::string& bytes : std::vector<std::string>{
           "\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff",
           "\x0a\x7f\x12\x12", "\x0a", "\x09\x01\x02",
           "\x0b\x0b\x0b\x0b\x0c"}) {
    EXPECT_FALSE(HasMoreThan(5, bytes));
  }
}

// Two bytes each in the file, some hundred in memory.
TEST(RecordLimitsTest, AMillionfoldConstraintIsRefused) {
  SmallMap map;
  std::vector<std::string> records = map.Records();
  // Field 2 of length 0.
  std::string constraints(2 * (kMaxNumFields + 1), '\0');
  for (size_t k = 0; k < constraints.size(); k += 2) constraints[k] = '\x12';
  std::string graph = "\x0a";
  for (size_t size = constraints.size(); size > 0; size >>= 7) {
    graph += static_cast<char>((size & 0x7f) | (size > 0x7f ? 0x80 : 0));
  }
  records[1] = graph + constraints;
  const testing::TemporaryDirectory directory;
  const std::string path =
      directory.Write("bomb.pbstream", testing::Container(records));
  EXPECT_THAT(std::string(ReadMap(path).status().message()),
              HasSubstr("record 2 has too many fields"));
}

TEST(RecordLimitsTest, OnlyAPoseGraphMayBeLarge) {
  std::vector<std::string> records = SmallMap().Records();
  records[3].resize(size_t{1} << 28);
  const testing::TemporaryDirectory directory;
  const std::string path =
      directory.Write("bomb.pbstream", testing::Container(records));
  EXPECT_THAT(std::string(ReadMap(path).status().message()),
              HasSubstr("record 4 is larger than 256 MiB"));
}

}  // namespace
}  // namespace cartographer_sdf::record_limits_test
