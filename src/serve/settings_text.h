// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "phalanx/scene/scene.h"

namespace phalanx {

/// Changes of settings as people read them: "force.stiffness_n_per_mm = 0.8". A file is named without its
/// folder, a table without TOML's brackets ("objects.0 = sphere, diameter_mm 60"), an empty value as "as in
/// the scene". A key below one that a later change replaces is left out.
[[nodiscard]] std::string settings_text(const Overrides& changes);

}  // namespace phalanx
