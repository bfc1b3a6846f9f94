// SPDX-License-Identifier: Apache-2.0
// Whatever bytes a device file, a patient file or a scene's `device.` and `patient.` keys hold, reading them
// ends in an error with a message, or in a device that can be simulated: it never sends or measures anything
// that is not finite. The first byte chooses what the rest is (p: patient, s: scene, else: device).
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "phalanx/scene/device_file.h"
#include "phalanx/scene/hand_file.h"
#include "phalanx/scene/patient_file.h"
#include "phalanx/simulation/simulated_exoskeleton.h"

namespace {

using namespace phalanx;

void require(bool ok) {
  if (!ok) std::abort();
}

const HandParameters& adult() {
  static const HandParameters hand = load_hand_file("adult");
  return hand;
}

const PatientParameters& someone() {
  static const PatientParameters patient = load_patient_file("adult");
  return patient;
}

/// Ordinary torques, then far too large ones, then none that is a number.
JointArray torque_of_tick(int tick) {
  constexpr std::array<double, 4> kTorque = {0.3, -1e9, std::numeric_limits<double>::quiet_NaN(),
                                             std::numeric_limits<double>::infinity()};
  JointArray torque;
  torque.fill(kTorque[static_cast<std::size_t>(tick) % kTorque.size()]);
  return torque;
}

void require_within_limits(const Exoskeleton& exo, const Rendered& rendered) {
  for (std::size_t m = 0; m < exo.motors.size(); ++m) {
    const ExoMotor& motor = exo.motors[m];
    const double largest = motor.force_limit - motor.bias;
    const double least = motor.pull_only ? -motor.bias : -motor.force_limit;
    require(rendered.force[m] >= least && rendered.force[m] <= largest);
    require(std::isfinite(rendered.current[m]));
  }
  for (std::size_t j = 0; j < kJoints; ++j) require(std::isfinite(rendered.unrendered[j]));
}

/// Some ticks of the whole device. A slow controller is given up: its ticks are too long for a fuzzer.
void simulate(const Exoskeleton& exo, const PatientParameters& patient) {
  constexpr int kTicks = 8;
  constexpr double kSlowest = 200.0;
  if (exo.controller.rate_hz < kSlowest) return;
  const JointArray& open = adult().open_angle;
  std::optional<SimulatedExoskeleton> device;
  try {
    device.emplace(exo, patient, open, open, 1);
  } catch (const std::invalid_argument& error) {  // too stiff for the step of the integration
    require(error.what()[0] != '\0');
    return;
  }
  JointArray closed = open;
  for (double& angle : closed) angle += 0.5;
  for (int tick = 0; tick < kTicks; ++tick) {
    device->begin_tick();
    require_within_limits(exo, device->rendered());
    for (const double angle : device->sample().angle) require(std::isfinite(angle));
    Snapshot command;
    command.torque = torque_of_tick(tick);
    device->send(command, device->time_s());
    device->end_tick({.from = open, .to = closed, .push = torque_of_tick(tick + 1)});
    for (const double angle : device->plant().angle()) require(std::isfinite(angle));
  }
}

void read_device(const std::string& text) {
  const Exoskeleton exo = parse_device(text, "fuzz.toml", "/");
  require(!device_text(exo).empty());
  simulate(exo, someone());
}

void read_patient(const std::string& text) {
  static const Exoskeleton device = load_device_file("beihang");
  const PatientParameters patient = parse_patient(text, "fuzz.toml", "/");
  require(!patient_text(patient).empty());
  simulate(device, patient);
}

void read_scene(std::string text) {
  Overrides overrides;
  constexpr std::string_view kSet = "set ";
  while (text.starts_with(kSet) && overrides.size() < 8) {
    const std::size_t end = text.find('\n');
    overrides.push_back(
        parse_override(text.substr(kSet.size(), end == std::string::npos ? end : end - kSet.size())));
    text = end == std::string::npos ? std::string() : text.substr(end + 1);
  }
  const SceneDescription scene = parse_scene(text, "fuzz.toml", "/", overrides);
  simulate(load_device(scene), load_patient(scene));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text(data + 1, data + size);
  try {
    if (data[0] == 'p') {
      read_patient(text);
    } else if (data[0] == 's') {
      read_scene(text);
    } else {
      read_device(text);
    }
  } catch (const phalanx::SceneError& error) {
    require(error.what()[0] != '\0');
  }
  return 0;
}
