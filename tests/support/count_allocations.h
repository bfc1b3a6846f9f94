// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#if defined(__SANITIZE_THREAD__)
#define PHALANX_THREAD_SANITIZER
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define PHALANX_THREAD_SANITIZER
#endif
#endif

namespace phalanx::test {

/// ThreadSanitizer insists on an operator new of its own; there only malloc and its like are counted.
#ifdef PHALANX_THREAD_SANITIZER
inline constexpr bool kCountsNew = false;
#else
inline constexpr bool kCountsNew = true;
#endif

/// Calls of the global operator new in all its forms and of malloc so far, by all threads, in a program that
/// links count_allocations.cpp with -Wl,--wrap=malloc. With -Wl,--wrap=calloc,--wrap=realloc,
/// --wrap=aligned_alloc,--wrap=posix_memalign also of these. What shared libraries call by themselves in C is
/// not seen.
[[nodiscard]] std::size_t allocations() noexcept;

/// Those of the calling thread alone.
[[nodiscard]] std::size_t allocations_of_this_thread() noexcept;

/// Bytes that the calling thread has asked for so far, whether they were freed since or not.
[[nodiscard]] std::size_t bytes_of_this_thread() noexcept;

/// While it lives, one allocation of its thread fails once: malloc() and its like give nullptr, operator new
/// throws std::bad_alloc. One at a time in a thread. In a program where kCountsNew is false, operator new
/// does not fail.
class FailingAllocation {
 public:
  /// @param number  which one fails, from 1
  explicit FailingAllocation(std::size_t number) noexcept;
  FailingAllocation(const FailingAllocation&) = delete;
  FailingAllocation& operator=(const FailingAllocation&) = delete;
  ~FailingAllocation();
};

}  // namespace phalanx::test
