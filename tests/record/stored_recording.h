// SPDX-License-Identifier: Apache-2.0
// The same tests for recordings that are written as they are, and for encrypted ones.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/record/recording_keys.h"
#include "record/mcap/encrypted_file.h"
#include "record/memory_file.h"

namespace phalanx::test {

/// How a test stores a recording.
enum class Stored : std::uint8_t { kPlain, kEncrypted };

inline RecordingEncryption test_encryption() {
  RecordingEncryption encryption{.id = "00112233445566778899aabbccddeeff", .key = {}};
  for (std::size_t i = 0; i < encryption.key.size(); ++i)
    encryption.key[i] = static_cast<unsigned char>(3 * i + 1);
  return encryption;
}

/// @returns a function that knows the key of test_encryption()
inline FindRecordingKey test_keys() {
  return [](const std::string& id) {
    const RecordingEncryption known = test_encryption();
    return id == known.id ? std::optional(known.key) : std::nullopt;
  };
}

/// A file in memory, and what a recording is written into.
class StoredRecording {
 public:
  explicit StoredRecording(Stored stored) {
    if (stored == Stored::kEncrypted) encrypted_.emplace(memory, test_encryption());
  }
  [[nodiscard]] mcap::WritableFile& file() {
    return encrypted_ ? static_cast<mcap::WritableFile&>(*encrypted_) : memory;
  }
  /// @returns where each write to the disk ends, the head of an encrypted file left out
  [[nodiscard]] std::vector<std::uint64_t> ends() const {
    std::vector<std::uint64_t> ends;
    for (const MemoryFile::Operation& operation : memory.operations)
      if (operation.kind == MemoryFile::Operation::kWrite)
        ends.push_back(operation.place + operation.bytes.size());
    if (encrypted_) ends.erase(ends.begin());
    return ends;
  }

  MemoryFile memory;

 private:
  std::optional<mcap::EncryptedFile> encrypted_;
};

}  // namespace phalanx::test
