// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace phalanx {

/// A number of something, as containers take it. `i` is not negative. Real-time safe.
constexpr std::size_t idx(int i) noexcept { return static_cast<std::size_t>(i); }

}  // namespace phalanx
