// SPDX-License-Identifier: Apache-2.0
// Selection of a stabiliser, which keeps the loop through device and finger stable: none, one of nine methods
// from the law's force to the force sent, or a function of the caller. docs/stabilisers.md compares them and
// names their sources. S2 is a paper listed in docs/architecture.md.
#pragma once

#include <array>
#include <numbers>

#include "phalanx/core/status.h"

namespace phalanx {

struct StabiliserInput;
struct StabiliserMemory;

/// Method that changes the law's force to keep the loop stable.
enum class Stabiliser {
  kNone,             ///< the law's force as it is
  kSmoothing,        ///< its change is bounded                                S2 eq. (3)-(4)
  kRiseOnly,         ///< only its rise is bounded, as with dF_min = -infinity
  kDirection,        ///< the turn of its direction is bounded                 Burdea 1996
  kLowPass,          ///< first-order low-pass
  kKelvinVoigt,      ///< a damper in parallel to the law                      Colgate, Schenkel 1997
  kVirtualCoupling,  ///< a spring and damper between device and wall          Colgate, Stanley, Brown 1995
  kPassivity,        ///< a damper that acts if the contact generated energy   Hannaford, Ryu 2002
  kEnergyBounding,   ///< force over displacement bounded by the device's damping            Kim, Ryu 2010
  kLocalWall,        ///< the law's force as it is, and a plane for the device's own controller
  kOwn,              ///< OwnStabiliser, a function of the caller; no scene file can name it
};

/// Stabiliser of a caller, for Stabiliser::kOwn: a plain function, and a pointer that is passed on to it.
///
/// step() calls the function for every contact that presses, on the thread that calls step(). It must be
/// real-time safe like step() itself: no allocation, lock, exception or I/O. Its result must depend on its
/// arguments and on constant data alone, so that equal samples give equal bits. All state belongs into
/// `memory`: where a fingertip cap acts, a step calls the function once more with a copy of it.
///
/// Fingertip caps, torque limit and torque-rate limit act on the result. A result below 0 counts as 0. A
/// result that is not finite counts as 0, resets the memory, and the step's status is kCommandNotFinite.
/// Without contact the force is 0 at once; the torque-rate limit still bounds how fast the torque falls.
struct OwnStabiliser {
  /// Returns the force that is sent [N].
  /// @param user    OwnStabiliser::user
  /// @param input   of this contact and step; all values are finite, and `force` and `sent` not below 0
  /// @param memory  of this contact; zero when it begins. StabiliserMemory::own is the function's.
  using Function = double (*)(void* user, const StabiliserInput& input, StabiliserMemory& memory) noexcept;

  Function function = nullptr;
  void* user = nullptr;  ///< must outlive all steps with these parameters; steps in several threads share it
};

/// Parameters of the stabilisers. Each method uses its own.
struct StabiliserParameters {
  Stabiliser method = Stabiliser::kRiseOnly;
  double min_rate = -20.0;  ///< fastest fall of the force [N/s] < 0, smoothing; -infinity: no bound
  double max_rate = 20.0;   ///< fastest rise of the force [N/s] > 0, smoothing and rise-only
  double lowpass_hz = 3.0;  ///< f [Hz] > 0, low-pass
  double damping = 4.0;     ///< b [N s/m] >= 0, Kelvin-Voigt
  double turn_rate = 90.0 * std::numbers::pi / 180;  ///< [rad/s] > 0, direction
  double coupling_stiffness = 1000.0;                ///< Kc [N/m] > 0, virtual coupling
  double coupling_damping = 4.0;                     ///< Bc [N s/m] >= 0, virtual coupling
  double passivity_damping_max = 10.0;               ///< largest a [N s/m] >= 0, passivity
  double device_damping = 1.6;                       ///< b of the device [N s/m] >= 0, energy bounding
  double wall_valid = 14e-3;                         ///< time for which a local wall may be used [s] > 0
  OwnStabiliser own = {};                            ///< with a function for Stabiliser::kOwn
};

/// State of a stabiliser for one contact, beside the force sent. Zero while nothing touches.
struct StabiliserMemory {
  double proxy = 0.0;           ///< xp, depth of the virtual coupling's proxy in the wall [m]
  double energy = 0.0;          ///< E, energy that the finger has put in less what it got back [J]
  bool touching = false;        ///< the contact pressed at the last step
  std::array<double, 4> own{};  ///< state of an OwnStabiliser
};

/// Inputs of a stabiliser for one contact at one step.
struct StabiliserInput {
  double force = 0.0;      ///< F, the law's force after the caps [N] >= 0
  double depth = 0.0;      ///< d into the object [m]; <= 0 if the contact exists but is not deep
  double speed = 0.0;      ///< dd/dt, > 0 pressing in, low-passed at force.velocity_lowpass_hz [m/s]
  double speed_now = 0.0;  ///< the same over this step alone, unfiltered [m/s]
  double sent = 0.0;       ///< F', the force sent at the last step, after the caps [N] >= 0
  bool pressing = false;   ///< the contact exists and its forces count
  double period = 0.005;   ///< T of one step [s] > 0
};

/// Returns the magnitude that the method sends [N]. If nothing presses, smoothing decays at its lower bound,
/// and the low-pass decays exponentially. All other methods then send 0 and reset their memory.
/// @param status  gets kCommandNotFinite if the method's result was not finite; null: not reported
/// @returns [N] finite and >= 0 for any input, if the parameters are finite and in range. Methods that add to
/// the law's force may exceed the caps, so that the caller applies the caps again.
/// Real-time: O(1), no allocation, lock, throw or I/O.
[[nodiscard]] double stabilised_force(const StabiliserParameters& parameters, const StabiliserInput& input,
                                      StabiliserMemory& memory, Status* status = nullptr) noexcept;

/// @returns true if the method keeps a contact's force at or below the larger of the law's and the last one
[[nodiscard]] constexpr bool keeps_below_law(Stabiliser method) noexcept {
  return method != Stabiliser::kKelvinVoigt && method != Stabiliser::kPassivity &&
         method != Stabiliser::kEnergyBounding && method != Stabiliser::kOwn;
}

}  // namespace phalanx
