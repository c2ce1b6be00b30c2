// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Stands in for libFuzzer: runs a fuzzer on its seeds, on files, or on mutated
// seeds for some seconds. Prints the seed of the generator, so that a finding
// can be had again.

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "test/fuzz/fuzz_target.h"

namespace {

using Bytes = std::string;

void Run(const Bytes& bytes) {
  LLVMFuzzerTestOneInput(reinterpret_cast<const uint8_t*>(bytes.data()),
                         bytes.size());
}

// A flipped bit, another byte, bytes that are dropped, repeated, all ones, or
// taken from another seed.
void Mutate(const std::vector<Bytes>& seeds, std::mt19937* const engine,
            Bytes* const bytes) {
  const auto below = [engine](const size_t limit) {
    return limit == 0 ? 0 : (*engine)() % limit;
  };
  const size_t position = below(bytes->size() + 1);
  const size_t length = std::min(bytes->size() - position, 1 + below(8));
  const Bytes& other = seeds[below(seeds.size())];
  switch (below(6)) {
    case 0:
      if (position < bytes->size()) {
        (*bytes)[position] =
            static_cast<char>((*bytes)[position] ^ 1 << below(8));
      }
      break;
    case 1:
      bytes->insert(position, 1, static_cast<char>(below(256)));
      break;
    case 2:
      bytes->erase(position, length);
      break;
    case 3:
      bytes->insert(position, bytes->substr(position, 8 * length));
      break;
    case 4:
      bytes->replace(position, length, length, '\xff');
      break;
    default:
      bytes->insert(position,
                    other.substr(below(other.size() + 1), 1 + below(64)));
  }
}

int RunFor(const double seconds, const uint32_t seed) {
  const std::vector<Bytes> seeds = cartographer_sdf::fuzz::Seeds();
  std::mt19937 engine(seed);
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  long count = 0;
  for (; std::chrono::steady_clock::now() < end; ++count) {
    Bytes bytes = seeds[engine() % seeds.size()];
    const size_t num_changes = 1 + engine() % 8;
    for (size_t k = 0; k < num_changes; ++k) Mutate(seeds, &engine, &bytes);
    Run(bytes);
  }
  std::cout << count << " mutants, seed " << seed << "\n";
  return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
  LLVMFuzzerInitialize(&argc, &argv);
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  for (const Bytes& seed : cartographer_sdf::fuzz::Seeds()) Run(seed);
  if (arguments.size() >= 2 && arguments[0] == "--seconds") {
    return RunFor(std::stod(arguments[1]),
                  arguments.size() > 2
                      ? static_cast<uint32_t>(std::stoul(arguments[2]))
                      : 1);
  }
  for (const std::string& path : arguments) {
    std::ifstream file(path, std::ios::binary);
    Run(Bytes(std::istreambuf_iterator<char>(file), {}));
  }
  return EXIT_SUCCESS;
}
