// SPDX-License-Identifier: Apache-2.0
// Conversion of a patient file (TOML) to PatientParameters. docs/device-file.md describes the format.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "phalanx/scene/scene.h"
#include "phalanx/simulation/patient.h"

namespace phalanx {

/// Loads the patient that a scene names, with the scene's overrides.
/// @throws SceneError naming file and line (or the scene's line, or the override), key, value and remedy: no
/// such file, broken TOML, an unknown or a missing key, a number out of range, or a refusal of
/// check_patient(). Set-up only.
[[nodiscard]] PatientParameters load_patient(const SceneDescription& scene);

/// @returns the files that the patient of a scene is read from: its own and those that they name as `base`. Throws as
/// load_patient().
[[nodiscard]] std::vector<std::filesystem::path> patient_files(const SceneDescription& scene);

/// Loads a patient file by name in assets/patients, or by path (contains `/` or ends with .toml), relative to
/// `folder`. Throws as load_patient().
[[nodiscard]] PatientParameters load_patient_file(const std::string& name_or_path,
                                                  const std::filesystem::path& folder = ".");

/// Reads a patient from text; `origin` names it in messages, and a relative `base` is searched in `folder`.
/// For tests and uploads.
[[nodiscard]] PatientParameters parse_patient(const std::string& text, const std::string& origin,
                                              const std::filesystem::path& folder = ".");

/// Writes every number of a patient, a line each ("press 3", SI, 17 digits). Name and description are left
/// out. For fingerprints.
[[nodiscard]] std::string patient_text(const PatientParameters& patient);
/// Writes the patient that a scene names. Throws as load_patient().
[[nodiscard]] std::string patient_text(const SceneDescription& scene);

}  // namespace phalanx
