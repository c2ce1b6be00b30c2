// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What a fuzzer consists of: the function that libFuzzer calls with bytes, and
// inputs to begin with. With clang it is linked with libFuzzer, with other
// compilers with main.cc, which mutates the seeds by itself.

#ifndef TEST_FUZZ_FUZZ_TARGET_H_
#define TEST_FUZZ_FUZZ_TARGET_H_

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::fuzz {

// Valid inputs, small.
[[nodiscard]] std::vector<std::string> Seeds();

// In memory, where there is such a file system.
inline const testing::TemporaryDirectory& Directory() {
  static const testing::TemporaryDirectory* const directory = [] {
    if (std::filesystem::is_directory("/dev/shm")) {
      setenv("TMPDIR", "/dev/shm", /*overwrite=*/0);
    }
    return new testing::TemporaryDirectory;
  }();
  return *directory;
}

inline std::string WriteInput(const std::string& name,
                              const std::string& bytes) {
  return Directory().Write(name, bytes);
}

}  // namespace cartographer_sdf::fuzz

// libFuzzer and main.cc call it first; see seeds.cc.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv);

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

#endif  // TEST_FUZZ_FUZZ_TARGET_H_
