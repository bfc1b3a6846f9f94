// SPDX-License-Identifier: Apache-2.0
// A simulated device with a patient who presses a wall that exists on paper, and a host that renders it.
#pragma once

#include <algorithm>
#include <array>

#include "phalanx/simulation/simulated_controller.h"
#include "simulation/pressing_finger.h"

namespace phalanx::test {

inline constexpr double kWall = 500.0;  ///< [N/m]
inline constexpr int kMcpChannel = 0;   ///< of the device below: two angles, two motors, two torques
inline constexpr int kMotorChannel = 2;
inline constexpr int kTorqueChannel = 4;

/// two_joint_device() and steady_patient(), with the damping that lets them come to rest, motors that can
/// hold 3 N at the fingertip, and torque sensors.
inline SimulatedDeviceSettings squeezing_settings() {
  SimulatedDeviceSettings settings;
  settings.exoskeleton = two_joint_device();
  for (ExoMotor& motor : settings.exoskeleton.motors) {
    motor.force_limit = 30.0;
    motor.damping = 5.0;
  }
  for (ExoJoint& joint : settings.exoskeleton.joints) joint.torque_sensor = true;
  settings.patient = steady_patient();
  settings.patient.damping[idx(kMcp)] = 0.05;
  settings.patient.damping[idx(kPip)] = 0.02;
  settings.plan = plan_on_paper();
  settings.hand = simple_parameters();
  settings.wall = kWall;
  return settings;
}

/// Torques of the wall of plan_on_paper() at these angles of MCP and PIP:  f = k max(0, -g . (q - contact)).
inline JointArray wall_torque(double mcp, double pip) {
  const DigitPress press = *plan_on_paper().digit[kIndex];
  double depth = 0.0;
  depth -= press.g[idx(kMcp)] * (mcp - press.contact[idx(kMcp)]);
  depth -= press.g[idx(kPip)] * (pip - press.contact[idx(kPip)]);
  JointArray torque = press.g;
  for (double& t : torque) t *= kWall * std::max(0.0, depth);
  return torque;
}

/// Speaks to a SimulatedController without a wire: a step every `every` samples.
class MemoryHost {
 public:
  explicit MemoryHost(SimulatedController& controller, std::uint64_t host_id = 7)
      : controller_(controller), host_id_(host_id) {}

  /// @returns whether the session was granted
  bool open() {
    phx_message message{};
    message.header.type = PHX_HELLO;
    message.as.hello.host_id = host_id_;
    epoch_ = 0;
    const phx_message answer = say(message);
    if (answer.header.type != PHX_WELCOME) return false;
    epoch_ = answer.header.epoch;
    message = {};
    message.header.type = PHX_CONFIGURE;
    for (std::size_t c = 0; c < answer.as.welcome.channel_count; ++c) {
      message.as.configure.gain[c] = answer.as.welcome.channel[c].gain;
      message.as.configure.offset[c] = answer.as.welcome.channel[c].offset;
    }
    message.as.configure.torque_limit = 0.5F;
    message.as.configure.torque_rate = 10.0F;
    say(message);
    return true;
  }

  /// One tick of the controller, and a step of the host from its sample if one is due.
  void tick(const SimulatedBreakage& breakage = {}) {
    controller_.tick(breakage);
    take_sample();
    if (!silent && ++since_ >= every) command();
  }
  void run(int ticks, const SimulatedBreakage& breakage = {}) {
    for (int i = 0; i < ticks; ++i) tick(breakage);
  }

  void reset() {
    phx_message message{};
    message.header.type = PHX_RESET;
    say(message);
  }

  [[nodiscard]] const phx_sample& sample() const { return sample_; }
  [[nodiscard]] double torque(int joint) const {
    return static_cast<double>(controller_.output().torque[joint]);
  }
  [[nodiscard]] double largest_torque() const {
    double largest = 0.0;
    for (int j = 0; j < kJoints; ++j) largest = std::max(largest, std::abs(torque(j)));
    return largest;
  }
  /// The controller's time of the sample that the newest command is from.
  [[nodiscard]] std::uint64_t acted_on_us() const { return acted_on_us_; }

  int every = 5;
  bool enable = true;
  bool silent = false;

 private:
  void take_sample() {
    phx_message message;
    const phx_output& output = controller_.output();
    if (output.sample_size == 0) return;
    if (phx_decode(output.sample, output.sample_size, &message) == PHX_OK) sample_ = message.as.sample;
  }

  void command() {
    since_ = 0;
    phx_message message{};
    message.header.type = PHX_COMMAND;
    message.as.command.tick = ++tick_;
    message.as.command.sample_time_us = acted_on_us_ = sample_.time_us;
    message.as.command.flags = enable ? PHX_COMMAND_ENABLE : 0;
    const auto angle = [this](std::size_t c) {
      return controller_.info().channels[c].gain * static_cast<double>(sample_.raw[c]);
    };
    const JointArray torque = wall_torque(angle(0), angle(1));
    std::transform(torque.begin(), torque.end(), message.as.command.torque,
                   [](double t) { return static_cast<float>(t); });
    say(message);
  }

  phx_message say(phx_message& message) {
    message.header.epoch = epoch_;
    message.header.sequence = ++sequence_;
    std::array<std::uint8_t, PHX_FRAME_MAX> frame{}, reply{};
    std::size_t reply_size = 0;
    const std::size_t size = phx_encode(&message, frame.data(), frame.size());
    controller_.receive({frame.data(), size}, reply, reply_size);
    phx_message answer{};
    if (phx_decode(reply.data(), reply_size, &answer) != PHX_OK) answer.header.type = 0;
    return answer;
  }

  SimulatedController& controller_;
  std::uint64_t host_id_;
  std::uint32_t epoch_ = 0;
  std::uint32_t sequence_ = 0;
  std::uint64_t tick_ = 0;
  std::uint64_t acted_on_us_ = 0;
  int since_ = 0;
  phx_sample sample_{};
};

}  // namespace phalanx::test
