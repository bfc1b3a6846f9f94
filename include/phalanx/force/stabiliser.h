// SPDX-License-Identifier: Apache-2.0
// What keeps the loop through device and finger calm: nine ways from the law's force to the force sent, and
// none. docs/stabilisers.md compares them.
#pragma once

#include <numbers>

#include "phalanx/force/force_parameters.h"

namespace phalanx {

enum class Stabiliser {
  kNone,             ///< the law's force as it is
  kSmoothing,        ///< its change is bounded; smoothing.enabled = false: none   S2 eq. (3)-(4)
  kRiseOnly,         ///< only its rise is bounded: S2 eq. (3)-(4) with dF_min = -infinity
  kDirection,        ///< the turn of its direction is bounded                 Burdea 1996
  kLowPass,          ///< first-order low-pass
  kKelvinVoigt,      ///< a damper beside the law                              Colgate, Schenkel 1997
  kVirtualCoupling,  ///< a spring and damper between device and wall          Colgate, Stanley, Brown 1995
  kPassivity,        ///< a damper that acts where the contact made energy     Hannaford, Ryu 2002
  kEnergyBounding,   ///< force over displacement bounded by the device's damping            Kim, Ryu 2010
  kLocalWall,        ///< the law's force, and a plane for the device's own controller
};

struct StabiliserParameters {
  Stabiliser method = Stabiliser::kSmoothing;
  double lowpass_hz = 3.0;                           ///< f [Hz] > 0, low-pass
  double damping = 4.0;                              ///< b [N s/m] >= 0, Kelvin-Voigt
  double turn_rate = 90.0 * std::numbers::pi / 180;  ///< [rad/s] > 0, direction
  double coupling_stiffness = 1000.0;                ///< Kc [N/m] > 0, virtual coupling
  double coupling_damping = 4.0;                     ///< Bc [N s/m] >= 0, virtual coupling
  double passivity_damping_max = 10.0;               ///< largest a [N s/m] >= 0, passivity
  double device_damping = 1.6;                       ///< b of the device [N s/m] >= 0, energy bounding
  double wall_valid = 14e-3;                         ///< how long a local wall may be used [s] > 0
};
inline constexpr StabiliserParameters kDefaultStabiliser{};

/// What a stabiliser remembers of one contact beside the force it sent. Zero where nothing touches.
struct StabiliserMemory {
  double proxy = 0.0;     ///< xp, depth of the virtual coupling's proxy in the wall [m]
  double energy = 0.0;    ///< E, what the finger has put into the contact less what it got back [J]
  bool touching = false;  ///< the contact pressed at the last step
};

/// One contact at one step.
struct StabiliserInput {
  double force = 0.0;      ///< F, the law's force after the caps [N] >= 0
  double depth = 0.0;      ///< d into the object [m]; the contact may be there before it is deep: then <= 0
  double speed = 0.0;      ///< dd/dt > 0 pressing in, low-passed at force.velocity_lowpass_hz [m/s]
  double speed_now = 0.0;  ///< the same of this step alone, not filtered [m/s]
  double sent = 0.0;       ///< F', the force sent at the last step, after the caps [N] >= 0
  bool pressing = false;   ///< there is a contact and its forces count
  double period = 0.005;   ///< T of one step [s] > 0
};

/// The magnitude that the method sends.
/// Where nothing presses, smoothing decays at its lower bound and the low-pass exponentially; all others send
/// 0 at once and forget.
/// @returns [N] finite and >= 0 whatever arrives, for finite parameters in range; methods that add to the
/// law's force may exceed the caps, which the caller applies once more
/// Real-time: O(1), no allocation, lock, throw or I/O.
[[nodiscard]] double stabilised_force(const StabiliserParameters& parameters,
                                      const SmoothingParameters& smoothing, const StabiliserInput& input,
                                      StabiliserMemory& memory) noexcept;

/// Whether the method itself keeps a contact's force at or below the larger of the law's and the last one.
[[nodiscard]] constexpr bool keeps_below_law(Stabiliser method) noexcept {
  return method != Stabiliser::kKelvinVoigt && method != Stabiliser::kPassivity &&
         method != Stabiliser::kEnergyBounding;
}

}  // namespace phalanx
