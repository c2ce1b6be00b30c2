// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace cartographer_sdf {
namespace {

constexpr double kSecondsBeforeDrawing = 1.;
constexpr double kSecondsBetweenDrawings = 0.1;
constexpr int kBarWidth = 30;
constexpr int kDefaultWidth = 80;
// Earlier, the estimate of the time left fluctuates.
constexpr double kMinFractionForEstimate = 0.02;
constexpr double kMaxSecondsLeft = 100. * 3600.;
// To the beginning of the line, and erase it.
constexpr char kErase[] = "\r\x1b[K";

double SteadySeconds() {
  return std::chrono::duration<double>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

int TerminalWidth() {
  winsize size{};
  const bool known =
      ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : kDefaultWidth;
}

std::string FormatSeconds(const double seconds) {
  const int total = static_cast<int>(std::ceil(seconds));
  if (total < 60) return absl::StrFormat("%d s", total);
  if (total < 3600) {
    return absl::StrFormat("%d min %02d s", total / 60, total % 60);
  }
  return absl::StrFormat("%d h %02d min", total / 3600, total / 60 % 60);
}

}  // namespace

std::string FormatProgress(const std::string& stage, const double fraction,
                           const double elapsed_seconds, const int width) {
  // NaN becomes 0.
  const double done = fraction > 0. ? std::min(fraction, 1.) : 0.;
  const int filled = static_cast<int>(done * kBarWidth);
  std::string bar(static_cast<size_t>(filled), '=');
  if (filled < kBarWidth) bar += '>';
  bar.resize(kBarWidth, ' ');
  std::string line = absl::StrFormat("%s [%s] %3d %%", stage, bar,
                                     static_cast<int>(100. * done));
  const double seconds_left = elapsed_seconds * (1. - done) / done;
  if (done >= kMinFractionForEstimate && seconds_left < kMaxSecondsLeft) {
    absl::StrAppend(&line, ", ", FormatSeconds(seconds_left), " left");
  }
  return line.substr(0, static_cast<size_t>(std::max(0, width)));
}

Progress::Progress(const std::string& stage)
    : Progress(stage, isatty(STDERR_FILENO) ? &std::cerr : nullptr,
               TerminalWidth() - 1, SteadySeconds) {}

Progress::Progress(const std::string& stage, std::ostream* const terminal,
                   const int width, std::function<double()> seconds)
    : stage_(stage),
      terminal_(terminal),
      width_(width),
      seconds_(std::move(seconds)),
      begin_(seconds_()) {}

Progress::~Progress() {
  if (is_drawn_) *terminal_ << kErase << std::flush;
}

double Progress::ElapsedSeconds() const { return seconds_() - begin_; }

void Progress::Update(const double fraction) {
  if (terminal_ == nullptr) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  const double elapsed = ElapsedSeconds();
  if (elapsed < kSecondsBeforeDrawing ||
      (is_drawn_ && elapsed - last_drawn_ < kSecondsBetweenDrawings)) {
    return;
  }
  is_drawn_ = true;
  last_drawn_ = elapsed;
  *terminal_ << kErase << FormatProgress(stage_, fraction, elapsed, width_)
             << std::flush;
}

}  // namespace cartographer_sdf
