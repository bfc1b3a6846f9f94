// SPDX-License-Identifier: Apache-2.0
// What can make the station stop: one list for the controller's faults and the host's.
#pragma once

#include <cstdint>
#include <string_view>

namespace phalanx {

/// A fault latches: torque goes to zero and stays there until somebody resets it. Values below 64 come over
/// the link (enum phx_fault, phalanx/device/link/phalanx_link.h), the others are the host's own.
enum class Fault : std::uint16_t {
  kNone = 0,
  kStepTooOld = 1,       ///< controller: the host's newest step became 20 ms old
  kSensorRange = 2,      ///< controller or host: an open or shorted sensor
  kEmergencyStop = 3,    ///< the emergency stop was pressed
  kDrive = 4,            ///< the device's own: motor driver, supply, temperature
  kNoSample = 64,        ///< no sample for 10 ms
  kControllerRestarted,  ///< the controller speaks of another session than ours
  kRefused,              ///< the device belongs to another host, or speaks another version
  kSampleNotFinite,      ///< an angle is not a number, 3 samples running
  kOutOfRange,           ///< a joint is far outside the patient's range of motion, 3 samples running
  kJump,                 ///< a joint moved faster than a hand can, 3 samples running
  kClockBackwards,       ///< the device's clock did not increase, 3 samples running
  kStuckSensor,          ///< a sensor stood still while others say that its joint moved
  kTorqueDisagrees,      ///< what is measured is not what was commanded
  kOverload,             ///< too many steps in a row ended too late
  kForceCeiling,         ///< a step asked for more force on a digit than is allowed
  kCommandNotFinite,     ///< a step came out not finite
  kDeviceLost,           ///< the device's port or socket failed
  kNotActing,            ///< the device does not act on what it is sent
  kOscillation,          ///< the force oscillated again soon after it had faded because it oscillated
};

/// "step_too_old", ... as it appears in files and on the screen; "fault_123" has no name here and is
/// "unknown".
[[nodiscard]] std::string_view fault_name(Fault fault) noexcept;
/// One plain sentence each: what it means, and what to do.
[[nodiscard]] std::string_view fault_meaning(Fault fault) noexcept;
[[nodiscard]] std::string_view fault_remedy(Fault fault) noexcept;

}  // namespace phalanx
