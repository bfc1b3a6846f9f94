// SPDX-License-Identifier: Apache-2.0
// A skin file: the continuous skin of a hand file's hand, as JSON.
#pragma once

#include <filesystem>

#include "phalanx/hand/hand_skin.h"

namespace phalanx {

/// Reads a skin file (docs/hands.md) into metres. The caller, who knows the hand, sets the bind poses.
/// Weights are divided by their sum, which must be within 0.001 of 1.
/// @throws SceneError naming file, element, value and remedy. It refuses a missing file, one larger than 16
/// MB, broken JSON, and a missing or malformed entry. It refuses an unknown segment, an index without a
/// vertex, and a weight that is not above 0. It also refuses a vertex more than 300 mm from the
/// wrist. Set-up only.
[[nodiscard]] HandSkin read_skin_file(const std::filesystem::path& file);

}  // namespace phalanx
