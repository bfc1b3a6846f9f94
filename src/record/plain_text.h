// SPDX-License-Identifier: Apache-2.0
// Texts of people, devices and files in a form that pages and the log can show.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace phalanx {

/// @returns the text with U+FFFD for each byte that is not part of valid UTF-8. A browser refuses a whole
/// message for one such byte, and the names of devices, files and people may hold any bytes.
[[nodiscard]] std::string as_utf8(std::string_view text);

/// @returns the text as valid UTF-8 in one line, for a name. It has no control characters, and none that
/// change the direction of writing or break lines, so that a name cannot imitate the text beside it.
[[nodiscard]] std::string one_line(std::string_view text);

/// @returns true for a character that every file name may have: a Latin letter, a digit, '-' or '_'
[[nodiscard]] constexpr bool is_plain(char c) noexcept {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
}

/// @returns at most `bytes` of the text, cut between two UTF-8 characters; "..." at the end if
/// something is missing
/// @pre bytes >= 3
[[nodiscard]] std::string shortened(std::string text, std::size_t bytes);

/// @returns the text with relative names for the files in the folder: "scenes/x.toml:3" in
/// place of "/usr/share/phalanx/scenes/x.toml:3"
[[nodiscard]] std::string without_folder(std::string text, const std::filesystem::path& folder);

/// @returns a refusal without the command line option: "KEY=VALUE: ..." in place of "--set KEY=VALUE: ..."
[[nodiscard]] std::string without_option(std::string refusal);

}  // namespace phalanx
