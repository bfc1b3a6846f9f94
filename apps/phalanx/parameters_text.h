// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "phalanx/scene/scene.h"

namespace phalanx {

/// Writes law, stabiliser, cap, rate and length of a run on one line, for plots.
[[nodiscard]] std::string parameters_text(const SceneDescription& scene, std::uint64_t ticks);

}  // namespace phalanx
