// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace phalanx {

/// "45 s", "3 min 20 s", "5 h 12 min"
[[nodiscard]] std::string duration_text(double seconds);

/// How long work takes here that keeps one core busy for so long and is shared by all cores: not less than a
/// second. Measured on the machine of README's timings; another one is faster or slower. [s]
[[nodiscard]] double on_all_cores(double processor_seconds) noexcept;

}  // namespace phalanx
