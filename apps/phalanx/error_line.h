// SPDX-License-Identifier: Apache-2.0
// What a command says on standard error when something went wrong.
#pragma once

#include <exception>
#include <string>

namespace phalanx {

/// Writes one line to standard error: control characters of what was typed or read become blanks. A standard
/// error that takes nothing changes nothing.
void print_error_line(std::string message);

/// What went wrong, for people: error.what(), and words where the C++ library or the system has only a name
/// for it: no memory, no further file descriptor or thread.
[[nodiscard]] std::string reason(const std::exception& error);

}  // namespace phalanx
