// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "phalanx/record/made.h"

namespace phalanx {

/// Writes the origin of a result: commit, cpu, compiler, build_type, date.
[[nodiscard]] nlohmann::ordered_json made_json(const Made& made);

}  // namespace phalanx
