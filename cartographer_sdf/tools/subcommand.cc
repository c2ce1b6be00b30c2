// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/subcommand.h"

#include "absl/strings/cord.h"

namespace cartographer_sdf {
namespace {

constexpr char kUsagePayload[] = "cartographer_sdf/usage";

}  // namespace

Subcommand AuditSubcommand();
Subcommand CloseLoopsSubcommand();
Subcommand Evaluate();
Subcommand FalsifySubcommand();
Subcommand Figures();
Subcommand Info();
Subcommand MatchSubcommand();
Subcommand MergeSubcommand();
Subcommand RelocalizeSubcommand();
Subcommand SimulateSubcommand();

std::vector<Subcommand> AllSubcommands() {
  return {CloseLoopsSubcommand(),
          MatchSubcommand(),
          RelocalizeSubcommand(),
          MergeSubcommand(),
          AuditSubcommand(),
          Evaluate(),
          Figures(),
          SimulateSubcommand(),
          FalsifySubcommand(),
          Info()};
}

absl::Status UsageError(const std::string& message) {
  absl::Status status = absl::InvalidArgumentError(message);
  status.SetPayload(kUsagePayload, absl::Cord());
  return status;
}

bool IsUsageError(const absl::Status& status) {
  return status.GetPayload(kUsagePayload).has_value();
}

}  // namespace cartographer_sdf
