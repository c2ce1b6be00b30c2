// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/host_messages.h"

#include <unistd.h>

#include <iostream>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/tools/subcommand.h"

namespace cartographer_sdf {
namespace {

constexpr size_t kMaxMessageLength = 400;

}  // namespace

HostMessages::HostMessages(std::string program,
                           std::function<bool(google::LogSeverity)> shows)
    : program_(std::move(program)), shows_(std::move(shows)) {
  FLAGS_stderrthreshold = google::NUM_SEVERITIES;
  for (int severity = 0; severity < google::NUM_SEVERITIES; ++severity) {
    google::SetLogDestination(severity, "");
  }
  google::AddLogSink(this);
}

HostMessages::~HostMessages() { google::RemoveLogSink(this); }

void HostMessages::send(const google::LogSeverity severity,
                        const char* const /*full_filename*/,
                        const char* const base_filename, const int line,
                        const ::tm* const /*time*/, const char* const message,
                        const size_t length) {
  std::string text = OneLine(std::string(message, length));
  if (text.size() > kMaxMessageLength) {
    text.resize(kMaxMessageLength);
    text += "...";
  }
  if (severity == google::GLOG_FATAL) {
    std::cerr << program_ << ": " << text << std::endl;
    _exit(1);
  }
  if (shows_(severity)) {
    std::cerr << absl::StrCat(google::GetLogSeverityName(severity), " ",
                              base_filename, ":", line, "] ", text, "\n");
  }
}

}  // namespace cartographer_sdf
