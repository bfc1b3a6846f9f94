// SPDX-License-Identifier: Apache-2.0
// The keys of encrypted recordings (docs/recording.md#encrypted-recordings).
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

namespace phalanx {

/// Key of one person's recordings: 256 random bits. Each file derives a key of its own from it.
using RecordingKey = std::array<unsigned char, 32>;

/// Finds the key of a recording by the id that its file states: 32 hexadecimal digits, a random number of the
/// person. It returns none for an id that it does not know. An empty function has no keys. Readers pass on
/// what it throws.
using FindRecordingKey = std::function<std::optional<RecordingKey>(const std::string& id)>;

/// Key that a recording is written with.
struct RecordingEncryption {
  std::string id;    ///< 32 hexadecimal digits, lower case; it stands in the file for all to read
  RecordingKey key;  ///< of that id

  static constexpr std::size_t kIdLength = 32;  ///< [characters]
};

}  // namespace phalanx
