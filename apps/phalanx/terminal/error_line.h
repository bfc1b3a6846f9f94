// SPDX-License-Identifier: Apache-2.0
// Messages of a command on standard error.
#pragma once

#include <string>
#include <string_view>

#include "phalanx/core/reason.h"

namespace phalanx {

/// Writes one line to standard error, red on a terminal. Control characters in it become blanks. If standard
/// error takes nothing, that is ignored.
void print_error_line(std::string message);

/// Writes progress or other text unchanged to standard error. If it takes nothing, that is ignored.
void print_aside(std::string_view text) noexcept;

}  // namespace phalanx
