// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/file/sha256.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace cartographer_sdf {
namespace {

constexpr size_t kBlockSize = 64;
constexpr size_t kPieceSize = size_t{1} << 20;

// The fractional parts of the cube roots of the first 64 primes.
constexpr std::array<uint32_t, 64> kRoundConstants = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1,
    0x923f82a4, 0xab1c5ed5, 0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3,
    0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174, 0xe49b69c1, 0xefbe4786,
    0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147,
    0x06ca6351, 0x14292967, 0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13,
    0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85, 0xa2bfe8a1, 0xa81a664b,
    0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a,
    0x5b9cca4f, 0x682e6ff3, 0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208,
    0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

uint32_t RotateRight(const uint32_t word, const int bits) {
  return (word >> bits) | (word << (32 - bits));
}

class Sha256Digest {
 public:
  void Add(absl::string_view bytes) {
    num_bytes_ += bytes.size();
    while (!bytes.empty()) {
      const size_t taken = std::min(kBlockSize - filled_, bytes.size());
      std::memcpy(&block_[filled_], bytes.data(), taken);
      bytes.remove_prefix(taken);
      filled_ += taken;
      if (filled_ == kBlockSize) AddBlock();
    }
  }

  std::string Finish() {
    const uint64_t num_bits = 8 * num_bytes_;
    std::string padding(1, '\x80');
    const size_t length = filled_ + 1 + sizeof(num_bits);
    padding.append((kBlockSize - length % kBlockSize) % kBlockSize, '\0');
    for (int shift = 56; shift >= 0; shift -= 8) {
      padding += static_cast<char>(num_bits >> shift & 0xff);
    }
    Add(padding);
    std::string digits;
    for (const uint32_t word : state_) {
      absl::StrAppendFormat(&digits, "%08x", word);
    }
    return digits;
  }

 private:
  std::array<uint32_t, 64> Schedule() const {
    std::array<uint32_t, 64> words{};
    for (size_t k = 0; k < 16; ++k) {
      for (size_t byte = 0; byte < 4; ++byte) {
        words[k] = words[k] << 8 | block_[4 * k + byte];
      }
    }
    for (size_t k = 16; k < 64; ++k) {
      const uint32_t a = words[k - 15], b = words[k - 2];
      words[k] = words[k - 16] + words[k - 7] +
                 (RotateRight(a, 7) ^ RotateRight(a, 18) ^ a >> 3) +
                 (RotateRight(b, 17) ^ RotateRight(b, 19) ^ b >> 10);
    }
    return words;
  }

  void AddBlock() {
    const std::array<uint32_t, 64> words = Schedule();
    auto [a, b, c, d, e, f, g, h] = state_;
    for (size_t k = 0; k < 64; ++k) {
      const uint32_t first =
          h + (RotateRight(e, 6) ^ RotateRight(e, 11) ^ RotateRight(e, 25)) +
          ((e & f) ^ (~e & g)) + kRoundConstants[k] + words[k];
      const uint32_t second =
          (RotateRight(a, 2) ^ RotateRight(a, 13) ^ RotateRight(a, 22)) +
          ((a & b) ^ (a & c) ^ (b & c));
      h = g;
      g = f;
      f = e;
      e = d + first;
      d = c;
      c = b;
      b = a;
      a = first + second;
    }
    const std::array<uint32_t, 8> mixed = {a, b, c, d, e, f, g, h};
    for (size_t k = 0; k < state_.size(); ++k) state_[k] += mixed[k];
    filled_ = 0;
  }

  // The fractional parts of the square roots of the first eight primes.
  std::array<uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372,
                                    0xa54ff53a, 0x510e527f, 0x9b05688c,
                                    0x1f83d9ab, 0x5be0cd19};
  std::array<uint8_t, kBlockSize> block_{};
  size_t filled_ = 0;
  uint64_t num_bytes_ = 0;
};

}  // namespace

std::string Sha256(const absl::string_view bytes) {
  Sha256Digest digest;
  digest.Add(bytes);
  return digest.Finish();
}

absl::StatusOr<std::string> Sha256OfFile(const std::string& path) {
  const std::string problem = absl::StrCat("cannot read ", path);
  std::ifstream file(path, std::ios::binary);
  if (!file) return absl::ErrnoToStatus(errno, problem);
  Sha256Digest digest;
  std::vector<char> piece(kPieceSize);
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())) ||
         file.gcount() > 0) {
    digest.Add({piece.data(), static_cast<size_t>(file.gcount())});
  }
  return file.eof() ? absl::StatusOr<std::string>(digest.Finish())
                    : absl::UnavailableError(problem);
}

}  // namespace cartographer_sdf
