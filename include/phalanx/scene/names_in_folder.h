// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace phalanx {

/// @returns the sorted names, without extension, of a folder's files with this extension; none if the folder
/// cannot be read. Set-up only.
[[nodiscard]] std::vector<std::string> names_in_folder(const std::filesystem::path& folder,
                                                       const std::string& extension);

}  // namespace phalanx
