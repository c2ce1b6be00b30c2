// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/version.h"

#include "absl/strings/str_cat.h"

namespace cartographer_sdf {

std::string ProgramVersion() { return CARTOGRAPHER_SDF_VERSION; }

std::string ProgramCommit() { return CARTOGRAPHER_SDF_COMMIT; }

std::string VersionLine(const std::string& program) {
  return absl::StrCat(program, " ", ProgramVersion(), " (commit ",
                      ProgramCommit(), ")");
}

}  // namespace cartographer_sdf
