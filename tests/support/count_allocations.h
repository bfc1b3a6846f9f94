// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace phalanx::test {

/// Calls of the global operator new so far, in a program that links count_allocations.cpp.
[[nodiscard]] std::size_t allocations() noexcept;

}  // namespace phalanx::test
