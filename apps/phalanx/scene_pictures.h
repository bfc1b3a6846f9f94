// SPDX-License-Identifier: Apache-2.0
// phalanx scene pictures: every scene at the moment of its largest force, one by one and on one sheet.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace phalanx {

struct ScenePicturesOptions {
  std::vector<std::string> scenes;  ///< empty: all in scenes/
  std::filesystem::path folder;
  int width = 320;  ///< of one picture [pixels]; its height is 3/4 of it
  int columns = 4;
};

/// Writes FOLDER/NAME.png for each scene and FOLDER/scenes.png, the sheet of all; every picture has the same
/// scale of force.
/// @returns an exit code
int draw_scenes(const ScenePicturesOptions& options);

}  // namespace phalanx
