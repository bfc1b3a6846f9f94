// SPDX-License-Identifier: Apache-2.0
// Transmission: from wanted joint torques to the motors' tendon forces.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "phalanx/core/math.h"
#include "phalanx/device/exoskeleton.h"

namespace phalanx {

/// One number per motor, in the order of Exoskeleton::motors.
using MotorArray = std::array<double, kMaxMotors>;

/// Result of Transmission::render() for one tick.
struct Rendered {
  MotorArray force{};       ///< of each motor, beyond its bias [N]; 0 beyond the last motor
  MotorArray current{};     ///< (force + bias) / force_constant [A]
  JointArray asked{};       ///< wanted torques; each coupled joint's torque is moved to the joint that
                            ///< it follows [Nm]
  JointArray torque{};      ///< torques of the tendons beyond their bias: sum_m arm[m][j] force[m] [Nm]
  JointArray unrendered{};  ///< asked - torque: the part that the motors cannot exert [Nm]
  bool saturated = false;   ///< a motor is at its force limit
};

/// Distribution of joint torques w to the motors' forces T. The bounds are  -bias <= T <= limit - bias  for a
/// pull-only tendon, and  -limit <= T <= limit  otherwise. It minimises  |A' T - w|^2,  with the matrix A of
/// moment arms (one row a motor). If several T do, it takes the one with the least |T|.
///
/// Motors with a linkage have the moment arms of the angles of set_angles().
///
/// Coupled joints: q = ratio q_of + offset. By virtual work, a torque t on the following joint equals the
/// torque ratio t on the joint that it follows:  w_of += ratio t.
///
/// Motors that share no joint with another are solved in closed form, exactly. Motors that share joints form
/// a box-constrained quadratic program. An active set method solves its normal equations (Lawson, Hanson
/// 1974, ch. 23). Adding 1e-10 of the largest diagonal makes it strictly convex: the torques differ from the
/// best ones by about that factor, and the least effort is met to about 1e-5. After a fixed number of rounds
/// it stops with the present result, which always keeps the bounds.
class Transmission {
 public:
  /// @throws std::invalid_argument as check_exoskeleton(). Set-up only.
  explicit Transmission(const Exoskeleton& exoskeleton);

  /// Sets the joints' angles, from which linkages have their moment arms; they begin at the largest ones.
  /// A device without linkages ignores them. Real-time.
  void set_angles(const JointArray& angle) noexcept;
  /// Computes the motors' forces.
  /// @param wanted  torque on each of the hand's joints [Nm]; one that is not finite counts as 0, and the
  /// magnitude is bounded by 1e6
  /// @param rendered  out: finite for every input, forces within the bounds above. Equal torques
  /// give equal bits.
  /// Real-time: no allocation, lock, throw or I/O.
  void render(const JointArray& wanted, Rendered& rendered) const noexcept;

  [[nodiscard]] int motor_count() const noexcept { return motor_count_; }

 private:
  struct Motor {
    std::array<double, kJoints> arm{};
    double least = 0.0;    ///< lower bound of T [N]
    double largest = 0.0;  ///< upper bound of T [N]
    double bias = 0.0;
    bool pull_only = false;
    int only_joint = -1;  ///< the only joint that it moves; -1: several
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
  std::vector<std::pair<std::size_t, JointLinkage>> linkage_;  ///< of a motor
  std::array<Motor, kMaxMotors> motor_{};
  int coupling_count_ = 0;
  std::array<Coupling, kJoints> coupling_{};
  int group_count_ = 0;
  std::array<Group, kMaxMotors> group_{};
};

}  // namespace phalanx
