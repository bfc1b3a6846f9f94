// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "phalanx/scene/scene.h"

namespace phalanx {

/// Text of a scene file, read once. It makes the scene of any overrides without opening a file again.
class SceneFile {
 public:
  /// Reads the file. @param scene  as for load_scene()
  /// @throws SceneError if it cannot be read. Set-up only.
  explicit SceneFile(const std::string& scene);
  /// @param origin, folder  as for parse_scene()
  SceneFile(std::string text, std::string origin, std::filesystem::path folder);

  /// Reads the whole scene. It opens no file: load_device(), load_patient() and resolve() are the first to
  /// read those of the device and the patient.
  /// @throws SceneError as load_scene(), except for these two files
  [[nodiscard]] SceneDescription scene(const Overrides& overrides) const;

  /// @returns every value that the file or an override states, as TOML text, by its path
  /// ("objects.0.size_mm"). A value that is left out has its default (scene_keys()). scene() checks the
  /// values; this does not. It opens no file.
  /// @throws SceneError if the text is not TOML
  [[nodiscard]] Overrides values(const Overrides& overrides) const;

 private:
  std::string text_;
  std::string origin_;  ///< the file's path, for messages
  std::filesystem::path folder_;
};

}  // namespace phalanx
