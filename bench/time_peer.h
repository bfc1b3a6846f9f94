// SPDX-License-Identifier: Apache-2.0
// A peer's whole step, begun at every tick from our state, timed and held against ours.
#pragma once

#include <string>
#include <vector>

#include "compare.h"
#include "grasp_motions.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx::bench {

enum class PeerKind { kFclPruned, kFclNaive, kBrute };

/// How a peer is run.
struct PeerPlan {
  PeerKind kind;
  std::string name;
  int repeats;  ///< a tick's time is the least of so many
  int every;    ///< every so many-th tick is timed; 1 for a peer that remembers
};

/// One tick that was run.
struct PeerTick {
  std::size_t tick = 0;  ///< of all motions' ticks one after another
  double us = 0.0;       ///< the whole step: kinematics, GDP, forces and torques
  long questions = 0;    ///< of distance, put to the engine
};

struct PeerTimes {
  PeerPlan plan;
  std::vector<PeerTick> ticks;  ///< that were timed
  Agreement agreement;          ///< of these, and of every tick in which ours made a contact
};

/// Runs and compares one peer. Taking over our state is not timed; the sample guard and the snapshot, which
/// ours has on top, are left out.
[[nodiscard]] PeerTimes time_peer(const HapticModel& model, const HapticParameters& parameters,
                                  const std::vector<BenchMotion>& motions, const PeerPlan& plan);

}  // namespace phalanx::bench
