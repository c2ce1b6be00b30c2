// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/injection_gate.h"

#include <algorithm>
#include <deque>
#include <random>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/random_number.h"

namespace cartographer_sdf::injection_gate_test {
namespace {

// The host's queue of work and its trimmers, as far as they matter: who starts
// a round, and who has a turn in it.
class ModelOfHost {
 public:
  explicit ModelOfHost(const int optimize_every_n_nodes)
      : optimize_every_n_nodes_(optimize_every_n_nodes) {
    Announce();
    Settle();
  }

  void AddNode() { queue_.push_back({Kind::kNode, 0}); }
  // What a user does in three steps, between which others may do things.
  void Announce() { gate_.Announce(); }
  void ForwardFinish() { queue_.push_back({Kind::kFinish, 0}); }
  void ForwardTrimmer() { queue_.push_back({Kind::kTrimmer, 0}); }
  void Settle() { queue_.push_back({Kind::kHook, gate_.Settle()}); }

  bool HasWork() const { return !queue_.empty(); }
  void Work() {
    const Item item = queue_.front();
    queue_.pop_front();
    switch (item.kind) {
      case Kind::kNode:
        ++num_nodes_done_;
        ++num_nodes_since_last_round_;
        if (optimize_every_n_nodes_ > 0 &&
            num_nodes_since_last_round_ > optimize_every_n_nodes_) {
          RunRound();
        }
        break;
      case Kind::kFinish:
        RunRound();
        break;
      case Kind::kTrimmer:
      case Kind::kHook:
        trimmers_.push_back(item);
        break;
      case Kind::kConstraints:
        // The round in which their ids were verified was the last one.
        EXPECT_EQ(item.number, num_rounds_);
        EXPECT_FALSE(is_trimmed_since_verified_);
        ++num_injected_;
        break;
    }
  }
  int num_injected() const { return num_injected_; }
  int num_hooks() const {
    return static_cast<int>(std::count_if(
        trimmers_.begin(), trimmers_.end(),
        [](const Item& item) { return item.kind == Kind::kHook; }));
  }

 private:
  enum class Kind { kNode, kFinish, kTrimmer, kHook, kConstraints };
  struct Item {
    Kind kind;
    int number;  // generation of a hook, round of constraints
  };

  void RunRound() {
    ++num_rounds_;
    is_trimmed_since_verified_ = false;
    bool is_verified = false;
    for (const Item& trimmer : trimmers_) {
      if (trimmer.kind == Kind::kTrimmer) {
        is_trimmed_since_verified_ |= is_verified;
        continue;
      }
      const auto num_waiting = std::count_if(
          queue_.begin(), queue_.end(),
          [](const Item& item) { return item.kind == Kind::kNode; });
      if (gate_.EnterRound(trimmer.number, num_nodes_done_, num_waiting)) {
        queue_.push_back({Kind::kConstraints, num_rounds_});
        is_verified = true;
      }
    }
    trimmers_.erase(std::remove_if(trimmers_.begin(), trimmers_.end(),
                                   [this](const Item& item) {
                                     return item.kind == Kind::kHook &&
                                            gate_.IsObsolete(item.number);
                                   }),
                    trimmers_.end());
    num_nodes_since_last_round_ = 0;
  }

  const int optimize_every_n_nodes_;
  InjectionGate gate_;
  std::deque<Item> queue_;
  std::vector<Item> trimmers_;
  int num_nodes_done_ = 0;
  int num_nodes_since_last_round_ = 0;
  int num_rounds_ = 0;
  bool is_trimmed_since_verified_ = false;
  int num_injected_ = 0;
};

void Drain(ModelOfHost* const host) {
  while (host->HasWork()) host->Work();
}

TEST(InjectionGateTest, LetsThroughWhereTheHostKeepsUp) {
  constexpr int kEveryNNodes = 3;
  ModelOfHost host(kEveryNNodes);
  for (int k = 0; k < 20; ++k) {
    host.AddNode();
    Drain(&host);
  }
  // Five rounds, one hook in each.
  EXPECT_EQ(host.num_injected(), 5);
  EXPECT_EQ(host.num_hooks(), 1);
}

TEST(InjectionGateTest, WaitsForWhatWasAnnounced) {
  ModelOfHost host(3);
  host.Announce();
  for (int k = 0; k < 8; ++k) {
    host.AddNode();
    Drain(&host);
  }
  EXPECT_EQ(host.num_injected(), 0);
  host.ForwardFinish();
  host.Settle();
  Drain(&host);
  // In the round of the finish the new hook was not there yet.
  EXPECT_EQ(host.num_injected(), 0);
  for (int k = 0; k < 4; ++k) {
    host.AddNode();
    Drain(&host);
  }
  EXPECT_EQ(host.num_injected(), 1);
  EXPECT_EQ(host.num_hooks(), 1);
}

TEST(InjectionGateTest, LearnsHowManyNodesMayWait) {
  ModelOfHost host(3);
  // All in the queue at once: the first round shows nothing, and in the second
  // too many wait.
  for (int k = 0; k < 12; ++k) host.AddNode();
  for (int k = 0; k < 9; ++k) host.Work();
  EXPECT_EQ(host.num_injected(), 0);
  // In the third none waits; in the fourth it is known that three may.
  Drain(&host);
  EXPECT_EQ(host.num_injected(), 1);
  for (int k = 0; k < 7; ++k) host.AddNode();
  Drain(&host);
  EXPECT_EQ(host.num_injected(), 2);
}

TEST(InjectionGateTest, NeverLetsThroughWhatCouldBeTrimmed) {
  int num_injected = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937 engine(seed);
    const auto draw = [&engine](const int n) {
      return testing::UniformInt(n, &engine);
    };
    // 0: only the ends of trajectories start rounds.
    ModelOfHost host(draw(6));
    // Users in the middle of something: 0 announced, 1 forwarded.
    std::vector<int> users;
    for (int step = 0; step < 500; ++step) {
      const int action = draw(12);
      if (action < 4) {
        host.AddNode();
      } else if (action < 5 && users.size() < 3) {
        host.Announce();
        users.push_back(0);
      } else if (action < 7 && !users.empty()) {
        int& stage =
            users[static_cast<size_t>(draw(static_cast<int>(users.size())))];
        if (stage == 0) {
          if (draw(2) == 0) {
            host.ForwardFinish();
          } else {
            host.ForwardTrimmer();
          }
          stage = 1;
        } else {
          host.Settle();
          std::swap(stage, users.back());
          users.pop_back();
        }
      } else if (host.HasWork()) {
        host.Work();
      }
    }
    Drain(&host);
    num_injected += host.num_injected();
  }
  // It does let through.
  EXPECT_GT(num_injected, 300);
}

}  // namespace
}  // namespace cartographer_sdf::injection_gate_test
