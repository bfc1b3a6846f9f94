// SPDX-License-Identifier: Apache-2.0
// How a study writes numbers and strings.
#pragma once

#include <string>
#include <string_view>

namespace phalanx {

/// The number nearest to `value` among those with 12 decimal digits: 0.3 for 0.1 + 2 x 0.1.
[[nodiscard]] double short_number(double value);

/// As a TOML basic string, with its quotes.
[[nodiscard]] std::string toml_quoted(const std::string& text);

/// As a field of a CSV file: in quotes if it has to be (RFC 4180).
[[nodiscard]] std::string csv_text(std::string_view text);

}  // namespace phalanx
