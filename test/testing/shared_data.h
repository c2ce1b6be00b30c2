// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Real maps and logs lie beside the checkout, never in it. Tests that need them
// skip with a clear message where they are absent.

#ifndef TEST_TESTING_SHARED_DATA_H_
#define TEST_TESTING_SHARED_DATA_H_

#include <filesystem>
#include <string>

#include "test/testing/paths.h"

inline std::string SharedDataPath(const std::string& name) {
  return std::string(kTestSharedDataDirectory) + "/" + name;
}

#define SKIP_WITHOUT_SHARED_DATA(name)                     \
  if (!std::filesystem::exists(SharedDataPath(name))) {    \
    GTEST_SKIP() << "needs the real map " << (name)        \
                 << ", which is not part of the project: " \
                 << SharedDataPath(name);                  \
  }

#endif  // TEST_TESTING_SHARED_DATA_H_
