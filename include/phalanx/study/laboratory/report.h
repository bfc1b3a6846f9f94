// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "phalanx/record/made.h"
#include "phalanx/study/laboratory/study.h"

namespace phalanx {

/// Writes heat maps and curves of a finished study as one HTML page that needs no other file.
/// @param results  one for each point, in the order of the points
[[nodiscard]] std::string study_report_html(const Study& study, const std::vector<PointResult>& results,
                                            const Made& made);

}  // namespace phalanx
