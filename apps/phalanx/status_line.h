// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "phalanx/station/station.h"

namespace phalanx {

/// "  12.0 s  running   index 3.2  thumb 1.1 N  overruns 0  late p99.9 180 us  step p99.9 41 us". What
/// matters most stands first; what does not fit is left out.
/// @param width  columns that it may have
[[nodiscard]] std::string status_line(const StationView& view, const DeadlineStatistics& deadlines,
                                      double seconds, std::size_t width);

}  // namespace phalanx
