// SPDX-License-Identifier: Apache-2.0
// Files that their owner alone may read.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace phalanx::web {

/// With what leads to it; one that is there already stays as it is. @throws WebServerError
void make_secret_folder(const std::filesystem::path& folder);
/// Mode 0600 from the first byte on; whole or not at all, in place of one that is there.
/// @throws WebServerError
void write_secret_file(const std::filesystem::path& path, std::string_view text);
/// What is in one, read through the one descriptor whose owner and mode were checked.
/// @throws WebServerError  cannot be read, longer than 64 KiB, another user's (unless the system
/// administrator's), or others than its owner may read or write it
[[nodiscard]] std::string read_secret_file(const std::filesystem::path& path);
/// Mode 0600 for one that is there. @throws WebServerError
void keep_secret(const std::filesystem::path& path);

}  // namespace phalanx::web
