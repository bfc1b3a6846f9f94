// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace phalanx {

/// Parts of a dotted key or of a table's header.
constexpr std::size_t kMostKeyParts = 16;

/// Bounds the depth of what TOML text describes, before it is parsed: the parser, and all that walks its
/// tree, use a stack frame for each part of a key and each bracket. Text that is not TOML is looked at as far
/// as the parser would read it.
/// @throws SceneError with file and line: a key of more than kMostKeyParts parts or 1,000 bytes, or more than
/// 16 brackets within one another
void check_toml_bounds(std::string_view text, const std::string& origin);

}  // namespace phalanx
