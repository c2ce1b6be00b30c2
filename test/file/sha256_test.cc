// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/file/sha256.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::sha256_test {
namespace {

// Examples of the standard, and its corner cases: lengths around a block's.
TEST(Sha256Test, AgreesWithTheStandard) {
  EXPECT_EQ(Sha256(""),
            "e3b0c44298fc1c149afbf4c8996fb924"
            "27ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Sha256("abc"),
            "ba7816bf8f01cfea414140de5dae2223"
            "b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039"
            "a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(Sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67"
            "f1809a48a497200e046d39ccc7112cd0");
  // By sha256sum.
  EXPECT_EQ(Sha256(std::string(55, 'x')),
            "d5e285683cd4efc02d021a5c62014694"
            "958901005d6f71e89e0989fac77e4072");
  EXPECT_EQ(Sha256(std::string(64, 'x')),
            "7ce100971f64e7001e8fe5a51973ecdf"
            "e1ced42befe7ee8d5fd6219506b5393c");
}

TEST(Sha256Test, ReadsFiles) {
  const testing::TemporaryDirectory directory;
  const std::string content(3000000, '\xff');
  EXPECT_EQ(Sha256OfFile(directory.Write("a", content)).value(),
            Sha256(content));
  EXPECT_EQ(Sha256OfFile(directory.Write("b", "")).value(), Sha256(""));
  const auto none = Sha256OfFile(directory.File("none"));
  EXPECT_FALSE(none.ok());
  EXPECT_THAT(std::string(none.status().message()),
              ::testing::HasSubstr(directory.File("none")));
  EXPECT_FALSE(Sha256OfFile(directory.path()).ok());
}

}  // namespace
}  // namespace cartographer_sdf::sha256_test
