// SPDX-License-Identifier: Apache-2.0
// The step and a simulated exoskeleton, closed into one loop, as fast as the machine can.
#pragma once

#include <functional>

#include "phalanx/device/simulated_exoskeleton.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {

/// What moves the device from the inside. Both are asked once a tick of the controller.
struct Intention {
  std::function<JointArray(double t)> angle;  ///< intended angles [rad]
  std::function<JointArray(double t)> push;   ///< torque from outside on each joint [Nm]; may be empty
};

/// Runs until `seconds`. The host steps at (n + host_phase) / rate_hz on the newest sample; its command
/// leaves after the compute delay and arrives after the return delay.
/// @param host_phase  where the host's first step falls in its period, 0 .. 1: the two clocks do not know
/// each other
/// @param observer    after each step of the host
/// @pre seconds is finite. Same model, device and intention, same bits. Not real-time: `intention` may
/// allocate.
void run_closed_loop(
    const HapticModel& model, SimulatedExoskeleton& device, const Intention& intention, double seconds,
    double host_phase,
    const std::function<void(double t, const Snapshot&, const SimulatedExoskeleton&)>& observer);

}  // namespace phalanx
