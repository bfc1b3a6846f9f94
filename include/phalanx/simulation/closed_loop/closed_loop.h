// SPDX-License-Identifier: Apache-2.0
// The step and a simulated exoskeleton in a closed loop, run as fast as the machine allows.
#pragma once

#include <functional>

#include "phalanx/simulation/simulated_exoskeleton.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {

/// The patient's intended motion. Both functions are called once a tick of the controller.
struct Intention {
  std::function<JointArray(double t)> angle;  ///< intended angles [rad]
  std::function<JointArray(double t)> push;   ///< external torque on each joint [Nm]; may be empty
};

/// Function between the host's step and the device, which may change the command. @param t  time of
/// the step [s]
using Gate = std::function<void(double t, const SimulatedExoskeleton&, Snapshot& leaving)>;

/// Runs until `seconds`. The host steps at (n + host_phase) / rate_hz on the newest sample. Its command
/// leaves after the compute delay and arrives after the return delay.
/// @param host_phase  phase of the host's first step in its period, 0 .. 1: the two clocks are independent
/// @param observer    called after each step of the host
/// @param gate        empty: the step's output reaches the device unchanged
/// @throws std::invalid_argument as HapticState; and what `intention`, the observer and the gate throw
/// @pre seconds is finite. Equal model, parameters, device and intention give equal bits. Not real-time:
/// `intention` may allocate.
void run_closed_loop(
    const HapticModel& model, const HapticParameters& parameters, SimulatedExoskeleton& device,
    const Intention& intention, double seconds, double host_phase,
    const std::function<void(double t, const Snapshot&, const SimulatedExoskeleton&)>& observer,
    const Gate& gate = {});

}  // namespace phalanx
