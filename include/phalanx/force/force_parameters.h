// SPDX-License-Identifier: Apache-2.0
// Every number that decides how large a force or torque may become, and how fast it may change.
#pragma once

#include <limits>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// Force of one contact as a function of its depth d [m] and closing speed v = dd/dt [m/s]. All are zero for
/// d <= 0 and never pull.
enum class ForceLaw {
  kHooke,            ///< F = k d                                             S1 eq. (1), S2 eq. (1)
  kKelvinVoigt,      ///< F = max(0, k d + b v)
  kHuntCrossley,     ///< F = max(0, k d^n (1 + a v)), k d in N at d = 1 mm:   see ForceLawParameters
  kDuffing,          ///< F = k d + k3 d^3                                    Cui (cited by S2)
  kLinearThenCubic,  ///< F = k d up to d1, then k d + k3 (d - d1)^3          Stepp (cited by S2)
};

struct ForceLawParameters {
  ForceLaw law = ForceLaw::kHooke;
  double stiffness = 500.0;             ///< k [N/m] >= 0; Hunt-Crossley: the chord stiffness F/d at d = 1 mm
  double damping = 2.0;                 ///< b [N s/m] >= 0, Kelvin-Voigt
  double velocity_lowpass_hz = 30.0;    ///< corner of the first-order low-pass on v [Hz] > 0
  double hunt_crossley_exponent = 1.5;  ///< n >= 1
  double hunt_crossley_damping = 2.0;   ///< a [s/m] >= 0
  double cubic = 5e7;                   ///< k3 [N/m^3] >= 0, Duffing and linear-then-cubic
  double linear_depth = 2e-3;           ///< d1 [m] >= 0, linear-then-cubic
};

/// S2 eq. (3)-(4): the force sent changes by at most these bounds per second.
struct SmoothingParameters {
  bool enabled = true;
  double min_rate = -20.0;  ///< [N/s] < 0; -infinity: rise-only
  double max_rate = 20.0;   ///< [N/s] > 0
};

struct LimitParameters {
  bool fingertip_force_enabled = true;
  double fingertip_force = 5.0;  ///< [N] per contact, and on the vector sum of a digit's contacts
  bool joint_torque_enabled = true;
  double joint_torque = 0.5;  ///< [Nm] per joint, absolute
  bool torque_rate_enabled = true;
  double torque_rate = 10.0;  ///< [Nm/s] per joint, absolute, against the last torque commanded
  double joint_speed = 40.0;  ///< [rad/s] a sample's angle that moves faster is slewed at this speed
};

}  // namespace phalanx
