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

}  // namespace phalanx
