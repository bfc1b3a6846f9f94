// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "phalanx/record/summary.h"

namespace phalanx {

/// Formats a line for each warning; yellow if standard output is a terminal.
[[nodiscard]] std::string warning_lines(const Summary& summary);

/// Formats a run in a few lines of text: contacts, peaks, limits that acted, warnings, step times.
/// @param without_contact  follows "no segment touched the object"
[[nodiscard]] std::string summary_table(const Summary& summary, const std::string& without_contact);

/// @returns true if a segment had a contact
[[nodiscard]] bool touched(const Summary& summary);

}  // namespace phalanx
