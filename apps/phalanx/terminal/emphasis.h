// SPDX-License-Identifier: Apache-2.0
// Colour, bold type and control sequences on terminals. The other files of this folder write messages
// (error_line.h), progress (progress.h) and lines that nothing waits for (line_writer.h), and read what is typed
// (typed_lines.h) and the signals that ask a command to end (end_signals.h).
#pragma once

#include <string>

namespace phalanx {

/// Emphasis of a text.
enum class Emphasis {
  kStrong,   ///< bold: an address, a verdict
  kWarning,  ///< yellow
  kError,    ///< red
};

/// @returns true if the descriptor is a terminal that takes control sequences (ECMA-48): the environment's
/// TERM is set and not "dumb"
[[nodiscard]] bool takes_sequences(int descriptor);
/// @returns true if it takes them, and the environment's NO_COLOR is not set or empty (https://no-color.org)
[[nodiscard]] bool takes_colour(int descriptor);

/// Adds the control sequences of an emphasis.
/// @param colour  takes_colour() of the output; false: the text stays unchanged
[[nodiscard]] std::string emphasised(Emphasis emphasis, const std::string& text, bool colour);

}  // namespace phalanx
