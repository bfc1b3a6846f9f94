// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace phalanx {

/// Describes why `file` is not a regular file, and the remedy.
[[nodiscard]] std::string why_no_file(const std::filesystem::path& file);

}  // namespace phalanx
