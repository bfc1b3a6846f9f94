// SPDX-License-Identifier: Apache-2.0
// Files that only their owner may read, such as keys.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace phalanx::web {

/// Creates a folder that only its owner may read, with its parents. Leaves a folder that exists as it is.
/// @throws WebServerError if it cannot be made
void make_secret_folder(const std::filesystem::path& folder);
/// Writes a file with mode 0600 from its first byte on. Replaces a file that exists, completely or
/// not at all.
/// @throws WebServerError if it cannot be written
void write_secret_file(const std::filesystem::path& path, std::string_view text);
/// Reads a file through one descriptor, whose owner and mode it has checked.
/// @returns the content
/// @throws WebServerError if the file cannot be read, is longer than 64 KiB, or is no secret: it belongs to
/// another user (but root), or others than its owner may read or write it
[[nodiscard]] std::string read_secret_file(const std::filesystem::path& path);
/// Sets mode 0600. @throws WebServerError if it cannot be set
void restrict_to_owner(const std::filesystem::path& path);

}  // namespace phalanx::web
