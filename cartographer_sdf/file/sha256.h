// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The checksum by which a result names the files that it was made of
// [FIPS180-4]. Not for secrets.

#ifndef CARTOGRAPHER_SDF_FILE_SHA256_H_
#define CARTOGRAPHER_SDF_FILE_SHA256_H_

#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace cartographer_sdf {

// 64 hexadecimal digits, in lower case.
[[nodiscard]] std::string Sha256(absl::string_view bytes);

// Of the content of a file, which is read in pieces. Errors name the path.
[[nodiscard]] absl::StatusOr<std::string> Sha256OfFile(const std::string& path);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_FILE_SHA256_H_
