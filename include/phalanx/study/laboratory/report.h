// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "phalanx/record/made.h"
#include "phalanx/study/laboratory/study.h"

namespace phalanx {

/// Writes heat maps and curves of a study as one HTML page that needs no other file.
/// @param results  of the finished points, by index
/// @param running  progress in words, of a study that still runs: the page then loads itself again every 10 s
[[nodiscard]] std::string study_report_html(const Study& study, const std::vector<PointResult>& results,
                                            const Made& made, const std::string& running = "");

}  // namespace phalanx
