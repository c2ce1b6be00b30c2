// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_TOOLS_HOST_MESSAGES_H_
#define CARTOGRAPHER_SDF_TOOLS_HOST_MESSAGES_H_

#include <ctime>
#include <functional>
#include <string>

#include "glog/logging.h"

namespace cartographer_sdf {

// As long as it lives, log messages go to the standard error, one line each,
// and to no file. Cartographer aborts the process if something is wrong with
// its files: such errors end it with the message and exit code 1 instead of a
// core dump. google::InitGoogleLogging must have been called.
class HostMessages : public google::LogSink {
 public:
  // `shows` says which messages are printed besides fatal ones.
  HostMessages(std::string program,
               std::function<bool(google::LogSeverity)> shows);
  ~HostMessages() override;
  HostMessages(const HostMessages&) = delete;
  HostMessages& operator=(const HostMessages&) = delete;

  void send(google::LogSeverity severity, const char* full_filename,
            const char* base_filename, int line, const ::tm* time,
            const char* message, size_t length) override;

 private:
  const std::string program_;
  const std::function<bool(google::LogSeverity)> shows_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_HOST_MESSAGES_H_
