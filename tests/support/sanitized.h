// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace phalanx::test {

/// A sanitizer makes everything some ten times slower: what only repeats itself, or is only larger, and takes
/// no other way through the code, is made smaller there. The release build has it whole.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
inline constexpr bool kSanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace phalanx::test
