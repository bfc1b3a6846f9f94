// SPDX-License-Identifier: Apache-2.0
// A motion of the whole hand over time: recorded, read from a file, or scripted.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "phalanx/hand/hand_parameters.h"
#include "phalanx/hand/joints.h"

namespace phalanx {

/// Joint angles at increasing times; between two of them the angles are interpolated linearly, before the
/// first and after the last they are held.
/// @invariant at least one key; times strictly increasing and finite; angles finite (check_motion()).
struct Motion {
  std::vector<double> time_s;     ///< of the keys [s]; may start anywhere
  std::vector<JointArray> angle;  ///< one per key [rad]

  /// From the first key to the last [s].
  [[nodiscard]] double duration() const noexcept { return time_s.back() - time_s.front(); }
  /// The angles `t` seconds after the first key [rad]; a `t` that is not a number is taken as 0.
  /// @pre the invariant. Real-time: O(log n), no allocation.
  [[nodiscard]] JointArray at(double t) const noexcept;
};

/// @throws std::invalid_argument naming the first key that breaks Motion's invariant. Set-up only.
void check_motion(const Motion& motion);

/// The motion with a way to its beginning before it: from `from` to the first key in `seconds`, along a
/// minimum-jerk profile with a key every millisecond. A recording that begins with a closed hand would
/// otherwise begin inside the object. Unchanged if `seconds` is 0.
/// @param seconds  [s] finite, >= 0   @pre the motion's invariant. Set-up only.
[[nodiscard]] Motion led_in(Motion motion, const JointArray& from, double seconds);

/// s(u) = 10 u^3 - 15 u^4 + 6 u^5 for u in 0 .. 1.     Flash, Hogan, J. Neuroscience 5(7), 1985
[[nodiscard]] double minimum_jerk(double u) noexcept;

/// Parameters of the scripted motions. Each starts at the open hand, waits `start_s`, closes along a
/// minimum-jerk profile s(u) = 10 u^3 - 15 u^4 + 6 u^5 (Flash & Hogan 1985) in `close_s`, holds for `hold_s`,
/// opens in `open_s`; the whole repeats `repeat` times.
struct ScriptedMotion {
  /// "press" (index), "pinch" (thumb and index), "tripod" (and middle), "power_grasp" (all digits), "wave"
  /// (finger after finger, from the little finger to the index).
  std::string name = "power_grasp";
  double start_s = 0.2;  ///< [s] >= 0
  double close_s = 1.0;  ///< [s] > 0
  double hold_s = 1.0;   ///< [s] >= 0
  double open_s = 1.0;   ///< [s] > 0
  int repeat = 1;        ///< >= 1
  double closure =
      0.6;  ///< how far the moving joints go from the open angle (0) towards the end of their range (1);
            ///< each motion weights its joints, so that 1 is a full posture of its kind
  /// Each digit's closure relative to `closure`, thumb first, so that digits meet an object alike >= 0
  std::array<double, kDigits> digit_closure = {1.0, 1.0, 1.0, 1.0, 1.0};
  double tremor_rad = 0.0;  ///< bound of a seeded sum of sines at 5-12 Hz on every moving joint [rad] >= 0
  std::uint64_t seed = 1;   ///< of the tremor
  double key_rate_hz = 1000.0;  ///< density of the keys [Hz] > 0
};

/// The names that make_motion knows.
[[nodiscard]] const std::vector<std::string>& scripted_motion_names();

/// The keys of a scripted motion for this hand; every angle lies within the hand's range of motion.
/// @throws std::invalid_argument for an unknown name (naming the nearest known one) or a parameter out of
/// range; a motion may
///         have at most two million keys. Set-up only.
[[nodiscard]] Motion make_motion(const ScriptedMotion& script, const HandParameters& hand);

}  // namespace phalanx
