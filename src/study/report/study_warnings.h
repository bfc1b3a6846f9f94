// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "study/report/study_view.h"

namespace phalanx {

/// @returns what a reader must know before trusting the numbers: missing points, invalid runs with their
/// reasons, limits at the edge of the grid. Empty if there is nothing.
[[nodiscard]] std::vector<std::string> study_warnings(const StudyView& view);

}  // namespace phalanx
