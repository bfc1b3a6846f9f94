// SPDX-License-Identifier: Apache-2.0
// phalanx scene pictures: every scene at the moment of its largest force, as single pictures and
// on one sheet.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace phalanx {

/// Options of `phalanx scene pictures`.
struct ScenePicturesOptions {
  std::vector<std::string> scenes;  ///< empty: all in scenes/
  std::string profile;              ///< of the hand; empty: the scene's own
  std::filesystem::path folder;
  int width = 320;  ///< width of one picture [pixels]; its height is 3/4 of it
  int columns = 4;
};

/// Writes FOLDER/NAME.png for each scene and FOLDER/scenes.png, the sheet of all. All pictures have the
/// same force scale.
/// @returns an exit code
int draw_scenes(const ScenePicturesOptions& options);

}  // namespace phalanx
