// SPDX-License-Identifier: Apache-2.0
// phalanx hand pictures: a hand in named postures, as single pictures and on one sheet.
#pragma once

#include <filesystem>
#include <string>

#include "phalanx/scene/scene.h"

namespace phalanx {

/// Options of `phalanx hand pictures`, without those of the hand.
struct HandPicturesOptions {
  std::string postures;  ///< a name in assets/postures or a .csv file
  std::filesystem::path folder;
  int width = 240;  ///< width of one picture [pixels]; its height is 5/4 of it
  int columns = 5;
};

/// Writes FOLDER/NAME.png for each posture and FOLDER/postures.png, the sheet of all. The hand points up, and
/// the camera sees the palm from the thumb's side. Angles are drawn as stated, also beyond the hand's ranges.
/// @returns an exit code
int draw_postures(const HandDescription& hand, const HandPicturesOptions& options);

}  // namespace phalanx
