// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "phalanx/station/station.h"

namespace phalanx {

/// Formats the status: "  12.0 s  running   index 3.2  thumb 1.1 N  overruns 0  late p99.9 180 us  step p99.9
/// 41 us". The most important values come first; values that do not fit are left out.
/// @param width  largest number of columns
[[nodiscard]] std::string status_line(const StationView& view, const DeadlineStatistics& deadlines,
                                      double seconds, std::size_t width);

}  // namespace phalanx
