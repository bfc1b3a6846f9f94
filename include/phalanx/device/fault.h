// SPDX-License-Identifier: Apache-2.0
// Faults that stop the station: one list for those of the controller and those of the host.
#pragma once

#include <cstdint>
#include <string_view>

namespace phalanx {

/// Reason of a latched fault: torque goes to zero and stays there until a reset. Values below 64 come over
/// the link (enum phx_fault, phalanx/device/link/phalanx_link.h). The others are the host's own.
enum class Fault : std::uint16_t {
  kNone = 0,
  kStepTooOld = 1,       ///< controller: the age of the host's newest step reached 20 ms
  kSensorRange = 2,      ///< controller or host: an open or shorted sensor
  kEmergencyStop = 3,    ///< the emergency stop was pressed
  kDrive = 4,            ///< the device's own: motor driver, supply, temperature
  kNoSample = 64,        ///< no sample for 10 ms
  kControllerRestarted,  ///< the controller reports another session than the host's
  kRefused,              ///< the device belongs to another host, or speaks another version
  kSampleNotFinite,      ///< an angle is not a number, in 3 samples in a row
  kOutOfRange,           ///< a joint is far outside the patient's range of motion, in 3 samples in a row
  kJump,                 ///< a joint moved faster than a hand can, in 3 samples in a row
  kClockBackwards,       ///< the device's clock did not increase, in 3 samples in a row
  kStuckSensor,          ///< a sensor stood still while others show that its joint moved
  kTorqueDisagrees,      ///< measured and commanded torque differ
  kOverload,             ///< too many steps in a row ended too late
  kForceCeiling,         ///< a step asked for more force on a digit than is allowed
  kCommandNotFinite,     ///< a step's result is not finite
  kDeviceLost,           ///< the device's port or socket failed
  kNotActing,            ///< the device does not act on the commands it receives
  kOscillation,          ///< the force oscillated again soon after it had faded because it oscillated
  kSampleRate,           ///< the device sends samples at another rate than it promises
};

/// Names a fault for files and screens: "step_too_old", ... A value without a name is "unknown".
[[nodiscard]] std::string_view fault_name(Fault fault) noexcept;
/// @returns the meaning of a fault, in one sentence.
[[nodiscard]] std::string_view fault_meaning(Fault fault) noexcept;
/// @returns the remedy of a fault, in one sentence.
[[nodiscard]] std::string_view fault_remedy(Fault fault) noexcept;

}  // namespace phalanx
