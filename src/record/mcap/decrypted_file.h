// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "record/mcap/encrypted_format.h"
#include "record/mcap/stored_bytes.h"

namespace phalanx::mcap {

/// What a reader does with a part of an encrypted file that cannot be decrypted.
enum class Unreadable {
  kRefused,  ///< a read of it throws
  kFilled,   ///< a read of it gives bytes that are no MCAP record, so that a repair goes on behind it
};

/// A frame of an encrypted file, as its head says.
struct Frame {
  std::uint64_t stored = 0;  ///< its place in the encrypted file
  FrameHead head;
};

/// Finds the frames of an encrypted file from its beginning, in their order. A frame that is repeated,
/// moved or replaced by an older one is left out; so is what has no readable head. No key is needed, and no
/// frame is decrypted.
class FrameWalk {
 public:
  explicit FrameWalk(const StoredBytes& file) : file_(file) {}

  /// @returns false at the end of the file
  [[nodiscard]] bool next(Frame& frame);
  /// @returns what was left out so far; places are those of the encrypted file
  [[nodiscard]] const std::vector<Damage>& damages() const noexcept { return damages_; }

 private:
  [[nodiscard]] bool read_head(std::uint64_t place, FrameHead& head);
  [[nodiscard]] std::uint64_t next_head(std::uint64_t place);
  void damaged(std::uint64_t place, std::uint64_t length, std::string what);

  const StoredBytes& file_;
  std::uint64_t at_ = 2 * kEncryptedHead;
  std::uint64_t place_ = 0;    ///< where the next frame's content belongs
  std::uint64_t counter_ = 0;  ///< of the newest frame
  std::vector<Damage> damages_;
  std::string block_;
};

/// @returns the last frame of a file, found from its end; none: the end is torn or damaged
[[nodiscard]] std::optional<Frame> last_frame(const StoredBytes& file);

/// The bytes of an MCAP file that lie encrypted in another. Frames are decrypted when they are read; the
/// newest is kept. Not for two threads at once.
class DecryptedFile {
 public:
  /// @param file  outlives this object
  /// @throws NoKeyError if `keys` does not have the key, or has another under the id; McapError if the
  /// head is damaged
  DecryptedFile(const StoredBytes& file, const FindRecordingKey& keys, Unreadable unreadable);

  /// @returns the bytes up to the end of the last frame; a torn frame behind it does not count
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
  /// Reads as StoredBytes::read(). @throws McapError naming the place if a frame cannot be
  /// decrypted, and std::system_error
  void read(std::uint64_t place, std::uint64_t length, std::string& out);
  [[nodiscard]] const std::string& id() const noexcept { return head_.id; }
  /// @returns the parts of the encrypted file that could not be decrypted so far, in their order
  [[nodiscard]] std::vector<Damage> damages() const;

 private:
  [[nodiscard]] const Frame* frame_at(std::uint64_t place);
  [[nodiscard]] bool load(const Frame& frame);
  [[noreturn]] void refuse(std::uint64_t place) const;

  const StoredBytes& file_;
  const Unreadable unreadable_;
  const EncryptedHead head_;
  std::optional<FrameCipher> cipher_;
  FrameWalk walk_;
  bool walked_ = false;        ///< all frames are in `frames_`
  std::vector<Frame> frames_;  ///< up to the newest that was needed
  std::optional<Frame> last_;  ///< found from the end
  std::uint64_t size_ = 0;
  std::uint64_t loaded_ = 0;  ///< place of the frame in `content_`; 0: none
  std::string content_;
  std::string stored_;
  std::map<std::uint64_t, std::uint64_t> failed_;  ///< places and lengths of frames whose tag is wrong
};

/// What an encrypted file says without its key.
struct EncryptedSummary {
  std::string id;
  bool has_end = false;  ///< its last frame ends as a finished MCAP file does
};
/// @returns none if the file is not encrypted. @throws McapError if its head is damaged
[[nodiscard]] std::optional<EncryptedSummary> summarise_encrypted(const StoredBytes& file);

/// @returns true if the file begins as an encrypted recording
[[nodiscard]] bool is_encrypted(const StoredBytes& file);

}  // namespace phalanx::mcap
