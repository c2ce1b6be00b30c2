// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/save_state.h"

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/file/pending_file.h"

namespace cartographer_sdf {

absl::Status SaveState(
    const std::string& path,
    cartographer::mapping::MapBuilderInterface* const map_builder) {
  absl::StatusOr<PendingFile> file = PendingFile::Create(path);
  if (!file.ok()) return file.status();
  if (!map_builder->SerializeStateToFile(/*include_unfinished_submaps=*/true,
                                         file->temporary_path())) {
    return absl::UnavailableError(absl::StrCat("cannot write ", path));
  }
  return file->Commit();
}

}  // namespace cartographer_sdf
