// SPDX-License-Identifier: Apache-2.0
// The motions that are measured: seeded grasps from free space to the whole hand pressing, and a long
// squeeze.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "phalanx/step/haptic_step.h"

namespace phalanx::bench {

/// Measured joint angles, one a tick [rad], all within the range of motion.
struct BenchMotion {
  std::string name;
  std::vector<JointArray> angle;
};

inline constexpr int kGraspTicks = 400;
inline constexpr double kPressDepth = 5e-3;  ///< of the deepest segment of every digit [m]

/// A grasp of 400 ticks: from an open posture, each digit along a straight line in joint space with a
/// minimum-jerk profile of its own timing, to where its deepest segment presses kPressDepth deep (or to the
/// end of its range if the object is out of its reach). Posture and timing come from the seed alone;
/// how far each digit closes is found by playing it slowly. Set-up only.
/// @throws std::invalid_argument if the open hand touches the object.
[[nodiscard]] BenchMotion make_grasp(const HapticModel& model, const HapticParameters& parameters,
                                     std::uint64_t seed);

/// 1.5 s of closing like the grasp of that seed and opening again while every joint trembles by itself, up to
/// 9 degrees at 2 to 12 Hz: contacts come and go at all angles. Timed by themselves, and compared with the
/// peers. Set-up only.
[[nodiscard]] BenchMotion make_restless(const HapticModel& model, const HapticParameters& parameters,
                                        std::uint64_t seed);

inline constexpr int kAllDigits = -1;
/// The grasp of that seed by one digit or all of them, then 2 s in which its joints sway by up to 0.05 rad at 0.3 to 1.2
/// Hz, so that what presses slides. Set-up only.
/// @param digit  the others stay open
[[nodiscard]] BenchMotion make_slide(const HapticModel& model, const HapticParameters& parameters,
                                     std::uint64_t seed, int digit);

/// All flexion of all digits goes 0.7 of the way from the open angle to the greatest, however deep they are then, and
/// sways as in make_slide(). Set-up only.
[[nodiscard]] BenchMotion make_wrap(const HapticModel& model, std::uint64_t seed);

/// The grasp of that seed, then 4 s in which every digit twice lets go until it is up to 2 mm off the object
/// and presses again, one after another, so that the hand stays in contact all the time. Set-up only.
[[nodiscard]] BenchMotion make_squeeze(const HapticModel& model, const HapticParameters& parameters,
                                       std::uint64_t seed);

}  // namespace phalanx::bench
