// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// PROGRAM --write_seeds DIR leaves the seeds there, a corpus to begin with.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "test/fuzz/fuzz_target.h"

int LLVMFuzzerInitialize(int* const argc, char*** const argv) {
  if (*argc != 3 || std::string((*argv)[1]) != "--write_seeds") return 0;
  const std::string directory = (*argv)[2];
  std::filesystem::create_directories(directory);
  int number = 0;
  for (const std::string& seed : cartographer_sdf::fuzz::Seeds()) {
    std::ofstream(directory + "/seed_" + std::to_string(number++),
                  std::ios::binary)
        << seed;
  }
  std::exit(EXIT_SUCCESS);
}
