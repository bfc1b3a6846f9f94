// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "phalanx/scene/scene.h"

namespace phalanx {

/// Writes a text as a value of Overrides: a TOML string in quotes, with all necessary escapes.
/// @pre valid UTF-8; of other text no TOML can be made
[[nodiscard]] std::string toml_string(const std::string& text);

/// A scene, and every value that its file or an override states as TOML text, by its path
/// ("objects.0.size_mm"). A value that is left out has its default (scene_keys()).
struct SceneWithValues {
  SceneDescription scene;
  Overrides values;
};

/// Text of a scene file, read once. It makes the scene of any overrides without opening a file again.
class SceneFile {
 public:
  /// Reads the file. @param scene  as for load_scene()
  /// @throws SceneError if it cannot be read. Set-up only.
  explicit SceneFile(const std::string& scene);
  /// @param origin, folder  as for parse_scene()
  SceneFile(std::string text, std::string origin, std::filesystem::path folder);

  /// Reads the whole scene. It opens no file: load_device(), load_patient() and resolve() read and check those
  /// of the device and the patient.
  /// @throws SceneError as load_scene(), except for these two files
  [[nodiscard]] SceneDescription scene(const Overrides& overrides) const;

  /// Reads the whole scene with its values, as scene(). It parses the text once.
  /// @throws SceneError as scene()
  [[nodiscard]] SceneWithValues with_values(const Overrides& overrides) const;

 private:
  std::string text_;
  std::string origin_;  ///< the file's path, for messages
  std::filesystem::path folder_;
};

}  // namespace phalanx
