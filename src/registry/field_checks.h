// SPDX-License-Identifier: Apache-2.0
// Checks of single fields: texts, dates, numbers.
#pragma once

#include <string>
#include <string_view>

namespace phalanx::registry {

/// Checks a text's length, and that it is UTF-8 without control characters but '\n' and '\t'.
/// @throws std::invalid_argument naming the field
void check_text(std::string_view field, const std::string& text, std::size_t longest);
/// Calls check_text(), and refuses '@' and words for a birth date. @throws likewise
void check_anonymous(std::string_view field, const std::string& text, std::size_t longest);
/// Checks "2026-05-04", or an empty text if `optional`. @throws likewise
void check_date(std::string_view field, const std::string& text, bool optional);
/// @throws likewise if a number is not in [least, largest]
void check_number(std::string_view field, double value, double least, double largest);
/// @returns true for a day of the Gregorian calendar, 1900 to 2200
[[nodiscard]] bool is_day(int year, int month, int day) noexcept;
/// @returns 1 to `longest` of the given characters, as "A-Z" and single ones
[[nodiscard]] bool has_only(const std::string& text, std::string_view characters,
                            std::size_t longest) noexcept;

/// @returns UTC as "2026-05-04T09:30:00Z". @param utc  [s since 1970]
[[nodiscard]] std::string utc_text(double utc);
/// @returns the begin of a day "2026-05-04" [s since 1970]; 0 for another text
[[nodiscard]] double utc_of_day(const std::string& day) noexcept;

}  // namespace phalanx::registry
