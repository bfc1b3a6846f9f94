// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace phalanx {

/// Whether what a page lays over a scene's key names a file other than its own uploads: pages may name what
/// is shipped (by bare names) and what they sent, not the rest of the disk, nor what lies in the working
/// directory. Reads the value as the scene's reader does, so that no way of writing it makes a difference.
/// @param uploads  folder of what pages have sent. Set-up only.
[[nodiscard]] bool names_foreign_file(const std::string& key, const std::string& value,
                                      const std::filesystem::path& uploads);

}  // namespace phalanx
