// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "record/mcap/mcap_file.h"
#include "record/mcap/mcap_reader.h"
#include "record/mcap/stored_bytes.h"

namespace phalanx::mcap {

/// Result of repair().
struct Repaired {
  Summary summary;              ///< of the new file
  std::vector<Damage> damages;  ///< parts of the old file that are not in the new one, in their order
  bool had_end = false;         ///< the old file ended as it should
};

/// Writes a whole file of all that is whole in `from`: schemas, channels, metadata and every chunk whose checksum is right,
/// also behind a part that is not; then a summary and an end. A chunk whose compression is not known (an encrypted one) is
/// kept as it is, with its indexes: no key is needed. The checksums of all chunks are calculated, in memory for one of them.
/// @param from  if it is encrypted, opened with Unreadable::kFilled
/// @throws McapError if `from` does not begin as an MCAP file; std::system_error if `to` cannot be written
Repaired repair(const ReadableFile& from, WritableFile& to);

/// Result of keep_whole_frames().
struct KeptFrames {
  std::uint64_t frames = 0;     ///< that were kept
  std::vector<Damage> damages;  ///< parts of the encrypted file that are not in the new one, in their order
  bool had_end = false;         ///< the last frame ends as a finished MCAP file does
};

/// Writes an encrypted file of all frames of another whose checksum is right, in their order and with the same head. No key is
/// needed, and nothing is decrypted.
/// @throws McapError if `from` is not encrypted, or its head is damaged; std::system_error if `to` cannot be written
KeptFrames keep_whole_frames(const StoredBytes& from, WritableFile& to);

}  // namespace phalanx::mcap
