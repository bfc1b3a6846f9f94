// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace phalanx {

/// What is no UTF-8 becomes U+FFFD, a mark for each byte: a browser refuses a whole message for one such
/// byte, and devices, file names and people's names hold any.
[[nodiscard]] std::string as_utf8(std::string_view text);

/// The same in one line, for a name: without control characters, and without those that turn the direction of
/// writing or break lines, so that it cannot pass for what stands beside it.
[[nodiscard]] std::string one_line(std::string_view text);

/// Of the characters that any file name may have: Latin letters, digits, '-' and '_'.
[[nodiscard]] constexpr bool is_plain(char c) noexcept {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
}

/// At most `bytes`, cut at a whole character of UTF-8, "..." at the end where something is missing.
/// @pre bytes >= 3
[[nodiscard]] std::string shortened(std::string text, std::size_t bytes);

/// The text with the files below a folder named from there on: "/usr/share/phalanx/scenes/x.toml:3" becomes
/// "scenes/x.toml:3".
[[nodiscard]] std::string without_folder(std::string text, const std::filesystem::path& folder);

/// A refusal without the option that a page never typed: "--set KEY=VALUE: ..." becomes "KEY=VALUE: ...".
[[nodiscard]] std::string without_option(std::string refusal);

}  // namespace phalanx
