// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "phalanx/scene/scene.h"

namespace phalanx {

/// @returns changes of settings in words for people: "force.stiffness_n_per_mm = 0.8". A file has no folder,
/// a table no brackets ("objects.0 = sphere, diameter_mm 60"), and an empty value is "as in the scene". Keys
/// below a key that a later change replaces are left out.
[[nodiscard]] std::string settings_text(const Overrides& changes);

}  // namespace phalanx
