// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_REPORT_AUDIT_TABLE_H_
#define CARTOGRAPHER_SDF_REPORT_AUDIT_TABLE_H_

#include <string>

#include "absl/status/status.h"
#include "cartographer_sdf/apps/audit.h"

namespace cartographer_sdf {

// CSV, a line for each inter-submap constraint in the file's order: its number
// among all constraints of the file, its ends and pose (submap <- node), the
// group that it was judged with (numbered from 0) and the pose of that
// (reference
// <- query), verdict and evidence. What an unchecked constraint has no value of
// is empty.
[[nodiscard]] absl::Status WriteAuditTable(const std::string& path,
                                           const Audit& audit);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_AUDIT_TABLE_H_
