// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "record/mcap/mcap_file.h"
#include "record/mcap/mcap_reader.h"

namespace phalanx::mcap {

/// A part of a file that could not be read.
struct Damage {
  std::uint64_t place = 0;
  std::uint64_t length = 0;  ///< [bytes]
  std::string what;
};

/// Result of repair().
struct Repaired {
  Summary summary;              ///< of the new file
  std::vector<Damage> damages;  ///< parts of the old file that are not in the new one, in their order
  bool had_end = false;         ///< the old file ended as it should
};

/// Writes a whole file of all that is whole in `from`: schemas, channels, metadata and every chunk whose checksum is right,
/// also behind a part that is not; then a summary and an end. A chunk whose compression is not known (an encrypted one) is
/// kept as it is, with its indexes: no key is needed. The checksums of all chunks are calculated, in memory for one of them.
/// @throws McapError if `from` does not begin as an MCAP file; std::system_error if `to` cannot be written
Repaired repair(const ReadableFile& from, WritableFile& to);

}  // namespace phalanx::mcap
