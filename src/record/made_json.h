// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "phalanx/record/made.h"

namespace phalanx {

/// Writes the origin of a result: commit, cpu, compiler, build_type, date.
[[nodiscard]] inline nlohmann::ordered_json made_json(const Made& made) {
  return {{"commit", made.commit},
          {"cpu", made.cpu},
          {"compiler", made.compiler},
          {"build_type", made.build_type},
          {"date", made.date}};
}

}  // namespace phalanx
