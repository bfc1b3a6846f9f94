// SPDX-License-Identifier: Apache-2.0
// The project's own files, for tests that hold rules against them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace phalanx::project {

/// Root of the source tree.
[[nodiscard]] const std::filesystem::path& root();

/// Every regular file below root()/folder with one of these extensions (all files if none is given), sorted,
/// relative to root(). A folder that does not exist has no files.
[[nodiscard]] std::vector<std::filesystem::path> files_below(const std::string& folder,
                                                             const std::vector<std::string>& extensions = {});

/// The file's lines, `file` relative to root(). @throws std::runtime_error if it cannot be read.
[[nodiscard]] std::vector<std::string> lines_of(const std::filesystem::path& file);

}  // namespace phalanx::project
