// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Localizes sessions in each other, so that they can be merged. Comparing every
// two takes time that grows with their square; once each is tied to those that
// it resembles most, and all hang together, further links say little.

#ifndef CARTOGRAPHER_SDF_APPS_SESSION_LINKS_H_
#define CARTOGRAPHER_SDF_APPS_SESSION_LINKS_H_

#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/apps/session.h"
#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/execution/stage_clock.h"
#include "cartographer_sdf/localization/localizer.h"

namespace cartographer_sdf {

struct SessionLinkOptions {
  // Each session is compared with at least so many others, those that it
  // resembles most. Further ones follow only where sessions are not connected
  // otherwise.
  int min_num_links_per_session = 4;
};
[[nodiscard]] std::string Validate(const SessionLinkOptions& options);

// Result of localizing the second of two sessions in the first.
struct SessionLink {
  size_t first = 0;  // indices of sessions, first < second
  size_t second = 0;
  Localization localization;
};

// Whether the sessions can be placed by it. One in which the robot was carried
// has no one pose.
[[nodiscard]] bool IsCertain(const SessionLink& link);

// Groups of sessions: for each, the lowest index of those that it is joined
// with.
[[nodiscard]] std::vector<size_t> SingleGroups(size_t num_sessions);
void JoinGroups(size_t a, size_t b, std::vector<size_t>* groups);
// Those that certain links connect.
[[nodiscard]] std::vector<size_t> GroupSessions(
    size_t num_sessions, const std::vector<SessionLink>& links);

// Nothing is owned but the links. Thread-compatible.
class SessionLinker {
 public:
  SessionLinker(const SessionLinkOptions& options,
                const LocalizationOptions& localization,
                const LoopClosingOptions& stages,
                const std::vector<Session>& sessions, const Executor& executor,
                StageClock* clock);

  // Links each session with those that it resembles most.
  void LinkMostAlike();
  // Links further pairs of these sessions, the most alike first, until certain
  // links between them connect them all or no pair is left.
  void Connect(const std::set<size_t>& sessions);

  // In the order of the sessions.
  [[nodiscard]] const std::vector<SessionLink>& links() const { return links_; }

 private:
  using Pair = std::pair<size_t, size_t>;

  const SessionLink& Link(const Pair& pair);
  [[nodiscard]] bool IsLinked(const Pair& pair) const;

  const SessionLinkOptions options_;
  LocalizationOptions localization_;
  const LoopClosingOptions& stages_;
  const std::vector<Session>& sessions_;
  const Executor& executor_;
  StageClock* const clock_;
  std::vector<Pair> pairs_;  // all, the most alike first
  std::vector<SessionLink> links_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_APPS_SESSION_LINKS_H_
