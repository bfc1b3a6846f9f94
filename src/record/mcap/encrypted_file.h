// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "record/mcap/encrypted_format.h"
#include "record/mcap/mcap_file.h"

namespace phalanx::mcap {

/// A file that is encrypted while it is written (encrypted_format.h): each write is one frame, or several
/// above kMostFrame. Only ciphertext reaches the file below. Places are those of the bytes that are written.
///
/// A write begins where one before it began or ended; what was written from there on is replaced, under
/// a new counter. So a write that failed may be repeated, with the same bytes or with others: no nonce
/// is used twice.
class EncryptedFile final : public WritableFile {
 public:
  /// Writes the head, with a new random salt. @param below  outlives this object
  /// @throws std::invalid_argument for an id that is not 32 hexadecimal digits; std::system_error if the disk
  /// refuses; std::runtime_error if OpenSSL does
  EncryptedFile(WritableFile& below, const RecordingEncryption& encryption);

  /// @throws also std::runtime_error if OpenSSL refuses, std::bad_alloc, and std::logic_error for a place
  /// within a frame
  void write(std::uint64_t place, std::string_view bytes) override;
  void synchronise() override { below_.synchronise(); }
  void truncate(std::uint64_t size) override;

 private:
  /// Beginning of a frame.
  struct Boundary {
    std::uint64_t place = 0;   ///< in what is written
    std::uint64_t stored = 0;  ///< in the file below
  };
  void back_to(std::uint64_t place);

  WritableFile& below_;
  const EncryptedHead head_;
  FrameCipher cipher_;
  std::vector<Boundary> frames_;
  Boundary end_;  ///< of the newest frame
  std::uint64_t counter_ = 0;
  Bytes frame_;
};

}  // namespace phalanx::mcap
