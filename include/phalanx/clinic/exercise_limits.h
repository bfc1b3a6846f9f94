// SPDX-License-Identifier: Apache-2.0
// Limits of an exercise on a station, and the conditions under which it is carried out.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>

#include "phalanx/exercise/exercise.h"
#include "phalanx/scene/scene.h"
#include "phalanx/station/session.h"

namespace phalanx {

/// @returns the scene's overrides that lower its limits to those of exercise and person: stiffness, fingertip
/// force, joint torque. A value that the scene has lower already is left out
/// @param overrides  that come before them
/// @throws SceneError as load_scene()
[[nodiscard]] Overrides lowered_limits(const std::string& scene, const Overrides& overrides,
                                       const ExerciseDescription& exercise, const PersonLimits& person);

/// What is known of a device's stability.
struct KnownStability {
  std::optional<double> stated = {};  ///< by the person who answers for the device [N/m]
  bool sliders = false;               ///< sliders move the hand, which no force moves
  bool simulated = false;             ///< simulated device of this program
};

/// @returns the largest stiffness at which the device is known to be stable [N/m]; none: not known.
/// - stated: that one
/// - sliders: that of the scene
/// - simulated device `beihang` without changes: 0.8 N/mm, the least that docs/stability.md has
/// measured for it
[[nodiscard]] std::optional<double> stable_stiffness(const KnownStability& known,
                                                     const SceneDescription& scene);

/// @returns the person's limits, lowered to those of scene and exercise
[[nodiscard]] PersonLimits within_scene(const PersonLimits& person, SceneDescription scene,
                                        const ExerciseDescription& exercise);

/// @returns the digits with an own sensor; those that copy another digit have none
[[nodiscard]] std::array<bool, kDigits> felt_digits(const SessionInfo& info);

/// Reads how a calibration was made. @param file  empty: the device's own values
/// @returns its methods, joined by "+", or "none" without a file
/// @throws SceneError if it cannot be read
[[nodiscard]] std::string methods_of_calibration(const std::string& file);

/// @returns ExerciseStart::conditions of a running session; `rendering` is kRenderingVersion
/// @param methods  methods_of_calibration()
[[nodiscard]] std::map<std::string, std::string> conditions_of(const SessionInfo& info,
                                                               const std::string& methods);

}  // namespace phalanx
