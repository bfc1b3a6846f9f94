// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/simulated_exoskeleton.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "phalanx/core/index.h"

namespace phalanx {
namespace {

/// Tolerance for comparing clocks [s], far below any period: sums of periods are not exact.
constexpr double kClock = 1e-9;

/// @returns the capacity for commands on their way. At most one counts at each tick of the controller. Each
/// tick of the delays needs one, the tick of sending needs one, and rounding may add one.
std::size_t room_on_the_way(const ExoController& controller) {
  constexpr double kMost = 4096.0;
  const double ticks = std::ceil((controller.compute_delay + controller.return_delay) * controller.rate_hz);
  return static_cast<std::size_t>(std::min(ticks + 2.0, kMost));
}

}  // namespace

SimulatedExoskeleton::SimulatedExoskeleton(const Exoskeleton& exoskeleton, const PatientParameters& patient,
                                           const JointArray& open, const JointArray& start,
                                           std::uint64_t seed, double step)
    : exoskeleton_(exoskeleton),
      transmission_(exoskeleton),
      plant_(exoskeleton, patient, start, step),
      noise_(seed),
      period_(1.0 / exoskeleton.controller.rate_hz),
      open_(open),
      on_the_way_(room_on_the_way(exoskeleton.controller)) {
  input_.motor_force.assign(exoskeleton.motors.size(), 0.0);
  sample_.angle = open;
  sample_.angle_origin = sensed_origins(exoskeleton_);
}

/// @returns the slot for a new command. It overwrites the one before if that arrives for the same tick, or if
/// the ring is full.
SimulatedExoskeleton::Command& SimulatedExoskeleton::place_on_the_way(double arrives) noexcept {
  const auto place = [this](std::size_t i) -> Command& {
    return on_the_way_[(first_ + i) % on_the_way_.size()];
  };
  if (waiting_ > 0) {
    const auto tick = [this](double t) { return std::ceil((t - kClock) / period_); };
    Command& last = place(waiting_ - 1);
    if (waiting_ == on_the_way_.size() || tick(arrives) == tick(last.arrives)) return last;
  }
  return place(waiting_++);
}

void SimulatedExoskeleton::send(const Snapshot& snapshot, double finished) noexcept {
  if (!std::isfinite(finished)) return;
  const double arrives = finished + exoskeleton_.controller.return_delay;
  Command& command = place_on_the_way(arrives);
  command.arrives = arrives;
  command.valid_until = snapshot.time_s + snapshot.wall_valid_for;
  command.has_walls = snapshot.wall_valid_for > 0.0;
  command.torque = snapshot.torque;
  command.wall_reference = snapshot.hcp_angle;
  command.wall = snapshot.wall;
}

void SimulatedExoskeleton::take_arrived() noexcept {
  while (waiting_ > 0 && on_the_way_[first_].arrives <= time_s() + kClock) {
    command_ = on_the_way_[first_];
    first_ = (first_ + 1) % on_the_way_.size();
    --waiting_;
  }
}

void SimulatedExoskeleton::measure() noexcept {
  JointArray read{};
  for (const ExoJoint& joint : exoskeleton_.joints) {
    const auto j = idx(joint.joint);
    const double angle =
        plant_.angle()[j] + (joint.sensor_noise > 0.0 ? joint.sensor_noise * noise_.normal() : 0.0);
    read[j] = joint.sensor_lsb > 0.0 ? joint.sensor_lsb * std::round(angle / joint.sensor_lsb) : angle;
    if (joint.torque_sensor) sample_.measured_torque[j] = plant_.tendon_torque()[j];
  }
  sample_.time_s = time_s();
  sample_.angle = sensed_angles(exoskeleton_, open_, read);
}

JointArray SimulatedExoskeleton::wanted_torque() const noexcept {
  JointArray torque = command_.torque;
  if (!command_.has_walls || time_s() > command_.valid_until + kClock) return torque;
  for (int digit = 0; digit < kDigits; ++digit) {
    const DigitAngles q = digit_angles(sample_.angle, digit);
    const DigitAngles q_ref = digit_angles(command_.wall_reference, digit);
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const LocalWall& wall = command_.wall[idx(segment_index(digit, k))];
      if (!wall.active) continue;
      const double change = local_wall_force(wall, q, q_ref) - wall.host_force;
      for (int i = 0; i < kJointsPerDigit; ++i) torque[idx(joint_index(digit, i))] += wall.g[idx(i)] * change;
    }
  }
  return torque;
}

void SimulatedExoskeleton::begin_tick() noexcept {
  measure_tick();
  take_arrived();
  drive(wanted_torque());
}

void SimulatedExoskeleton::measure_tick() noexcept {
  if (begun_) ++tick_;
  begun_ = true;
  measure();
}

void SimulatedExoskeleton::drive(const JointArray& torque) noexcept {
  transmission_.set_angles(sample_.angle);
  transmission_.render(torque, rendered_);
  for (std::size_t i = 0; i < input_.motor_force.size(); ++i) {
    const ExoMotor& motor = exoskeleton_.motors[i];
    input_.motor_force[i] = rendered_.force[i] + (motor.pull_only ? motor.bias : 0.0);
  }
}

void SimulatedExoskeleton::fail_motor(std::size_t motor) noexcept {
  assert(motor < input_.motor_force.size());
  input_.motor_force[motor] = 0.0;
}

void SimulatedExoskeleton::end_tick(const IntendedMove& move) noexcept {
  input_.intended = move.from;
  for (std::size_t j = 0; j < move.from.size(); ++j)
    input_.intended_speed[j] = (move.to[j] - move.from[j]) / period_;
  input_.push = move.push;
  plant_.advance(input_, period_);
}

}  // namespace phalanx
