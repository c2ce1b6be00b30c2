// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Decides when it is safe to add constraints to the host's pose graph.
//
// The host appends them to a work queue, and aborts the process if one of their
// submaps or nodes is gone when it reaches them. Submaps and nodes are removed
// only in *rounds*, right after an optimisation, by trimmers and by deletions.
// So constraints are safe if their ids existed in a round after all trimmers
// had run, and no round comes between that one and the constraints: nothing
// ahead of them in the queue may start a round.
//
// Rounds are started by nodes, one every fixed number of nodes; by the end of a
// trajectory; and by a final optimisation. The gate accounts for
// - nodes: in a round, the host shows how many are waiting in its queue. If n
//   nodes passed between two rounds, n - 1 nodes never start a round, so at
//   most that many may be waiting;
// - the other events: they pass through our decorator, which announces them
//   before forwarding them and afterwards adds a new hook, a trimmer of ours.
//   Once a round calls that hook, everything announced before has been reached,
//   since the hook went through the same queue; and no trimmer runs after it,
//   since it was added last. Hooks are numbered by generation.
//
// Events announced later are behind constraints that were added earlier,
// provided that the caller holds one mutex both to announce and to add
// constraints.

#ifndef CARTOGRAPHER_SDF_LIVE_INJECTION_GATE_H_
#define CARTOGRAPHER_SDF_LIVE_INJECTION_GATE_H_

#include <cstdint>

namespace cartographer_sdf {

// Thread-compatible.
class InjectionGate {
 public:
  // Call before forwarding an event that starts a round or adds a trimmer.
  void Announce();
  // Call afterwards; returns the generation of the hook that the caller must
  // add.
  [[nodiscard]] int Settle();
  // Grows with each announcement.
  [[nodiscard]] int64_t num_announced() const { return num_announced_; }
  // Of the hook that was added last. Once a round calls this one or a later
  // one, all that was settled before has been reached.
  [[nodiscard]] int newest_generation() const { return newest_generation_; }
  // Number of announced events that are not settled yet.
  [[nodiscard]] int num_unsettled() const { return num_unsettled_; }

  // Called by a hook in a round, with the number of nodes processed since the
  // start and the number still in the queue. Returns whether constraints added
  // now, before the mutex is released and the round ends, are safe. A round may
  // call several hooks.
  [[nodiscard]] bool EnterRound(int generation, int64_t num_nodes_done,
                                int64_t num_nodes_waiting);
  // Hooks with a called successor may be removed.
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
  // This many nodes never start a round.
  int64_t num_harmless_nodes_ = 0;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_INJECTION_GATE_H_
