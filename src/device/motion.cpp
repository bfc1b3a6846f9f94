// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace phalanx {

JointArray Motion::at(double t) const noexcept {
  const double time = time_s.front() + (std::isnan(t) ? 0.0 : t);
  const auto next = std::upper_bound(time_s.begin(), time_s.end(), time);
  if (next == time_s.begin()) return angle.front();
  if (next == time_s.end()) return angle.back();
  const auto i = static_cast<std::size_t>(next - time_s.begin());
  const double u = (time - time_s[i - 1]) / (time_s[i] - time_s[i - 1]);
  JointArray result;
  for (std::size_t j = 0; j < result.size(); ++j) {
    result[j] = angle[i - 1][j] + u * (angle[i][j] - angle[i - 1][j]);
  }
  return result;
}

void check_motion(const Motion& motion) {
  if (motion.time_s.empty()) throw std::invalid_argument("motion: it has no keys; give it at least one");
  if (motion.time_s.size() != motion.angle.size()) {
    throw std::invalid_argument(fmt::format("motion: {} times but {} sets of angles; give one set a time",
                                            motion.time_s.size(), motion.angle.size()));
  }
  for (std::size_t i = 0; i < motion.time_s.size(); ++i) {
    if (!std::isfinite(motion.time_s[i])) {
      throw std::invalid_argument(fmt::format("motion: key {}: time {} is not finite", i, motion.time_s[i]));
    }
    if (i > 0 && !(motion.time_s[i] > motion.time_s[i - 1])) {
      throw std::invalid_argument(
          fmt::format("motion: key {}: time {} s does not come after {} s; sort the keys", i,
                      motion.time_s[i], motion.time_s[i - 1]));
    }
    for (int joint = 0; joint < kJoints; ++joint) {
      const double value = motion.angle[i][static_cast<std::size_t>(joint)];
      if (!std::isfinite(value)) {
        throw std::invalid_argument(
            fmt::format("motion: key {}: {} = {} rad is not finite; interpolate or drop this key", i,
                        joint_name(joint), value));
      }
    }
  }
}

double minimum_jerk(double u) noexcept {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
}

Motion led_in(Motion motion, const JointArray& from, double seconds) {
  const auto keys = static_cast<std::size_t>(std::ceil(1000.0 * seconds));
  if (keys == 0) return motion;
  const JointArray to = motion.angle.front();
  const double begin = motion.time_s.front() - seconds;
  std::vector<double> time(keys);
  std::vector<JointArray> angle(keys);
  for (std::size_t i = 0; i < keys; ++i) {
    const double u = static_cast<double>(i) / static_cast<double>(keys);
    time[i] = begin + u * seconds;
    for (std::size_t j = 0; j < kJoints; ++j) angle[i][j] = from[j] + minimum_jerk(u) * (to[j] - from[j]);
  }
  motion.time_s.insert(motion.time_s.begin(), time.begin(), time.end());
  motion.angle.insert(motion.angle.begin(), angle.begin(), angle.end());
  return motion;
}

}  // namespace phalanx
