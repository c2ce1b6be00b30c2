// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_TOOLS_VERSION_H_
#define CARTOGRAPHER_SDF_TOOLS_VERSION_H_

#include <string>

namespace cartographer_sdf {

// E.g. "0.1.0".
[[nodiscard]] std::string ProgramVersion();

// The commit of the sources as `git describe` named it when the build was
// configured, "-dirty" if files differed from it; "unknown" where there was
// neither a repository nor an archive made by git.
[[nodiscard]] std::string ProgramCommit();

// E.g. "cartographer_sdf 0.1.0 (commit 3c00ae1)".
[[nodiscard]] std::string VersionLine(const std::string& program);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_VERSION_H_
