// SPDX-License-Identifier: Apache-2.0
// The simulated exoskeleton and patient inside the station's own process: no wire, no thread. Its time is the
// number of steps that the host has made, so that a busy machine changes nothing.
#pragma once

#include <memory>

#include "phalanx/device/device.h"
#include "phalanx/device/exoskeleton.h"
#include "phalanx/device/patient.h"
#include "phalanx/device/press_plan.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

struct SimulatedDeviceSettings {
  Exoskeleton exoskeleton;
  PatientParameters patient;
  PressPlan plan;
  HandParameters hand;
  double wall = 500.0;  ///< stiffness that the patient expects [N/m]
  double host_rate_hz = 200.0;
  double torque_limit = 0.5;  ///< that the host configures [Nm]
  double torque_rate = 10.0;  ///< likewise [Nm/s]
  std::uint64_t seed = 1;
};

/// Every receive() advances the plant by one period of the host and gives the samples of that time; where the
/// host is faster than the controller, some calls give none. The controller in it is the link's own
/// (phx_controller): ages, latches and ramps are those of a real one. A host that goes on after a fault finds
/// the patient still squeezing.
/// @throws std::invalid_argument as SimulatedController, or if a rate is not above 0. Set-up only.
[[nodiscard]] std::unique_ptr<Device> make_simulated_device(const SimulatedDeviceSettings& settings);

}  // namespace phalanx
