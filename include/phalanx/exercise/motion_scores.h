// SPDX-License-Identifier: Apache-2.0
// Scores of a trial from joint angles and pads. docs/exercises.md ("Scores") has each formula
// with its source.
//
// An angle is scored only if its origin is AngleOrigin::kMeasured in all steps: angles that follow another
// digit, are completed, fixed or scripted are "not measured". Angles in degrees also demand a calibration
// that is independent of the person's reach.
//
// All functions are pure, not real-time (they allocate), and always return the same names in the same order.
// All scores are of the origin "measured". They are invalid, with the reason in words, if why_not_scored()
// has one or a needed value is not finite.
#pragma once

#include <span>
#include <vector>

#include "phalanx/core/constants.h"
#include "phalanx/exercise/observation.h"
#include "phalanx/exercise/score.h"
#include "phalanx/exercise/scored_steps.h"

namespace phalanx {

/// Range of motion of single joints.
struct RangeOfMotion {
  std::vector<int> joints = {};          ///< numbers as in joint_name(); empty: all
  double hold_time = 0.1;                ///< an extreme counts if it is held so long; 0: each step [s]
  bool calibration_independent = false;  ///< of what the person can reach
};

/// Calculates rom_<joint>_deg, max_<joint>_deg, min_<joint>_deg of each joint: the largest and the smallest
/// held angle, and their difference.
/// @throws std::invalid_argument  for a joint that does not exist, or a number outside its range
[[nodiscard]] std::vector<Score> range_of_motion_scores(std::span<const Observation> steps,
                                                        const RangeOfMotion& task);

/// Total active motion of whole digits.
struct TotalActiveMotion {
  DigitFlags digits = {false, true, true, true, true};
  double hold_time = 0.1;                ///< as of RangeOfMotion [s]
  bool calibration_independent = false;  ///< as of RangeOfMotion
};

/// Calculates tam_<digit>_deg, flexion_<digit>_deg, deficit_<digit>_deg of each digit: the sum of flexion at
/// the fist, less the sum of the extension deficits at the open hand. MCP, PIP and DIP of a finger, MCP and
/// IP of the thumb.
/// @throws std::invalid_argument  as range_of_motion_scores()
[[nodiscard]] std::vector<Score> total_active_motion_scores(std::span<const Observation> steps,
                                                            const TotalActiveMotion& task);

/// Opposition of the thumb to fingers.
struct Opposition {
  DigitFlags fingers = {false, true, true, true, true};  ///< the thumb's flag does not count
  double hold_time = 1.0;                                ///< of opposition_held_<finger>_mm [s]
  bool calibration_independent = false;                  ///< as of RangeOfMotion
};

/// Calculates of each finger opposition_<finger>_mm, the least distance between the middles of the thumb's
/// and the finger's pad, and opposition_held_<finger>_mm, the least distance that was not exceeded for
/// hold_time. A hand that moves at random comes near, but seldom stays.
/// @throws std::invalid_argument  for no finger, or a hold_time outside 0 .. 10 s
[[nodiscard]] std::vector<Score> opposition_scores(std::span<const Observation> steps,
                                                   const Opposition& task);

/// Independence of the fingers' movements: one digit moves, the others are to stay still.
struct MotionIndependence {
  int instructed = 1;
  DigitFlags digits = {false, true, true, true, true};  ///< the instructed one among them
  double least_range = 10.0 * kDeg;  ///< of the instructed digit; below it the others have no scores [rad]
  bool calibration_independent = false;  ///< as of RangeOfMotion
};

/// Calculates instructed_range_deg; enslaving_<digit> of each other digit: its range over the instructed
/// one's; individuation_index. A digit that is not measured makes its own score and the index invalid.
/// @throws std::invalid_argument  for fewer than two digits, or without the instructed one
[[nodiscard]] std::vector<Score> motion_independence_scores(std::span<const Observation> steps,
                                                            const MotionIndependence& task);

}  // namespace phalanx
