// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace phalanx {

/// Largest number of parts of a dotted key or of a table's header.
constexpr std::size_t kMostKeyParts = 16;

/// Checks the depth of TOML text before it is parsed. The parser, and all code that walks its tree, use a
/// stack frame for each part of a key and each bracket. Text that is not TOML is checked as far as the parser
/// would read it.
/// @throws SceneError with file and line: a key of more than kMostKeyParts parts or 1,000 bytes, or more than
/// 16 nested brackets
void check_toml_bounds(std::string_view text, const std::string& origin);

}  // namespace phalanx
