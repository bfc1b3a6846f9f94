// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace phalanx {

/// Converts an index to the type that containers take. Real-time safe.
/// @pre i >= 0
constexpr std::size_t idx(int i) noexcept { return static_cast<std::size_t>(i); }

}  // namespace phalanx
