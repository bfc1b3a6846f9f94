// SPDX-License-Identifier: Apache-2.0
// Observed steps for tests of scores, and how to read a list of scores.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/exercise/observation.h"
#include "phalanx/exercise/score.h"
#include "phalanx/exercise/scored_steps.h"

namespace phalanx::test {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr DigitFlags kAllFelt = {true, true, true, true, true};
inline constexpr DigitFlags kIndexOnly = {false, true, false, false, false};

/// A step of a station that runs: all angles are measured and 0, no force, no force sensor.
inline Observation running_step(double time) {
  Observation step;
  step.time = time;
  step.sample_time = time;
  step.torque_on = true;
  step.factor = 1.0;
  step.angle_origin.fill(AngleOrigin::kMeasured);
  step.pad.fill(Vec3::Zero());
  step.measured_force.fill(kNaN);
  step.sent_stiffness.fill(kNaN);
  step.depth.fill(kNaN);
  step.stiffness = 500.0;
  return step;
}

/// Steps at `interval`, in each of which `set(step, value)` has been called with the next value.
template <typename Set>
std::vector<Observation> steps_with(double interval, std::initializer_list<double> values, const Set& set) {
  std::vector<Observation> steps;
  for (const double value : values) {
    steps.push_back(running_step(interval * static_cast<double>(steps.size())));
    steps.back().tick = steps.size();
    set(steps.back(), value);
  }
  return steps;
}

/// Steps in which a digit has these forces [N].
inline std::vector<Observation> steps_with_force(double interval, std::initializer_list<double> forces,
                                                 int digit = 1) {
  return steps_with(interval, forces,
                    [&](Observation& step, double force) { step.force[idx(digit)] = force; });
}

inline const Score& score_of(const std::vector<Score>& scores, std::string_view name) {
  for (const Score& score : scores)
    if (score.name == name) return score;
  ADD_FAILURE() << "there is no score " << name;
  static const Score none;
  return none;
}

inline double value_of(const std::vector<Score>& scores, std::string_view name) {
  const Score& score = score_of(scores, name);
  EXPECT_TRUE(score.valid()) << name << ": " << score.invalid;
  return score.value;
}

inline std::string reason_of(const std::vector<Score>& scores, std::string_view name) {
  return score_of(scores, name).invalid;
}

/// Expects that no score has a value, and that each states this reason.
inline void expect_none(const std::vector<Score>& scores, std::string_view reason) {
  EXPECT_FALSE(scores.empty());
  for (const Score& score : scores) {
    EXPECT_NE(score.invalid.find(reason), std::string::npos)
        << score.name << " = " << score.value << ", \"" << score.invalid << "\" instead of \"" << reason
        << '"';
    EXPECT_TRUE(std::isnan(score.value)) << score.name;
  }
}

}  // namespace phalanx::test
