// SPDX-License-Identifier: Apache-2.0
// Times of our whole step, tick by tick.
#pragma once

#include <cstdint>
#include <vector>

#include "grasp_motions.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx::bench {

inline constexpr int kRepeats = 5;
inline constexpr int kColdRepeats = 3;

/// All motions' ticks one after another.
struct OurTimes {
  std::vector<std::vector<double>> repeat_us;  ///< one list of all ticks a repeat [us]
  std::uint64_t hash = 0;                      ///< of all forces and torques
  bool same_hash = true;                       ///< in every repeat

  /// Each tick's least time over the first `repeats` of them [us].
  [[nodiscard]] std::vector<double> least(int repeats) const;
  /// Each tick's greatest time [us].
  [[nodiscard]] std::vector<double> greatest() const;
};

/// step() over all motions, kRepeats times; warm: one motion runs before the first is timed.
[[nodiscard]] OurTimes time_ours(const HapticModel& model, const HapticParameters& parameters,
                                 const std::vector<BenchMotion>& motions);

/// A step whose caches were flushed before it.
struct ColdTime {
  std::size_t tick = 0;  ///< of all motions' ticks one after another
  double us = 0.0;
};
/// step() over all motions; before every `every`-th tick 64 MB are walked through, so that neither the
/// model nor the state is left in a cache. A tick's time is the least of kColdRepeats.
[[nodiscard]] std::vector<ColdTime> time_cold(const HapticModel& model, const HapticParameters& parameters,
                                              const std::vector<BenchMotion>& motions, int every);

}  // namespace phalanx::bench
