// SPDX-License-Identifier: Apache-2.0
// Patient file (TOML) <-> PatientParameters: the simulated patient. The format is in docs/device-file.md.
#pragma once

#include <filesystem>
#include <string>

#include "phalanx/device/patient.h"
#include "phalanx/scene/scene.h"
#include "phalanx/scene/scene_error.h"

namespace phalanx {

/// The patient that a scene names, with what the scene says otherwise.
/// @throws SceneError naming file and line (or the scene's line, or the override), key, value and remedy: no
/// such file, broken TOML, an unknown or a missing key, a number out of range, or what check_patient()
/// refuses. Set-up only.
[[nodiscard]] PatientParameters load_patient(const SceneDescription& scene);

/// A patient file by name in assets/patients, or by path (contains `/` or ends with .toml), relative to
/// `folder`. Throws as above.
[[nodiscard]] PatientParameters load_patient_file(const std::string& name_or_path,
                                                  const std::filesystem::path& folder = ".");

/// The same from text; `origin` names it in messages, a relative `base` is looked for in `folder`. For tests
/// and uploads.
[[nodiscard]] PatientParameters parse_patient(const std::string& text, const std::string& origin,
                                              const std::filesystem::path& folder = ".");

/// Every number of a patient, a line each ("press 3", SI, 17 digits). Name and description are left out. For
/// fingerprints.
[[nodiscard]] std::string patient_text(const PatientParameters& patient);
/// Of the patient that a scene names. Throws as load_patient().
[[nodiscard]] std::string patient_text(const SceneDescription& scene);

}  // namespace phalanx
