// SPDX-License-Identifier: Apache-2.0
// Reading a file whole, and what to do about one that cannot be read.
#pragma once

#include <filesystem>
#include <string>

namespace phalanx {

/// Reads the text of a file. Does not wait for a named pipe.
/// @param what  "scene", "hand": names the file in messages
/// @throws SceneError if it is not a regular file, cannot be read, or is larger than 16 MB, which no valid
/// TOML file of the program is.
[[nodiscard]] std::string read_text_file(const std::string& path, const std::string& what);

/// Describes why `file` is not a regular file, and the remedy.
[[nodiscard]] std::string why_no_file(const std::filesystem::path& file);

}  // namespace phalanx
