// SPDX-License-Identifier: Apache-2.0
// Plays a motion through the step as fast as the machine can.
#pragma once

#include <cstdint>
#include <functional>

#include "phalanx/device/motion.h"
#include "phalanx/record/step_times.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {

/// Number of ticks that `seconds` [s] at `rate_hz` [Hz] have, at least 1: tick i is at i / rate_hz.
/// @throws std::invalid_argument unless both are finite, rate_hz > 0, seconds >= 0 and the ticks are at most
/// 1e9.
[[nodiscard]] std::uint64_t tick_count(double seconds, double rate_hz);

struct SimulationObservers {
  std::function<void(const Snapshot&)>
      tick;  ///< after every step; its time is not counted as the step's; may be empty
  std::function<void(std::uint64_t done, std::uint64_t total)>
      progress;  ///< about 100 times a run; may be empty
};

/// Steps `model` from the open hand over `ticks` samples of `motion` at the model's rate: sample i is
/// motion.at(i / rate) at time i / rate.
/// @returns percentiles of the wall time of step() alone [us]
/// @throws as HapticState's constructor, and whatever an observer throws.
/// Not real-time: allocates one double a tick before the first step.
StepTimes simulate(const HapticModel& model, const Motion& motion, std::uint64_t ticks,
                   const SimulationObservers& observers = {});

}  // namespace phalanx
