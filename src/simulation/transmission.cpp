// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/transmission.h"

#include <algorithm>
#include <cmath>

#include "simulation/box_least_squares.h"

namespace phalanx {
namespace {

constexpr double kLargestTorque = 1e6;
/// Factor on the largest diagonal element. The term makes the forces of redundant motors unique:
/// the smallest ones.
constexpr double kEffort = 1e-10;

/// @returns the only joint that the motor moves; -1: several.
int only_joint(const ExoMotor& motor) {
  int only = -1;
  for (int j = 0; j < kJoints; ++j) {
    if (motor.arm[static_cast<std::size_t>(j)] == 0.0) continue;
    if (only >= 0) return -1;
    only = j;
  }
  return only;
}

}  // namespace

Transmission::Transmission(const Exoskeleton& exo) : motor_count_(static_cast<int>(exo.motors.size())) {
  check_exoskeleton(exo);
  for (std::size_t m = 0; m < exo.motors.size(); ++m) {
    const ExoMotor& motor = exo.motors[m];
    motor_[m] = {.arm = motor.arm,
                 .least = motor.pull_only ? -motor.bias : -motor.force_limit,
                 .largest = motor.force_limit - motor.bias,
                 .bias = motor.bias,
                 .pull_only = motor.pull_only,
                 .only_joint = only_joint(motor),
                 .force_constant = motor.force_constant};
    for (const JointLinkage& linkage : motor.linkages) linkage_.emplace_back(m, linkage);
  }
  coupling_count_ = static_cast<int>(exo.coupled.size());
  for (std::size_t i = 0; i < exo.coupled.size(); ++i) {
    const CoupledJoint& coupled = exo.coupled[i];
    coupling_[i] = {static_cast<std::size_t>(coupled.joint), static_cast<std::size_t>(coupled.of),
                    coupled.ratio};
  }
  group_motors();
}

void Transmission::set_angles(const JointArray& angle) noexcept {
  for (const auto& [motor, linkage] : linkage_) {
    const auto j = static_cast<std::size_t>(linkage.joint);
    motor_[motor].arm[j] = moment_arm(linkage, std::isfinite(angle[j]) ? angle[j] : linkage.min_angle);
  }
}

double Transmission::overlap(int a, int b) const noexcept {
  const auto& row_a = motor_[static_cast<std::size_t>(a)].arm;
  const auto& row_b = motor_[static_cast<std::size_t>(b)].arm;
  double sum = 0.0;
  for (std::size_t j = 0; j < kJoints; ++j) sum += row_a[j] * row_b[j];
  return sum;
}

void Transmission::group_motors() {
  const auto share_a_joint = [this](int a, int b) {
    for (std::size_t j = 0; j < kJoints; ++j) {
      if (motor_[static_cast<std::size_t>(a)].arm[j] != 0.0 &&
          motor_[static_cast<std::size_t>(b)].arm[j] != 0.0)
        return true;
    }
    return false;
  };
  std::array<bool, kMaxMotors> placed{};
  for (int first = 0; first < motor_count_; ++first) {
    if (placed[static_cast<std::size_t>(first)]) continue;
    Group& group = group_[static_cast<std::size_t>(group_count_++)];
    group.motor[static_cast<std::size_t>(group.size++)] = first;
    placed[static_cast<std::size_t>(first)] = true;
    for (int at = 0; at < group.size; ++at) {
      for (int other = 0; other < motor_count_; ++other) {
        if (placed[static_cast<std::size_t>(other)] ||
            !share_a_joint(group.motor[static_cast<std::size_t>(at)], other))
          continue;
        placed[static_cast<std::size_t>(other)] = true;
        group.motor[static_cast<std::size_t>(group.size++)] = other;
      }
    }
  }
}

JointArray Transmission::with_coupled_moved(const JointArray& wanted) const noexcept {
  JointArray asked = wanted;
  for (double& torque : asked)
    torque = std::isfinite(torque) ? std::clamp(torque, -kLargestTorque, kLargestTorque) : 0.0;
  for (int i = 0; i < coupling_count_; ++i) {
    const Coupling& coupling = coupling_[static_cast<std::size_t>(i)];
    asked[coupling.of] += coupling.ratio * asked[coupling.joint];
    asked[coupling.joint] = 0.0;
  }
  return asked;
}

void Transmission::share(const Group& group, const JointArray& asked, MotorArray& force) const noexcept {
  const auto motor = [&](Eigen::Index i) { return group.motor[static_cast<std::size_t>(i)]; };
  const auto drive = [&](int m) {
    double sum = 0.0;
    for (std::size_t j = 0; j < kJoints; ++j) sum += motor_[static_cast<std::size_t>(m)].arm[j] * asked[j];
    return sum;
  };
  if (group.size == 1) {
    const int only = group.motor[0];
    const Motor& own = motor_[static_cast<std::size_t>(only)];
    const double best = own.only_joint < 0
                            ? drive(only) / overlap(only, only)
                            : asked[static_cast<std::size_t>(own.only_joint)] /
                                  own.arm[static_cast<std::size_t>(own.only_joint)];  // exact to the last bit
    force[static_cast<std::size_t>(only)] = std::clamp(best, own.least, own.largest);
    return;
  }
  SmallMatrix<kMaxMotors> H(group.size, group.size);
  SmallVector<kMaxMotors> c(group.size), least(group.size), largest(group.size), x(group.size);
  for (Eigen::Index a = 0; a < group.size; ++a) {
    const Motor& own = motor_[static_cast<std::size_t>(motor(a))];
    c[a] = drive(motor(a));
    least[a] = own.least;
    largest[a] = own.largest;
    x[a] = std::clamp(0.0, own.least, own.largest);
    for (Eigen::Index b = 0; b < group.size; ++b) H(a, b) = overlap(motor(a), motor(b));
  }
  const double effort = kEffort * H.diagonal().maxCoeff();
  for (Eigen::Index a = 0; a < group.size; ++a) H(a, a) += effort;
  minimise_in_box<kMaxMotors>(H, c, least, largest, x);
  for (Eigen::Index a = 0; a < group.size; ++a) force[static_cast<std::size_t>(motor(a))] = x[a];
}

void Transmission::render(const JointArray& wanted, Rendered& rendered) const noexcept {
  rendered.asked = with_coupled_moved(wanted);
  rendered.force.fill(0.0);
  rendered.torque.fill(0.0);
  rendered.saturated = false;
  for (int g = 0; g < group_count_; ++g)
    share(group_[static_cast<std::size_t>(g)], rendered.asked, rendered.force);
  for (std::size_t m = 0; m < static_cast<std::size_t>(motor_count_); ++m) {
    const Motor& motor = motor_[m];
    const double force = rendered.force[m];
    rendered.current[m] = (force + motor.bias) / motor.force_constant;
    if (force >= motor.largest || (!motor.pull_only && force <= motor.least)) rendered.saturated = true;
    for (std::size_t j = 0; j < kJoints; ++j) rendered.torque[j] += motor.arm[j] * force;
  }
  for (std::size_t j = 0; j < kJoints; ++j) rendered.unrendered[j] = rendered.asked[j] - rendered.torque[j];
}

}  // namespace phalanx
