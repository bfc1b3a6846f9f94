// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace phalanx {

/// Writes one line to standard error: control characters of what was typed or read become blanks.
void print_error_line(std::string message);

}  // namespace phalanx
