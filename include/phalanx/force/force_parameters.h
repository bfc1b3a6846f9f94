// SPDX-License-Identifier: Apache-2.0
// Parameters that determine how large a force or torque may become, and how fast it may change. S1 and S2 are
// the papers listed in docs/architecture.md.
#pragma once

#include <limits>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// Force law of one contact as a function of its depth d [m] and closing speed v = dd/dt [m/s]. Every law is
/// zero for d <= 0 and never pulls.
enum class ForceLaw {
  kHooke,            ///< F = k d                                             S1 eq. (1), S2 eq. (1)
  kKelvinVoigt,      ///< F = max(0, k d + b v)
  kHuntCrossley,     ///< F = max(0, K d^n (1 + a v)), with K such that F = k d at d = 1 mm and v = 0
  kDuffing,          ///< F = k d + k3 d^3                                    Cui (cited by S2)
  kLinearThenCubic,  ///< F = k d up to d1, then k d + k3 (d - d1)^3          Stepp (cited by S2)
  kOwn,              ///< OwnForceLaw, a function of the caller; no scene file can name it
};

/// Force law of a caller, for ForceLaw::kOwn: a plain function, and a pointer that is passed on to it.
///
/// step() calls the function for every contact with d > 0, on the thread that calls step(). It must be
/// real-time safe like step() itself: no allocation, lock, exception or I/O. Its result must depend on its
/// arguments and on constant data alone, so that equal samples give equal bits. Stabiliser::kLocalWall also
/// calls it to measure its slope.
///
/// All later stages act on the result as on that of any other law: fingertip caps, stabiliser, torque limits.
/// A result below 0 counts as 0, because no law pulls. A result that is not finite counts as 0, and the
/// step's status is kCommandNotFinite. SegmentSnapshot::force_raw then still has it.
struct OwnForceLaw {
  /// Returns the force with which the object pushes the finger out [N].
  /// @param user   OwnForceLaw::user
  /// @param depth  d [m] > 0
  /// @param speed  v = dd/dt, > 0 while the finger presses in, low-passed at velocity_lowpass_hz [m/s]
  using Function = double (*)(void* user, double depth, double speed) noexcept;

  Function function = nullptr;
  void* user = nullptr;  ///< must outlive all steps with these parameters; steps in several threads share it
};

/// Parameters of the force law.
struct ForceLawParameters {
  ForceLaw law = ForceLaw::kHooke;
  double stiffness = 500.0;             ///< k [N/m] >= 0; Hunt-Crossley: the chord stiffness F/d at d = 1 mm
  double damping = 2.0;                 ///< b [N s/m] >= 0, Kelvin-Voigt
  double velocity_lowpass_hz = 30.0;    ///< corner of the first-order low-pass on v [Hz] > 0
  double hunt_crossley_exponent = 1.5;  ///< n >= 1
  double hunt_crossley_damping = 2.0;   ///< a [s/m] >= 0
  double cubic = 5e7;                   ///< k3 [N/m^3] >= 0, Duffing and linear-then-cubic
  double linear_depth = 2e-3;           ///< d1 [m] >= 0, linear-then-cubic
  OwnForceLaw own = {};                 ///< with a function for ForceLaw::kOwn
};

/// Limits of force, torque and joint speed. Each is on by default.
struct LimitParameters {
  bool fingertip_force_enabled = true;
  double fingertip_force = 5.0;  ///< [N], of each contact and of the vector sum of a digit's contacts
  bool joint_torque_enabled = true;
  double joint_torque = 0.5;  ///< [Nm] for each joint, absolute
  bool torque_rate_enabled = true;
  double torque_rate = 10.0;  ///< [Nm/s] for each joint, absolute, from the last commanded torque
  double joint_speed = 40.0;  ///< [rad/s]; a measured angle that moves faster is slewed at this speed
};

}  // namespace phalanx
