// SPDX-License-Identifier: Apache-2.0
// Running a motion through the step, as fast as the machine allows.
//
// The folder holds the laboratory. simulate() plays a motion through the step without dynamics. trial.h
// closes the loop on a scene with a simulated exoskeleton and patient, and judges whether the trial is
// stable. laboratory/ runs such trials over a grid of parameters, and finds the largest stable stiffness.
// report/ writes the page of a study.
#pragma once

#include <cstdint>
#include <functional>

#include "phalanx/device/motion.h"
#include "phalanx/record/step_times.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {

/// @returns the number of ticks of `seconds` [s] at `rate_hz` [Hz], at least 1: tick i is at i / rate_hz.
/// @throws std::invalid_argument unless both are finite, rate_hz > 0, seconds >= 0 and the ticks are
/// at most 1e9.
[[nodiscard]] std::uint64_t tick_count(double seconds, double rate_hz);

/// Callbacks of a simulation.
struct SimulationObservers {
  std::function<void(const Snapshot&)>
      tick;  ///< called after every step; its time is not counted as the step's; may be empty
  std::function<void(std::uint64_t done, std::uint64_t total)>
      progress;  ///< called about 100 times a run; may be empty
};

/// Steps `model` from the open hand over `ticks` samples of `motion` at the rate of `parameters`. Sample i is
/// motion.at(i / rate) at time i / rate. Not real-time: it allocates one double a tick before the first step.
/// @returns percentiles of the wall time of step() alone [us]
/// @throws as HapticState's constructor, and everything that an observer throws.
StepTimes simulate(const HapticModel& model, const HapticParameters& parameters, const Motion& motion,
                   std::uint64_t ticks, const SimulationObservers& observers = {});

}  // namespace phalanx
