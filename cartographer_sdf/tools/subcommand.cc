// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/subcommand.h"

namespace cartographer_sdf {

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

}  // namespace cartographer_sdf
