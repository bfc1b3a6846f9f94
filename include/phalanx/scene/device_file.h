// SPDX-License-Identifier: Apache-2.0
// Device file (TOML) <-> Exoskeleton. The format is in docs/device-file.md.
#pragma once

#include <filesystem>
#include <string>

#include "phalanx/device/exoskeleton.h"
#include "phalanx/scene/scene.h"
#include "phalanx/scene/scene_error.h"

namespace phalanx {

/// The device that a scene names, with what the scene says otherwise. Its motors are in the order of their
/// names.
/// @throws SceneError naming file and line (or the scene's line, or the override), key, value and remedy: no
/// such file, broken TOML, an unknown or a missing key, a number out of range, or what check_exoskeleton()
/// refuses. Set-up only.
[[nodiscard]] Exoskeleton load_device(const SceneDescription& scene);

/// A device file by name in assets/devices, or by path (contains `/` or ends with .toml), relative to
/// `folder`. Throws as above.
[[nodiscard]] Exoskeleton load_device_file(const std::string& name_or_path,
                                           const std::filesystem::path& folder = ".");

/// The same from text; `origin` names it in messages, a relative `base` is looked for in `folder`. For tests
/// and uploads.
[[nodiscard]] Exoskeleton parse_device(const std::string& text, const std::string& origin,
                                       const std::filesystem::path& folder = ".");

/// Every number of a device, a line each ("motors.index_pip.mass 0.75", SI, 17 digits) in an order that does
/// not depend on its file: two devices behave alike if their texts are equal. Names and descriptions are left
/// out. For fingerprints.
[[nodiscard]] std::string device_text(const Exoskeleton& exoskeleton);
/// Of the device that a scene names. Throws as load_device().
[[nodiscard]] std::string device_text(const SceneDescription& scene);

}  // namespace phalanx
