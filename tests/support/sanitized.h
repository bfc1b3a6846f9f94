// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace phalanx::test {

/// The code runs under a sanitizer, whose allocator takes the place of malloc.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
inline constexpr bool kSanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool kSanitized = false;
#endif

/// A sanitizer, or the counting of executed lines (preset `coverage`), makes everything some ten times slower: what
/// only repeats itself, or is only larger, and takes no other way through the code, is made smaller there. The
/// release build has it whole.
#if defined(PHALANX_COVERAGE)
inline constexpr bool kSlowBuild = true;
#else
inline constexpr bool kSlowBuild = kSanitized;
#endif

}  // namespace phalanx::test
