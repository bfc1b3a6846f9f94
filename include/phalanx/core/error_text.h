// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <new>
#include <string>

namespace phalanx {

/// Returns the message of an exception for display. This is error.what(), except for std::bad_alloc, whose
/// what() only names the type: then it is "out of memory".
/// Set-up only: allocates.
[[nodiscard]] inline std::string error_text(const std::exception& error) {
  return dynamic_cast<const std::bad_alloc*>(&error) != nullptr ? "out of memory" : error.what();
}

}  // namespace phalanx
