// SPDX-License-Identifier: Apache-2.0
// The numbers of one exoskeleton, as a device file states them: joints, tendons and motors, controller.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// Dry friction of a rotor in its sheath [N, m/s] or of a joint [Nm, rad/s]. While it slides at speed v it
/// opposes the motion with  F(v) = Fc (1 + (r - 1) exp(-(v/vs)^2));  at rest it holds up to r Fc. Coulomb
/// with Stribeck
struct DryFriction {
  double coulomb = 0.0;         ///< Fc >= 0
  double static_ratio = 1.0;    ///< r >= 1: breakaway over sliding friction
  double stribeck_speed = 1.0;  ///< vs > 0
  /// Tendon only: c = exp(mu theta) - 1 >= 0 of the sheath's bends. With tension T it adds c T while the
  /// motor winds up against the tension, c T / (1 + c) while the joint pulls the tendon out.       capstan
  /// (Euler, Eytelwein)
  double capstan = 0.0;
};

/// One joint of the hand with the links that the device straps to it.
struct ExoJoint {
  int joint = 0;         ///< joint_index() of the hand
  double inertia = 0.0;  ///< of link and finger about the joint [kg m^2] > 0
  double damping = 0.0;  ///< viscous [N m s/rad] >= 0
  DryFriction friction;  ///< of the bearing
  double sensor_lsb =
      0.0;  ///< least significant bit of the joint's potentiometer [rad] >= 0; 0: not quantised
  double sensor_noise = 0.0;   ///< rms, before quantisation [rad] >= 0
  bool torque_sensor = false;  ///< the tendon's torque on the joint is measured and sent with the sample
};

/// A joint whose angle is not sensed but follows one that is:  q = ratio q_of + offset.       e.g. DIP from
/// PIP
struct CoupledJoint {
  int joint = 0;        ///< joint_index() of the joint that follows
  int of = 0;           ///< joint_index() of one of the device's joints
  double ratio = 1.0;   ///< [-]
  double offset = 0.0;  ///< [rad]
};

/// A motor and the tendon that it pulls, in the tendon's coordinates: y is what the motor has wound up [m], T
/// the tendon's tension [N], positive where it pulls. Row `arm` of the moment-arm matrix: tension T does the
/// torque arm[j] T on joint j, and the joints wind off e = sum_j arm[j] q_j.
struct ExoMotor {
  std::string name;
  std::array<double, kJoints> arm{};  ///< [m]; not zero only at the device's joints
  double lag = 0.0;                   ///< first-order lag of the force behind the command [s] >= 0
  double force_limit = 0.0;           ///< largest force, either way [N] > 0
  bool pull_only = false;             ///< the tendon goes slack instead of pushing
  double bias = 0.0;              ///< pull_only: tension that is always held [N] >= 0; the command adds to it
  double force_constant = 1.0;    ///< tendon force per motor current [N/A] > 0
  double mass = 0.0;              ///< rotor and gear as felt at the tendon [kg] > 0
  double damping = 0.0;           ///< viscous, of rotor and gear [N s/m] >= 0
  double tendon_stiffness = 0.0;  ///< [N/m] > 0
  double tendon_damping = 0.0;    ///< [N s/m] >= 0
  double backlash = 0.0;          ///< play between winding and unwinding, full width [m] >= 0
  DryFriction sheath;             ///< between tendon and sheath, felt by the rotor
};

/// A digit that the device does not have shows the angles of one that it has:  q = q_open + gain (q_of -
/// q_of,open), joint by joint.
struct DigitCopy {
  int of = -1;        ///< digit; -1: this one stays at the open hand
  double gain = 1.0;  ///< [-] >= 0; 0: it stays at the open hand
};

/// When things happen between controller and host. The host's own rate is the scene's.
struct ExoController {
  double rate_hz = 1000.0;  ///< of the controller: sensing, and holding the command until its next tick [Hz]
  double compute_delay = 0.0;           ///< from the host's tick until its command leaves it [s] >= 0
  double return_delay = 0.0;            ///< from there until the controller has it [s] >= 0
  std::array<DigitCopy, kDigits> copy;  ///< of digits without a joint of their own
};

/// Everything about one device. The digits without a joint of their own copy (`controller.copy`); their
/// forces are recorded, never reflected to motors.
struct Exoskeleton {
  std::string name;
  std::string description;
  std::vector<ExoJoint> joints;       ///< each joint at most once
  std::vector<CoupledJoint> coupled;  ///< not among `joints`
  std::vector<ExoMotor> motors;
  ExoController controller;
};

/// @throws std::invalid_argument naming the joint or motor, the value and the remedy, if a number is not
/// finite or out of the range stated above, a joint appears twice, a motor moves no joint or one that the
/// device does not have, or a digit copies one that has no sensed joint. Set-up only.
void check_exoskeleton(const Exoskeleton& exoskeleton);

}  // namespace phalanx
