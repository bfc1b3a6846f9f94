// SPDX-License-Identifier: Apache-2.0
// Joint angles as a person moves them: each digit reaches from posture to posture along minimum-jerk paths
// (Flash, Hogan, "The coordination of arm movements", J. Neuroscience 5(7), 1985), the joints of a finger
// together, the digits not quite at the same time, rests in between, and a tremor of 8 to 12 Hz on top.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "phalanx/hand/hand_parameters.h"
#include "support/search_cases.h"

namespace phalanx::test {

class HumanMotion {
 public:
  HumanMotion(const HandParameters& hand, std::uint64_t seed)
      : hand_(hand), random_(seed), from_(hand.open_angle), to_(hand.open_angle) {
    for (std::size_t j = 0; j < kJoints; ++j) {
      tremor_hz_[j] = between(random_, 8.0, 12.0);
      tremor_[j] = between(random_, 0.0005, 0.003);
    }
  }

  /// The angles after another `period` [s].
  JointArray next(double period) {
    time_ += period;
    JointArray q{};
    for (int d = 0; d < kDigits; ++d) {
      const auto digit = static_cast<std::size_t>(d);
      if (time_ >= begin_[digit] + duration_[digit]) reach(d);
      const double t = std::clamp((time_ - begin_[digit]) / duration_[digit], 0.0, 1.0);
      const double share = t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
      for (int i = 0; i < kJointsPerDigit; ++i) {
        const auto j = static_cast<std::size_t>(joint_index(d, i));
        const double tremor = tremor_[j] * std::sin(2.0 * std::numbers::pi * tremor_hz_[j] * time_);
        q[j] = std::clamp(from_[j] + share * (to_[j] - from_[j]) + tremor, hand_.min_angle[j],
                          hand_.max_angle[j]);
      }
    }
    return q;
  }

 private:
  /// The digit's next posture: closed to some degree, the three hinges in proportion, now and then open.
  void reach(int d) {
    const auto digit = static_cast<std::size_t>(d);
    const bool open = between(random_, 0.0, 1.0) < 0.3;
    const double close = open ? 0.0 : between(random_, 0.2, 1.0);
    begin_[digit] = time_ + between(random_, 0.0, 0.05);
    duration_[digit] = between(random_, 0.15, 0.35);
    for (int i = 0; i < kJointsPerDigit; ++i) {
      const auto j = static_cast<std::size_t>(joint_index(d, i));
      from_[j] = to_[j];
      const double room = hand_.max_angle[j] - hand_.open_angle[j];
      to_[j] = hand_.open_angle[j] + (i == kAbductionJoint ? between(random_, -0.2, 0.2)
                                                           : 0.8 * room * close * between(random_, 0.6, 1.0));
    }
  }

  HandParameters hand_;
  Random random_;
  JointArray from_;
  JointArray to_;
  std::array<double, kDigits> begin_{};
  std::array<double, kDigits> duration_{};
  JointArray tremor_hz_{};
  JointArray tremor_{};
  double time_ = 0.0;
};

}  // namespace phalanx::test
