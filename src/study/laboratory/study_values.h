// SPDX-License-Identifier: Apache-2.0
// Numbers and strings, as a study writes them.
#pragma once

#include <string>
#include <string_view>

namespace phalanx {

/// @returns the number nearest to `value` among those with 12 decimal digits: 0.3 for 0.1 + 2 x 0.1.
[[nodiscard]] double short_number(double value);

/// @returns the text as a TOML basic string, with its quotes.
[[nodiscard]] std::string toml_quoted(const std::string& text);

/// @returns the text as a field of a CSV file, in quotes if necessary (RFC 4180).
[[nodiscard]] std::string csv_text(std::string_view text);

}  // namespace phalanx
