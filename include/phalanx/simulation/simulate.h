// SPDX-License-Identifier: Apache-2.0
// Running a motion through the step, without dynamics, as fast as the machine allows.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "phalanx/device/motion.h"
#include "phalanx/simulation/step_times.h"
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

/// Value of each segment, in the order of segment_name().
using SegmentArray = std::array<double, kSegments>;

/// A simulated motion as arrays with one row a step. Each array is one block of memory without gaps, row after
/// row: `torque.front().data()` points to ticks x kJoints doubles.
struct SimulatedMotion {
  std::vector<double> time_s;           ///< [s]
  std::vector<Status> status;           ///< of each step
  std::vector<JointArray> hcp_angle;    ///< measured hand [rad]
  std::vector<JointArray> gdp_angle;    ///< shown hand [rad]
  std::vector<JointArray> torque;       ///< command [Nm]
  std::vector<SegmentArray> depth;      ///< SegmentSnapshot::depth [m]
  std::vector<SegmentArray> force_raw;  ///< SegmentSnapshot::force_raw [N]
  std::vector<SegmentArray> force;      ///< SegmentSnapshot::force [N]
};

/// Steps `model` as simulate() does, and returns every step.
/// @throws as HapticState's constructor
[[nodiscard]] SimulatedMotion simulate_motion(const HapticModel& model, const HapticParameters& parameters,
                                              const Motion& motion, std::uint64_t ticks);

}  // namespace phalanx
