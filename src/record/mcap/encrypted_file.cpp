// SPDX-License-Identifier: Apache-2.0
#include "record/mcap/encrypted_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace phalanx::mcap {
namespace {

/// @returns a head with a new salt and the check of its key
EncryptedHead new_head(const RecordingEncryption& encryption) {
  if (!is_key_id(encryption.id))
    throw std::invalid_argument(fmt::format(
        "the id '{}' of a recording's key is not 32 hexadecimal digits in lower case", encryption.id));
  EncryptedHead head;
  head.id = encryption.id;
  fill_randomly(head.salt.data(), head.salt.size());
  head.check = FrameCipher(head, encryption.key).check();
  return head;
}

}  // namespace

EncryptedFile::EncryptedFile(WritableFile& below, const RecordingEncryption& encryption)
    : below_(below), head_(new_head(encryption)), cipher_(head_, encryption.key) {
  const Bytes head = begin_of_encrypted(head_);
  below_.write(0, view_of(head));
  end_.stored = head.size();
}

void EncryptedFile::write(std::uint64_t place, std::string_view bytes) {
  back_to(place);
  while (!bytes.empty()) {
    const std::string_view part = bytes.substr(0, kMostFrame);
    bytes.remove_prefix(part.size());
    FrameHead head;
    head.length = static_cast<std::uint32_t>(part.size());
    head.place = end_.place;
    head.counter = ++counter_;
    head.last = bytes.empty() && part.size() > kMagic.size() && part.ends_with(kMagic);
    cipher_.encrypt(head, part, frame_);
    frames_.push_back(end_);
    const Boundary next{.place = end_.place + part.size(), .stored = end_.stored + frame_.size()};
    below_.write(end_.stored, view_of(frame_));
    end_ = next;
  }
}

void EncryptedFile::truncate(std::uint64_t size) {
  back_to(size);
  below_.truncate(end_.stored);
}

/// Forgets the frames from a place on.
void EncryptedFile::back_to(std::uint64_t place) {
  const auto found =
      std::lower_bound(frames_.begin(), frames_.end(), place,
                       [](const Boundary& frame, std::uint64_t wanted) { return frame.place < wanted; });
  if (found == frames_.end()) {
    if (place == end_.place) return;
  } else if (found->place == place) {
    end_ = *found;
    frames_.erase(found, frames_.end());
    return;
  }
  throw std::logic_error(fmt::format("encrypted file: no frame begins at byte {}", place));
}

}  // namespace phalanx::mcap
