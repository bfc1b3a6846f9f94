// SPDX-License-Identifier: Apache-2.0
// What all scores demand of the observed steps of a trial.
#pragma once

#include <array>
#include <span>
#include <string>

#include "phalanx/exercise/observation.h"
#include "phalanx/hand/joints.h"

namespace phalanx {

/// One flag for each digit, from thumb to little finger.
using DigitFlags = std::array<bool, kDigits>;

/// Longest trial that is scored [s].
inline constexpr double kLongestTrial = 3600.0;

/// Checks the steps of a trial. They can be scored if there are two at least, none has a fault, and
/// their times are finite, increase strictly and span at most kLongestTrial. Each function of scores
/// calls this first.
/// @returns why they cannot be scored, for people, with the time of the first such step. Empty: they can.
/// Not real-time: it allocates.
[[nodiscard]] std::string why_not_scored(std::span<const Observation> steps);

}  // namespace phalanx
