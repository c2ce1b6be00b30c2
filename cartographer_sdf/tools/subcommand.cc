// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/subcommand.h"

namespace cartographer_sdf {

Subcommand CloseLoopsSubcommand();
Subcommand Evaluate();
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
          Evaluate(),
          Figures(),
          SimulateSubcommand(),
          Info()};
}

}  // namespace cartographer_sdf
