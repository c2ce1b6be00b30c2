// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/progress.h"

#include <limits>
#include <sstream>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::progress_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(FormatProgressTest, ShowsFractionAndTimeLeft) {
  EXPECT_EQ(FormatProgress("match", 0.5, 10., 100),
            "match [===============>              ]  50 %, 10 s left");
  EXPECT_EQ(FormatProgress("match", 1., 10., 100),
            "match [==============================] 100 %, 0 s left");
  EXPECT_EQ(FormatProgress("read", 0.001, 10., 100),
            "read [>                             ]   0 %");
  EXPECT_THAT(FormatProgress("x", 0.1, 60., 100), HasSubstr("9 min 00 s left"));
  EXPECT_THAT(FormatProgress("x", 0.1, 900., 100),
              HasSubstr("2 h 15 min left"));
  EXPECT_THAT(FormatProgress("x", 0.1, 1e9, 100), Not(HasSubstr("left")));
}

TEST(FormatProgressTest, KeepsToTheWidthAndTheRange) {
  EXPECT_EQ(FormatProgress("match", 0.5, 10., 12), "match [=====");
  EXPECT_EQ(FormatProgress("match", 0.5, 10., -1), "");
  EXPECT_EQ(FormatProgress("x", 7., 10., 80), FormatProgress("x", 1., 10., 80));
  EXPECT_EQ(FormatProgress("x", -7., 10., 80),
            FormatProgress("x", 0., 10., 80));
  EXPECT_EQ(
      FormatProgress("x", std::numeric_limits<double>::quiet_NaN(), 10., 80),
      FormatProgress("x", 0., 10., 80));
}

TEST(ProgressTest, AppearsAfterASecondAndDisappears) {
  std::ostringstream terminal;
  double now = 100.;
  {
    Progress progress("read", &terminal, 60, [&now] { return now; });
    now += 0.9;
    progress.Update(0.1);
    EXPECT_EQ(terminal.str(), "");
    now += 0.6;
    progress.Callback()(0.25);
    EXPECT_EQ(terminal.str(),
              "\r\x1b[K" + FormatProgress("read", 0.25, 1.5, 60));
    EXPECT_DOUBLE_EQ(progress.ElapsedSeconds(), 1.5);
    const std::string before = terminal.str();
    now += 0.05;
    progress.Update(0.26);
    EXPECT_EQ(terminal.str(), before);
    now += 0.06;
    progress.Update(0.27);
    EXPECT_THAT(terminal.str(), HasSubstr(" 27 %"));
  }
  const std::string all = terminal.str();
  EXPECT_EQ(all.substr(all.size() - 4), "\r\x1b[K");
}

TEST(ProgressTest, ShortStagesLeaveNoTrace) {
  std::ostringstream terminal;
  {
    Progress("read", &terminal, 60, [] { return 0.; }).Update(1.);
  }
  EXPECT_EQ(terminal.str(), "");
}

TEST(ProgressTest, NeedsNoTerminal) {
  double now = 0.;
  Progress progress("read", nullptr, 60, [&now] { return now; });
  now = 10.;
  progress.Update(0.5);
  EXPECT_EQ(progress.ElapsedSeconds(), 10.);
}

}  // namespace
}  // namespace cartographer_sdf::progress_test
