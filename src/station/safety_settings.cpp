// SPDX-License-Identifier: Apache-2.0
#include "phalanx/station/safety_settings.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>

namespace phalanx {
namespace {

void refuse_off(bool on, const char* key) {
  if (on) return;
  throw std::invalid_argument(
      fmt::format("{} = \"off\": a station runs with every limit on; give it a number (`phalanx simulate` "
                  "and studies may turn it off)",
                  key));
}

void refuse_above(double value, double most, const char* key, const char* unit) {
  if (value <= most) return;
  throw std::invalid_argument(
      fmt::format("{} = {}: a station allows at most {} {}; lower it", key, value, most, unit));
}

}  // namespace

SafetySettings make_safety_settings(const LimitParameters& limits, const std::string& clinician) {
  refuse_off(limits.fingertip_force_enabled, "limits.fingertip_force_n");
  refuse_off(limits.joint_torque_enabled, "limits.joint_torque_nm");
  refuse_off(limits.torque_rate_enabled, "limits.torque_rate_nm_per_s");
  refuse_off(std::isfinite(limits.joint_speed), "limits.joint_speed_rad_per_s");
  refuse_above(limits.fingertip_force, kForceWithClinician, "limits.fingertip_force_n", "N");
  if (limits.fingertip_force > kForceWithoutClinician && clinician.empty()) {
    throw std::invalid_argument(fmt::format(
        "limits.fingertip_force_n = {}: above {} N a clinician must answer for it; lower it, or name the "
        "clinician: --clinician NAME (up to {} N)",
        limits.fingertip_force, kForceWithoutClinician, kForceWithClinician));
  }
  refuse_above(limits.joint_torque, kTorqueNever, "limits.joint_torque_nm", "Nm");
  refuse_above(limits.torque_rate, kTorqueRateNever, "limits.torque_rate_nm_per_s", "Nm/s");
  SafetySettings settings;
  settings.fingertip_force = limits.fingertip_force;
  settings.joint_torque = limits.joint_torque;
  settings.torque_rate = limits.torque_rate;
  settings.joint_speed = limits.joint_speed;
  if (!clinician.empty()) settings.patient = "--clinician " + clinician;
  return settings;
}

bool holds_without_host(const DeviceInfo& device) noexcept {
  return device.actuated && !device.simulated && !device.watchdog;
}

void check_watchdog(const SafetySettings& settings, const DeviceInfo& device) {
  if (settings.patient.empty() || !holds_without_host(device)) return;
  throw std::invalid_argument(fmt::format(
      "{}: a patient's session, and the device {} (serial {}) has no watchdog: it holds a finger while this "
      "program is frozen, or after it was killed; leave it out to try the device out. If the firmware of a "
      "glove lets go by itself, start with --watchdog-ms MS; if a glove has no force feedback, with "
      "--no-force-feedback (docs/device.md)",
      settings.patient, device.name, device.serial.empty() ? "unknown" : device.serial));
}

std::string fault_words(const FaultEvent& event) {
  std::string text(fault_meaning(event.fault));
  if (event.fault != Fault::kSampleRate) return text;
  text += fmt::format(" It promises {:.4g} Hz. It sends {:.4g} Hz by its own clock", event.rates.promised,
                      event.rates.by_device);
  if (event.rates.by_host > 0.0)
    text += fmt::format(" and {:.4g} Hz by this computer's", event.rates.by_host);
  return text + '.';
}

std::string_view safety_state_name(SafetyState state) noexcept {
  constexpr std::array<std::string_view, 6> kNames = {"waiting",  "starting", "running",
                                                      "stopping", "stopped",  "fault"};
  return kNames[static_cast<std::size_t>(state)];
}

}  // namespace phalanx
