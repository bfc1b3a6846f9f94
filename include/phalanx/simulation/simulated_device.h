// SPDX-License-Identifier: Apache-2.0
// The simulated exoskeleton and patient inside the station's own process, without a wire or a thread. Its
// time is the number of steps that the host has made, so that a busy machine changes nothing.
#pragma once

#include <memory>

#include "phalanx/device/device.h"
#include "phalanx/device/exoskeleton.h"
#include "phalanx/hand/hand_parameters.h"
#include "phalanx/simulation/patient.h"
#include "phalanx/simulation/press_plan.h"

namespace phalanx {

/// Settings of the simulated device.
struct SimulatedDeviceSettings {
  Exoskeleton exoskeleton;
  PatientParameters patient;
  PressPlan plan;
  HandParameters hand;
  double wall = 500.0;  ///< stiffness that the patient expects [N/m]
  double host_rate_hz = 200.0;
  double torque_limit = 0.5;  ///< limit that the host configures [Nm]
  double torque_rate = 10.0;  ///< limit that the host configures [Nm/s]
  std::uint64_t seed = 1;
};

/// Makes the simulated device. Every receive() advances the plant by one period of the host and returns the
/// samples of that time. If the host is faster than the controller, some calls return none. It contains the
/// link's own controller (phx_controller): ages, latches and ramps are those of a real one. After a fault, a
/// host that continues finds the patient still squeezing.
/// @throws std::invalid_argument as SimulatedController, or if a rate is not above 0. Set-up only.
[[nodiscard]] std::unique_ptr<Device> make_simulated_device(const SimulatedDeviceSettings& settings);

}  // namespace phalanx
