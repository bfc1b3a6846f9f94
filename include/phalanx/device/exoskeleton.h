// SPDX-License-Identifier: Apache-2.0
// Parameters of one exoskeleton, as a device file states them: joints, tendons and motors, controller.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/device/channel_map.h"
#include "phalanx/device/moment_arm.h"
#include "phalanx/hand/joints.h"

namespace phalanx {

/// Dry friction of a rotor in its sheath [N, m/s] or of a joint [Nm, rad/s]: Coulomb friction with the
/// Stribeck effect. While it slides at speed v, friction opposes the motion with
///   F(v) = Fc (1 + (r - 1) exp(-(v/vs)^2));
/// at rest it holds up to r Fc.
struct DryFriction {
  double coulomb = 0.0;         ///< Fc >= 0
  double static_ratio = 1.0;    ///< r >= 1: ratio of breakaway to sliding friction
  double stribeck_speed = 1.0;  ///< vs > 0
  /// Tendon only: c = exp(mu theta) - 1 >= 0 of the sheath's bends, after the capstan equation (Euler,
  /// Eytelwein). With tension T, the sheath adds the friction c T while the motor winds up against the
  /// tension. While the joint pulls the tendon out, it adds c T / (1 + c).
  double capstan = 0.0;
};

/// One joint of the hand with the device's links on it.
struct ExoJoint {
  int joint = 0;         ///< joint_index() of the hand
  double inertia = 0.0;  ///< inertia of link and finger about the joint [kg m^2] > 0
  double damping = 0.0;  ///< viscous [N m s/rad] >= 0
  DryFriction friction;  ///< friction of the bearing
  double sensor_lsb =
      0.0;  ///< least significant bit of the joint's potentiometer [rad] >= 0; 0: not quantised
  double sensor_noise = 0.0;   ///< root mean square (rms), before quantisation [rad] >= 0
  bool torque_sensor = false;  ///< the tendon's torque on the joint is measured and sent with the sample
  std::optional<double> stop_min = {};  ///< the device's mechanical stop at the smallest angle [rad]
  std::optional<double> stop_max = {};  ///< at the largest angle [rad] > stop_min; for its calibration only
};

/// A motor and the tendon that it pulls, in the tendon's coordinates. y is the length that the motor has
/// wound up [m]. T is the tendon's tension [N], positive where it pulls. `arm` is a row of the moment-arm
/// matrix: tension T exerts the torque arm[j] T on joint j, and the joints unwind  e = sum_j arm[j] q_j.
/// A joint with a linkage unwinds  e(q_j)  instead, with the torque  r(q_j) T.
struct ExoMotor {
  std::string name;
  std::array<double, kJoints> arm{};        ///< nonzero only at the device's joints [m]
  std::vector<JointLinkage> linkages = {};  ///< add_linkage() adds them
  double lag = 0.0;                         ///< first-order lag from command to force [s] >= 0
  double force_limit = 0.0;                 ///< largest force, in both directions [N] > 0
  bool pull_only = false;                   ///< the tendon goes slack instead of pushing
  double bias = 0.0;                        ///< pull_only: constant tension [N] >= 0; the command adds to it
  double force_constant = 1.0;              ///< tendon force per motor current [N/A] > 0
  double mass = 0.0;                        ///< rotor and gear, reflected to the tendon [kg] > 0
  double damping = 0.0;                     ///< viscous damping of rotor and gear [N s/m] >= 0
  double tendon_stiffness = 0.0;            ///< [N/m] > 0
  double tendon_damping = 0.0;              ///< [N s/m] >= 0
  double backlash = 0.0;                    ///< play between winding and unwinding, full width [m] >= 0
  DryFriction sheath;                       ///< between tendon and sheath; acts on the rotor
};

/// Adds a linkage, and sets arm of its joint to the largest moment arm. Bounds use it: of the natural
/// frequency, the largest torque and the counts of a channel. Set-up only. @pre check_linkage() has passed
void add_linkage(ExoMotor& motor, JointLinkage linkage);

/// @returns the linkage of a joint; null: its moment arm is constant. Real-time.
[[nodiscard]] inline const JointLinkage* linkage_of(const ExoMotor& motor, int joint) noexcept {
  for (const JointLinkage& linkage : motor.linkages)
    if (linkage.joint == joint) return &linkage;
  return nullptr;
}

/// Timing of controller and host. The host's own rate is the scene's.
struct ExoController {
  double rate_hz = 1000.0;              ///< rate at which it senses and applies commands [Hz]
  double compute_delay = 0.0;           ///< from the host's tick until its command leaves the host [s] >= 0
  double return_delay = 0.0;            ///< from then until the controller has it [s] >= 0
  std::array<DigitCopy, kDigits> copy;  ///< for digits without a joint of their own
};

/// Largest number of motors of a device.
inline constexpr int kMaxMotors = 32;

/// All parameters of one device. Digits without a joint of their own copy another digit (`controller.copy`).
/// Their forces are recorded, and never reflected to motors.
struct Exoskeleton {
  std::string name;
  std::string description;
  std::vector<ExoJoint> joints;       ///< each joint at most once
  std::vector<CoupledJoint> coupled;  ///< not among `joints`
  std::vector<ExoMotor> motors;
  ExoController controller;
};

/// Checks a device's parameters.
/// @throws std::invalid_argument naming the joint or motor, the value and the remedy: a number is not finite
/// or outside the range stated above, or a joint appears twice. It also throws if a motor moves no joint or
/// one that the device does not have, or if a digit copies one without a sensed joint. Set-up only.
void check_exoskeleton(const Exoskeleton& exoskeleton);

/// @returns the angles that the host receives for a hand at `angle` [rad]: the device's own joints unchanged,
/// coupled joints and copied digits from those that they follow, all others at the open hand. Real-time:
/// O(joints), no allocation.
[[nodiscard]] JointArray sensed_angles(const Exoskeleton& exoskeleton, const JointArray& open,
                                       const JointArray& angle) noexcept;

/// @returns the origins of sensed_angles(): the device's own joints are measured, those that follow them are
/// completed, all others are fixed.
[[nodiscard]] AngleOrigins sensed_origins(const Exoskeleton& exoskeleton) noexcept;

/// @returns the followers of a device file.
[[nodiscard]] JointFollowers followers_of(const Exoskeleton& exoskeleton);

}  // namespace phalanx
