// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/file/whole_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "absl/strings/str_cat.h"

namespace cartographer_sdf {

absl::Status WriteWholeFile(const std::string& path,
                            const std::string& content) {
  const std::string temporary = absl::StrCat(path, ".", getpid(), ".part");
  errno = 0;
  std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  if (!file.fail() && std::rename(temporary.c_str(), path.c_str()) == 0) {
    return absl::OkStatus();
  }
  const std::string reason = errno != 0 ? std::strerror(errno) : "write error";
  std::remove(temporary.c_str());
  return absl::UnavailableError(
      absl::StrCat("cannot write ", path, ": ", reason));
}

}  // namespace cartographer_sdf
