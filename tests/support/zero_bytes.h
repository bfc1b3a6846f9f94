// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <type_traits>

namespace phalanx::test {

/// Whether a default-initialised T holds zeros: numbers 0, flags false, pointers null. A member without a
/// default value counts as 0.
template <typename T>
[[nodiscard]] bool begins_as_zero() {
  static_assert(std::is_trivially_destructible_v<T>);
  static T fresh;  // static memory is zero before the constructor runs, also between the members
  const T* object = &fresh;
  asm volatile("" : "+r"(object) : : "memory");
  return std::ranges::all_of(std::as_bytes(std::span(object, 1)),
                             [](std::byte byte) { return byte == std::byte{}; });
}

}  // namespace phalanx::test
