// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "phalanx/record/summary.h"

namespace phalanx {

/// The run in a few lines of text: what touched, the peaks, the limits that acted, warnings, step times.
[[nodiscard]] std::string summary_table(const Summary& summary);

}  // namespace phalanx
