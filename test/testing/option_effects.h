// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Finds options without effect: every leaf of a struct of options, as its
// visitor lists them (config/option_keys.h), is given other values until an
// output changes.

#ifndef TEST_TESTING_OPTION_EFFECTS_H_
#define TEST_TESTING_OPTION_EFFECTS_H_

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/config/option_keys.h"
#include "glog/logging.h"

namespace cartographer_sdf::testing {

// Counts the leaves of a struct of options, and gives one of them another
// value: each attempt is another way to change it.
class LeafChanger : public OptionVisitor {
 public:
  LeafChanger(const int leaf, const int attempt)
      : leaf_(leaf), attempt_(attempt) {}

  static constexpr int kNumAttempts = 10;

  [[nodiscard]] int num_leaves() const { return num_leaves_; }
  [[nodiscard]] const std::string& chosen() const { return chosen_; }

 private:
  void Visit(const char* const key, double& option) override {
    constexpr double kFactors[kNumAttempts] = {0.5, 2.,  0.1,  10.,  0.,
                                               -1., 1e3, 1e-3, -10., 1.5};
    if (!IsChosen(key)) return;
    option = option == 0. ? kFactors[attempt_] : option * kFactors[attempt_];
  }
  void Visit(const char* const key, int& option) override {
    if (!IsChosen(key)) return;
    const int values[kNumAttempts] = {
        option / 2, 2 * option,  1, option + 1, option - 1,
        0,          50 * option, 3, 7,          4};
    option = values[attempt_];
  }
  void Visit(const char* const key, bool& option) override {
    if (IsChosen(key)) option = !option;
  }
  void VisitName(const char* const key, const std::vector<std::string>& names,
                 int& index) override {
    if (IsChosen(key)) index = (index + 1) % static_cast<int>(names.size());
  }
  bool Enter(const char* const key) override {
    tables_.emplace_back(key);
    return true;
  }
  void Leave(const std::string& /*problem*/) override { tables_.pop_back(); }

  bool IsChosen(const char* const key) {
    if (num_leaves_++ != leaf_) return false;
    for (const std::string& table : tables_) chosen_ += table + ".";
    chosen_ += key;
    return true;
  }

  const int leaf_;
  const int attempt_;
  int num_leaves_ = 0;
  std::vector<std::string> tables_;
  std::string chosen_;
};

// What comes of the options, as text in full precision, in a situation that
// shows those whose paths begin with `prefix`.
template <typename Options>
struct Scenario {
  std::string prefix;
  std::function<std::string(const Options&)> outcome;
};

template <typename Options>
class EffectFinder {
 public:
  EffectFinder(const Options& base,
               const std::vector<Scenario<Options>>& scenarios)
      : base_(base), scenarios_(scenarios), before_(scenarios.size()) {}

  // The paths, one a line, of leaves that change no outcome in any attempt.
  [[nodiscard]] std::string FindIdle() {
    std::string idle;
    Options copy = base_;
    LeafChanger counter(-1, 0);
    VisitOptions(counter, copy);
    for (int leaf = 0; leaf < counter.num_leaves(); ++leaf) {
      LeafChanger changer(leaf, 0);
      copy = base_;
      VisitOptions(changer, copy);
      if (!HasEffect(leaf, ScenarioOf(changer.chosen()))) {
        idle += changer.chosen() + "\n";
      }
    }
    return idle;
  }

 private:
  // The one made for the leaf: with the longest prefix.
  [[nodiscard]] size_t ScenarioOf(const std::string& path) const {
    std::optional<size_t> best;
    for (size_t k = 0; k < scenarios_.size(); ++k) {
      const std::string& prefix = scenarios_[k].prefix;
      if (path.compare(0, prefix.size(), prefix) == 0 &&
          (!best || prefix.size() > scenarios_[*best].prefix.size())) {
        best = k;
      }
    }
    CHECK(best) << "no scenario for " << path;
    return *best;
  }

  [[nodiscard]] bool HasEffect(const int leaf, const size_t scenario) {
    const auto& outcome = scenarios_[scenario].outcome;
    std::optional<std::string>& before = before_[scenario];
    if (!before) before = outcome(base_);
    for (int k = 0; k < LeafChanger::kNumAttempts; ++k) {
      Options changed = base_;
      LeafChanger changer(leaf, k);
      VisitOptions(changer, changed);
      if (Validate(changed).empty() && outcome(changed) != *before) return true;
    }
    return false;
  }

  const Options& base_;
  const std::vector<Scenario<Options>>& scenarios_;
  std::vector<std::optional<std::string>> before_;
};

// A leaf is tried in the scenario with the longest prefix of its path; one
// with an empty prefix shows all others.
template <typename Options>
[[nodiscard]] std::string OptionsWithoutEffect(
    const Options& base, const std::vector<Scenario<Options>>& scenarios) {
  return EffectFinder<Options>(base, scenarios).FindIdle();
}

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_OPTION_EFFECTS_H_
