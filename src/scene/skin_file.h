// SPDX-License-Identifier: Apache-2.0
// A skin file: the continuous skin of a hand file's hand, as JSON.
#pragma once

#include <filesystem>

#include "phalanx/hand/hand_skin.h"

namespace phalanx {

/// Reads a skin file (docs/hands.md) into metres; the bind poses are left to the caller, who knows the hand.
/// Weights are divided by their sum, which must be within 0.001 of 1.
/// @throws SceneError naming file, element, value and remedy: no such file, larger than 16 MB, broken JSON, a
/// missing or misshapen entry, an unknown segment, an index without a vertex, a weight that is not above 0, a
/// vertex more than 300 mm from the wrist. Set-up only.
[[nodiscard]] HandSkin read_skin_file(const std::filesystem::path& file);

}  // namespace phalanx
