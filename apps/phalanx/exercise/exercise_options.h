// SPDX-License-Identifier: Apache-2.0
// Options of `phalanx exercise run`, and the station that they ask for.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "patient/registry_options.h"
#include "phalanx/exercise/exercise.h"
#include "phalanx/scene/scene.h"
#include "phalanx/station/session.h"
#include "run/run_options.h"

namespace phalanx {

/// Options of `phalanx exercise run` on its command line.
struct ExerciseOptions {
  std::string exercise;      ///< name or file
  std::string patient = {};  ///< code; empty: no patient
  std::string confirm = {};  ///< the code again, for scripts
  std::string demo = {};     ///< skill of a simulated participant; empty: a person
  std::optional<std::uint64_t> seed = {};
  bool record_plain = false;
  /// Largest stable stiffness, as the person who answers for the device states it [N/mm]
  std::optional<double> stable_n_per_mm = {};
  RegistryOptions registry = {};
  RunOptions run = {};  ///< device, calibration, recording
};

/// @returns the scene's overrides that lower its limits to those of exercise and person: stiffness, fingertip
/// force, joint torque. A value that the scene has lower already is left out
/// @param overrides  that come before them
/// @throws SceneError as load_scene()
[[nodiscard]] Overrides lowered_limits(const std::string& scene, const Overrides& overrides,
                                       const ExerciseDescription& exercise, const PersonLimits& person);

/// @returns the largest stiffness at which the device is known to be stable [N/m]; none: not known.
/// - stated on the command line: that one
/// - sliders, which no force moves: that of the scene
/// - simulated device `beihang` without changes: 0.8 N/mm, the least that docs/stability.md has
/// measured for it
[[nodiscard]] std::optional<double> stable_stiffness(const ExerciseOptions& options,
                                                     const SceneDescription& scene);

/// @returns the person's limits, lowered to those of scene and exercise
[[nodiscard]] PersonLimits within_scene(const PersonLimits& person, SceneDescription scene,
                                        const ExerciseDescription& exercise);

/// @returns the digits with an own sensor; those that copy another digit have none
[[nodiscard]] std::array<bool, kDigits> felt_digits(const SessionInfo& info);

/// @returns ExerciseStart::conditions of a running session
/// @param calibration  file; empty: the device's own values
/// @throws SceneError if it cannot be read
[[nodiscard]] std::map<std::string, std::string> conditions_of(const SessionInfo& info,
                                                               const std::string& calibration,
                                                               const std::string& version);

}  // namespace phalanx
