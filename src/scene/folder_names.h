// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace phalanx {

/// What stands, or does not, where a regular file is needed, and the remedy.
[[nodiscard]] std::string why_no_file(const std::filesystem::path& file);

/// The sorted names, without extension, of a folder's files with this extension; none if the folder cannot be
/// read.
[[nodiscard]] std::vector<std::string> names_in_folder(const std::filesystem::path& folder,
                                                       const std::string& extension);

}  // namespace phalanx
