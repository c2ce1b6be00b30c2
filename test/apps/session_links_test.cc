// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/session_links.h"

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/temporary_directory.h"
#include "test/testing/two_offices.h"

namespace cartographer_sdf::session_links_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using testing::ThreadExecutor;
using ::testing::UnorderedElementsAre;

using Pairs = std::vector<std::pair<size_t, size_t>>;

Pairs PairsOf(const std::vector<SessionLink>& links) {
  Pairs pairs;
  for (const SessionLink& link : links) {
    pairs.emplace_back(link.first, link.second);
  }
  return pairs;
}

SessionLinkOptions AtLeast(const int min_num_links_per_session) {
  SessionLinkOptions options;
  options.min_num_links_per_session = min_num_links_per_session;
  return options;
}

// Two drives in one office, one in another, and again one in the first.
class SessionLinkerTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    testing::TemporaryDirectory directory;
    const FloorPlan office = testing::MakeSmallOffice(1);
    const FloorPlan other = testing::MakeSmallOffice(5);
    sessions_ = new std::vector<Session>;
    int seed = 0;
    for (const FloorPlan* const plan : {&office, &office, &other, &office}) {
      const std::string path =
          directory.File(std::to_string(seed) + ".pbstream");
      testing::WriteShortDrive(*plan, static_cast<uint32_t>(++seed), path);
      absl::StatusOr<Session> session =
          DescribeSession(LoopClosingOptions(), ScanPlaceOptions(), path,
                          std::nullopt, ThreadExecutor(2));
      CHECK(session.ok()) << session.status();
      sessions_->push_back(*std::move(session));
    }
  }
  static void TearDownTestSuite() { delete sessions_; }

  SessionLinker MakeLinker(const SessionLinkOptions& options) {
    return {options, localization_, stages_, *sessions_, executor_, &clock_};
  }

  static std::vector<Session>* sessions_;
  const LocalizationOptions localization_;
  const LoopClosingOptions stages_;
  const Executor executor_ = ThreadExecutor(2);
  std::vector<std::pair<std::string, double>> seconds_;
  StageClock clock_{{}, &seconds_};
};
std::vector<Session>* SessionLinkerTest::sessions_;

TEST_F(SessionLinkerTest, FewSessionsAreAllLinked) {
  SessionLinker linker = MakeLinker(SessionLinkOptions());
  linker.LinkMostAlike();
  EXPECT_THAT(PairsOf(linker.links()),
              ElementsAre(Pair(0, 1), Pair(0, 2), Pair(0, 3), Pair(1, 2),
                          Pair(1, 3), Pair(2, 3)));
  EXPECT_THAT(GroupSessions(4, linker.links()), ElementsAre(0, 0, 2, 0));
}

TEST_F(SessionLinkerTest, ThoseOfOneBuildingAreTheMostAlike) {
  SessionLinker linker = MakeLinker(AtLeast(1));
  linker.LinkMostAlike();
  // Two pairs at least tie four sessions, three at most.
  ASSERT_LE(linker.links().size(), 3u);
  int num_certain = 0;
  for (const SessionLink& link : linker.links()) {
    if (IsCertain(link)) ++num_certain;
    EXPECT_EQ(IsCertain(link), link.first != 2 && link.second != 2);
  }
  EXPECT_GE(num_certain, 1);
}

TEST_F(SessionLinkerTest, ConnectsWhatCanBeConnected) {
  SessionLinker linker = MakeLinker(AtLeast(1));
  linker.Connect({0, 1, 3});
  // As many as tie three, none of the other office.
  EXPECT_EQ(linker.links().size(), 2u);
  EXPECT_THAT(GroupSessions(4, linker.links()), ElementsAre(0, 0, 2, 0));

  linker.Connect({0, 1, 2, 3});
  // The other office was compared with each of them, in vain.
  EXPECT_EQ(linker.links().size(), 5u);
  EXPECT_THAT(GroupSessions(4, linker.links()), ElementsAre(0, 0, 2, 0));

  // Without the one that ties them, the other two are linked directly.
  const Pairs before = PairsOf(linker.links());
  for (const std::set<size_t>& two : {std::set<size_t>{0, 1}, {0, 3}, {1, 3}}) {
    linker.Connect(two);
  }
  EXPECT_EQ(linker.links().size(), 6u);
  linker.Connect({0, 1, 2, 3});
  EXPECT_EQ(linker.links().size(), 6u);
}

TEST_F(SessionLinkerTest, ACarriedRobotTiesNothing) {
  SessionLinker linker = MakeLinker(AtLeast(1));
  linker.Connect({0, 1});
  ASSERT_EQ(linker.links().size(), 1u);
  SessionLink link = linker.links().front();
  ASSERT_TRUE(IsCertain(link));
  link.localization.parts.jumps.emplace_back();
  EXPECT_FALSE(IsCertain(link));
  EXPECT_THAT(GroupSessions(2, {link}), ElementsAre(0, 1));
}

TEST(SessionLinkOptionsTest, SaysWhatIsWrong) {
  EXPECT_THAT(Validate(SessionLinkOptions()), IsEmpty());
  EXPECT_THAT(Validate(AtLeast(0)), HasSubstr("min_num_links_per_session"));
}

}  // namespace
}  // namespace cartographer_sdf::session_links_test
