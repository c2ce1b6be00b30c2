// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <cstdlib>
#include <vector>

#include "cartographer_sdf/tools/subcommand.h"
#include "gtest/gtest.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace cartographer_sdf::allocator_test {
namespace {

// Arrays as of a submap with 1000 x 1000 cells.
constexpr size_t kNumFloats = 1'000'000;

TEST(KeepFreedMemoryTest, HasItForTheNextSubmap) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || \
    !defined(__GLIBC__)
  GTEST_SKIP() << "the allocator is another one";
#else
  KeepFreedMemory();
  const struct mallinfo2 before = mallinfo2();
  std::vector<std::vector<float> > arrays;
  for (int k = 0; k < 5; ++k) arrays.emplace_back(kNumFloats, 1.f);
  const struct mallinfo2 during = mallinfo2();
  EXPECT_EQ(during.hblkhd, before.hblkhd) << "mapped one by one";
  arrays.clear();
  const struct mallinfo2 after = mallinfo2();
  EXPECT_GE(after.fordblks, 5 * kNumFloats * sizeof(float));
#endif
}

}  // namespace
}  // namespace cartographer_sdf::allocator_test
