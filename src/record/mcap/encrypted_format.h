// SPDX-License-Identifier: Apache-2.0
// The bytes of an encrypted recording: a head that all can read, then frames of encrypted bytes of
// an MCAP file.
//
//   file   = head head frame...                          the head stands twice, so that one damaged byte loses nothing
//   head   = magic[8] version:u32 id[32] salt[32] check[16] crc:u32
//   frame  = mark[4] length:u32 place:u64 counter:u64 body_crc:u32 head_crc:u32  ciphertext[length] tag[16]  length:u32
//
// Numbers are little-endian. `place` is that of the frame's first byte in the MCAP file, `counter`
// increases from frame to frame and is never used twice: it is the nonce of AES-256-GCM. The tag covers the
// ciphertext and the 24 bytes from mark to counter. The keys are HKDF-SHA256(key, salt, "phalanx recording 1 "
// + id): 32 bytes of the file's key, 16 of `check`. Both checksums (CRC-32) are of what is on the disk,
// so that damage is found without a key. The length behind the tag is the one before it, for a reader that
// begins at the end.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "phalanx/record/recording_keys.h"
#include "record/mcap/mcap_bytes.h"

struct evp_cipher_ctx_st;

namespace phalanx::mcap {

inline constexpr std::string_view kEncryptedMagic{"\x89PHXE\r\n\x1a", 8};
inline constexpr std::uint32_t kEncryptedVersion = 1;
inline constexpr std::size_t kSaltBytes = 32;
inline constexpr std::size_t kCheckBytes = 16;
inline constexpr std::size_t kTagBytes = 16;
inline constexpr std::size_t kEncryptedHead =
    8 + 4 + RecordingEncryption::kIdLength + kSaltBytes + kCheckBytes + 4;  ///< one of the two [bytes]
inline constexpr std::size_t kFrameHead = 4 + 4 + 8 + 8 + 4 + 4;            ///< [bytes]
inline constexpr std::size_t kFrameExtra =
    kFrameHead + kTagBytes + 4;                         ///< of a frame beside its content [bytes]
inline constexpr std::uint32_t kMostFrame = 4U << 20U;  ///< content of a frame [bytes]
inline constexpr std::string_view kFrameMark = "PHXf";
inline constexpr std::string_view kLastFrameMark = "PHXe";  ///< its content ends as a finished MCAP file does

/// An encrypted recording whose key is not here. what() names the id and the remedy.
class NoKeyError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Head of an encrypted recording.
struct EncryptedHead {
  std::string id;
  std::array<unsigned char, kSaltBytes> salt{};
  std::array<unsigned char, kCheckBytes> check{};  ///< shows that a key is the one of this file
};

/// @returns the beginning of a file: the head, twice
[[nodiscard]] Bytes begin_of_encrypted(const EncryptedHead& head);
/// Reads the first of the two heads whose checksum is right. @param bytes  at least the first
/// 2 kEncryptedHead of the file
/// @throws McapError if both are damaged, or a newer version wrote the file
[[nodiscard]] EncryptedHead parse_encrypted_head(std::string_view bytes);
/// @returns true if a file that begins with these bytes is an encrypted recording, with a damaged head, too
[[nodiscard]] bool begins_as_encrypted(std::string_view bytes) noexcept;

/// Head of a frame.
struct FrameHead {
  std::uint32_t length = 0;   ///< of the content [bytes]
  std::uint64_t place = 0;    ///< of the content in the MCAP file
  std::uint64_t counter = 0;  ///< from 1 on
  std::uint32_t body_crc = 0;
  bool last = false;  ///< kLastFrameMark

  [[nodiscard]] std::uint64_t end() const noexcept { return place + length; }
  [[nodiscard]] std::uint64_t stored() const noexcept { return kFrameExtra + std::uint64_t{length}; }
};

/// @returns true, and the head, if the bytes begin with one whose checksum is right and whose
/// length is allowed
[[nodiscard]] bool parse_frame_head(std::string_view bytes, FrameHead& head) noexcept;

/// AES-256-GCM with the key of one file. Not for two threads at once.
class FrameCipher {
 public:
  /// Derives the key of the file from its id and salt. check() shows whether the key is the one of the file.
  /// @throws std::runtime_error if OpenSSL refuses
  FrameCipher(const EncryptedHead& head, const RecordingKey& key);
  FrameCipher(const FrameCipher&) = delete;
  FrameCipher& operator=(const FrameCipher&) = delete;
  ~FrameCipher();

  [[nodiscard]] const std::array<unsigned char, kCheckBytes>& check() const noexcept { return check_; }
  /// Writes a whole frame into `out`, in place of what is there. @throws std::runtime_error if
  /// OpenSSL refuses; std::bad_alloc
  void encrypt(const FrameHead& head, std::string_view content, Bytes& out);
  /// Decrypts a whole frame, as it is on the disk, into `content`. @returns false if its tag is wrong;
  /// `content` is empty then
  [[nodiscard]] bool decrypt(std::string_view frame, std::string& content);

 private:
  std::array<unsigned char, 32> key_{};
  std::array<unsigned char, kCheckBytes> check_{};
  evp_cipher_ctx_st* context_;
};

/// Fills in random bytes of the operating system. @throws std::runtime_error if there are none
void fill_randomly(unsigned char* bytes, std::size_t count);

/// @returns true for 32 hexadecimal digits in lower case
[[nodiscard]] bool is_key_id(std::string_view id) noexcept;

}  // namespace phalanx::mcap
