// SPDX-License-Identifier: Apache-2.0
// From the torques that the joints should feel to the forces that the motors pull their tendons with.
#pragma once

#include <array>

#include "phalanx/core/math.h"
#include "phalanx/device/exoskeleton.h"

namespace phalanx {

inline constexpr int kMaxMotors = 32;

/// One number per motor, in the order of Exoskeleton::motors.
using MotorArray = std::array<double, kMaxMotors>;

/// What Transmission::render() makes of one tick's torques.
struct Rendered {
  MotorArray force{};       ///< to each motor, beyond its bias [N]; 0 beyond the last motor
  MotorArray current{};     ///< (force + bias) / force_constant [A]
  JointArray asked{};       ///< wanted, each coupled joint's torque moved to the joint that it follows [Nm]
  JointArray torque{};      ///< what the tendons do beyond their bias: sum_m arm[m][j] force[m] [Nm]
  JointArray unrendered{};  ///< asked - torque: what nobody feels [Nm]
  bool saturated = false;   ///< a motor is at its force limit
};

/// Shares joint torques w among the motors: of all forces T within  -bias <= T <= limit - bias  (a tendon
/// that only pulls) or  -limit <= T <= limit  it takes those that minimise  |A' T - w|^2,  A the matrix of
/// moment arms (one row a motor); where several do, those with the least |T|.
///
/// Coupled joints: q = ratio q_of + offset, so by virtual work a torque t on the joint that follows is the
/// torque ratio t on the one that it follows:  w_of += ratio t.
///
/// Motors that share no joint with another are solved in closed form, exactly. Groups of motors that do share
/// are a box-constrained quadratic program, solved by an active set method (Lawson, Hanson 1974, ch. 23, in
/// the normal equations, strictly convex by adding 1e-10 of the largest diagonal to it: the torques differ
/// from the best ones by about that factor, the least effort is met to about 1e-5). After a fixed number of
/// rounds it stops with what it has, which always keeps the bounds.
class Transmission {
 public:
  /// @throws std::invalid_argument as check_exoskeleton(). Set-up only.
  explicit Transmission(const Exoskeleton& exoskeleton);

  /// @param wanted  torque on each of the hand's joints [Nm]; one that is not finite counts as 0, beyond
  /// +-1e6 as that
  /// @param rendered  out: finite numbers, forces within the bounds above, whatever arrives. Same torques,
  /// same bits. Real-time: no allocation, lock, throw or I/O.
  void render(const JointArray& wanted, Rendered& rendered) const noexcept;

  [[nodiscard]] int motor_count() const noexcept { return motor_count_; }

 private:
  struct Motor {
    std::array<double, kJoints> arm{};
    double least = 0.0;  ///< bounds of T [N]
    double largest = 0.0;
    double bias = 0.0;
    bool pull_only = false;
    int only_joint = -1;  ///< that it moves; -1: several
    double force_constant = 1.0;
  };
  struct Coupling {
    std::size_t joint = 0;
    std::size_t of = 0;
    double ratio = 1.0;
  };
  /// Motors that share joints, directly or through others.
  struct Group {
    int size = 0;
    std::array<int, kMaxMotors> motor{};
  };

  void group_motors();
  [[nodiscard]] JointArray with_coupled_moved(const JointArray& wanted) const noexcept;
  void share(const Group& group, const JointArray& asked, MotorArray& force) const noexcept;
  [[nodiscard]] double overlap(int a, int b) const noexcept;

  int motor_count_ = 0;
  std::array<Motor, kMaxMotors> motor_{};
  int coupling_count_ = 0;
  std::array<Coupling, kJoints> coupling_{};
  int group_count_ = 0;
  std::array<Group, kMaxMotors> group_{};
};

}  // namespace phalanx
