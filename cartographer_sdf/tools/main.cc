// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <string>
#include <vector>

#include "cartographer_sdf/file/pending_file.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "glog/logging.h"

int main(int argc, char** argv) {
  cartographer_sdf::KeepFreedMemory();
  cartographer_sdf::RemovePendingFilesOnSignals();
  FLAGS_logtostderr = true;
  FLAGS_minloglevel = google::GLOG_WARNING;
  google::InitGoogleLogging(argc > 0 ? argv[0] : "cartographer_sdf");
  return cartographer_sdf::RunProgram(
      std::vector<std::string>(argv + (argc > 0 ? 1 : 0), argv + argc));
}
