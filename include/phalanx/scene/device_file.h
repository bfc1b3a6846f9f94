// SPDX-License-Identifier: Apache-2.0
// Conversion of a device file (TOML) to an Exoskeleton. docs/device-file.md describes the format.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "phalanx/device/exoskeleton.h"
#include "phalanx/scene/scene.h"

namespace phalanx {

/// Loads the device that a scene names, with the scene's overrides. Its motors are in the order
/// of their names.
/// @throws SceneError naming file and line (or the scene's line, or the override), key, value and remedy: no
/// such file, broken TOML, an unknown or a missing key, a number out of range, or a refusal of
/// check_exoskeleton(). Set-up only.
[[nodiscard]] Exoskeleton load_device(const SceneDescription& scene);

/// @returns the files that the device of a scene is read from: its own and those that they name as `base`. Throws as
/// load_device().
[[nodiscard]] std::vector<std::filesystem::path> device_files(const SceneDescription& scene);

/// Loads a device file by name in assets/devices, or by path (contains `/` or ends with .toml), relative to
/// `folder`. Throws as load_device().
[[nodiscard]] Exoskeleton load_device_file(const std::string& name_or_path,
                                           const std::filesystem::path& folder = ".");

/// Reads a device from text; `origin` names it in messages, and a relative `base` is searched in `folder`.
/// For tests and uploads.
[[nodiscard]] Exoskeleton parse_device(const std::string& text, const std::string& origin,
                                       const std::filesystem::path& folder = ".");

/// Writes every number of a device, a line each ("motors.index_pip.mass 0.75", SI, 17 digits), in an order
/// that does not depend on its file. Two devices behave alike if their texts are equal. Names and
/// descriptions are left out. For fingerprints.
[[nodiscard]] std::string device_text(const Exoskeleton& exoskeleton);
/// Writes the device that a scene names. Throws as load_device().
[[nodiscard]] std::string device_text(const SceneDescription& scene);

}  // namespace phalanx
