// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace phalanx::bench {

/// Encrypts the chunks of a whole recording as a recorder writes them, decrypts them, and prints the times of
/// a frame and the bytes that are added. Nothing is written to a disk. @param rounds  over all chunks
void report_encryption(const std::filesystem::path& recording, int rounds);

}  // namespace phalanx::bench
