// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// When is it safe to add constraints to the host's pose graph?
//
// The host puts them at the end of a queue of work, and aborts the process
// where a submap or node of theirs is gone by the time they are reached.
// Submaps and nodes go in one place only: in *rounds*, right after an
// optimisation, by trimmers and by deletions. So constraints are safe if their
// ids were there in a round, after all trimmers had their turn, and if no round
// comes between that one and them: nothing that is ahead of them in the queue
// may start one.
//
// A round is started by nodes, every so many; by the end of a trajectory; and
// by a final optimisation. The gate knows of
// - nodes: the host shows in a round how many are waiting in its queue. As so
//   many nodes never started a round as were seen to go by between two rounds,
//   less one, that many may wait, and no more;
// - the others: they pass through our decorator, which announces them before it
//   forwards them and afterwards adds a new hook, that is a trimmer of ours.
//   Once a round calls that hook, all that was announced before has been
//   reached, as the hook went through the same queue; and no trimmer has its
//   turn after it, as it was the last to be added. Hooks are numbered by
//   generation.
//
// Those announced later are behind constraints that were added before, provided
// that the caller holds one mutex both to announce and to add constraints.

#ifndef CARTOGRAPHER_SDF_LIVE_INJECTION_GATE_H_
#define CARTOGRAPHER_SDF_LIVE_INJECTION_GATE_H_

#include <cstdint>

namespace cartographer_sdf {

// Thread-compatible.
class InjectionGate {
 public:
  // Before something is forwarded that starts a round or adds a trimmer.
  void Announce();
  // After: the generation of the hook that the caller now has to add.
  [[nodiscard]] int Settle();
  // Grows with each announcement.
  [[nodiscard]] int64_t num_announced() const { return num_announced_; }
  // Announced, and not yet settled.
  [[nodiscard]] int num_unsettled() const { return num_unsettled_; }

  // By a hook in a round: the nodes that have been worked on since the start,
  // and those that are still in the queue. Whether constraints added now,
  // before the mutex and the round end, are safe. Several hooks may be called
  // in a round.
  [[nodiscard]] bool EnterRound(int generation, int64_t num_nodes_done,
                                int64_t num_nodes_waiting);
  // Hooks that have a successor may be taken away.
  [[nodiscard]] bool IsObsolete(int generation) const {
    return generation < newest_entered_;
  }

 private:
  int64_t num_announced_ = 0;
  int num_unsettled_ = 0;
  int newest_generation_ = 0;
  int newest_entered_ = 0;
  bool has_entered_ = false;
  int64_t num_nodes_done_ = 0;
  // So many never start a round.
  int64_t num_harmless_nodes_ = 0;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_INJECTION_GATE_H_
