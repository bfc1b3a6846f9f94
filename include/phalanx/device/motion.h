// SPDX-License-Identifier: Apache-2.0
// A motion of the whole hand over time: recorded, read from a file, or scripted.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/hand/angle_origin.h"
#include "phalanx/hand/hand_parameters.h"
#include "phalanx/hand/joints.h"

namespace phalanx {

/// Joint angles at increasing times. Between two keys the angles are interpolated linearly; before the first
/// and after the last key they are held.
/// @invariant at least one key; times strictly increasing and finite; angles finite (check_motion()).
struct Motion {
  std::vector<double> time_s;     ///< times of the keys [s]; the first may have any value
  std::vector<JointArray> angle;  ///< one per key [rad]
  AngleOrigins angle_origin{};    ///< for each joint, the same at all keys

  /// @returns the time from the first key to the last [s].
  [[nodiscard]] double duration() const noexcept { return time_s.back() - time_s.front(); }
  /// @returns the angles `t` seconds after the first key [rad]; NaN counts as 0.
  /// @pre the invariant. Real-time: O(log n), no allocation.
  [[nodiscard]] JointArray at(double t) const noexcept;
};

/// Checks a motion's invariant.
/// @throws std::invalid_argument naming the first key that breaks it. Set-up only.
void check_motion(const Motion& motion);

/// Adds a lead-in to a motion: from `from` to the first key in `seconds`, along a minimum-jerk profile with a
/// key every millisecond. Without it, a recording that begins with a closed hand would begin inside the
/// object. If `seconds` is 0, the motion is unchanged.
/// @param seconds  [s] finite, >= 0   @pre the motion's invariant. Set-up only.
[[nodiscard]] Motion led_in(Motion motion, const JointArray& from, double seconds);

/// @returns s(u) = 10 u^3 - 15 u^4 + 6 u^5, with u clamped to 0 .. 1.     Flash, Hogan, J.
/// Neuroscience 5(7), 1985
[[nodiscard]] double minimum_jerk(double u) noexcept;

/// Parameters of the scripted motions. Each starts at the open hand and waits `start_s`. It closes along
/// minimum_jerk() in `close_s`, holds for `hold_s`, and opens in `open_s`. The whole repeats `repeat` times.
struct ScriptedMotion {
  /// "press" (index), "pinch" (thumb and index), "tripod" (and middle), "power_grasp" (all digits), "wave"
  /// (finger after finger, from the little finger to the index), "posture" (to angles of one's own).
  std::string name = "power_grasp";
  double start_s = 0.2;  ///< wait at the open hand [s] >= 0
  double close_s = 1.0;  ///< duration of closing [s] > 0
  double hold_s = 1.0;   ///< duration of holding [s] >= 0
  double open_s = 1.0;   ///< duration of opening [s] > 0
  int repeat = 1;        ///< number of cycles >= 1
  double closure = 0.6;  ///< position of the moving joints from the open angle (0) to the end of their range
                         ///< (1); each motion weights its joints, so that 1 is a full posture of its kind
  /// Closure of each digit relative to `closure` [-] >= 0, thumb first, so that all digits meet
  /// an object alike.
  std::array<double, kDigits> digit_closure = {1.0, 1.0, 1.0, 1.0, 1.0};
  /// Angles to which "posture" takes the joints at closure 1 [rad]; a joint without one stays.
  std::array<std::optional<double>, kJoints> posture{};
  double tremor_rad = 0.0;  ///< bound of a seeded sum of sines at 5-12 Hz on every moving joint [rad] >= 0
  std::uint64_t seed = 1;   ///< seed of the tremor
  double key_rate_hz = 1000.0;  ///< rate of the keys [Hz] > 0
};

/// @returns the names that make_motion() accepts.
[[nodiscard]] const std::vector<std::string>& scripted_motion_names();

/// Makes the keys of a scripted motion for this hand; every angle lies within the hand's range of motion.
/// @throws std::invalid_argument for an unknown name (naming the nearest known one), a parameter out of
/// range, or a motion of more than two million keys. Set-up only.
[[nodiscard]] Motion make_motion(const ScriptedMotion& script, const HandParameters& hand);

}  // namespace phalanx
