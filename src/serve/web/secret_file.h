// SPDX-License-Identifier: Apache-2.0
// Files that their owner alone may read.
#pragma once

#include <filesystem>
#include <string_view>

namespace phalanx::web {

/// With what leads to it; one that is there already stays as it is. @throws std::runtime_error
void make_secret_folder(const std::filesystem::path& folder);
/// Mode 0600 from the first byte on; whole or not at all, in place of one that is there.
/// @throws std::runtime_error
void write_secret_file(const std::filesystem::path& path, std::string_view text);
/// Mode 0600 for one that is there. @throws std::runtime_error
void keep_secret(const std::filesystem::path& path);

}  // namespace phalanx::web
