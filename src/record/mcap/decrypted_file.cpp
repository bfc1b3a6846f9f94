// SPDX-License-Identifier: Apache-2.0
#include "record/mcap/decrypted_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace phalanx::mcap {
namespace {

constexpr std::uint64_t kSearched = 1U << 20U;  ///< read at once while a frame is searched for [bytes]
constexpr std::size_t kMostDamages = 1000;      ///< that are named one by one
constexpr char kFill = '\xff';                  ///< no operation code, and as a length larger than any file

std::string begin_of(const StoredBytes& file) {
  std::string begin;
  file.read(0, 2 * kEncryptedHead, begin);
  return begin;
}

/// @returns the cipher of a file. @throws NoKeyError
void find_cipher(const EncryptedHead& head, const FindRecordingKey& keys,
                 std::optional<FrameCipher>& cipher) {
  const std::optional<RecordingKey> key = keys ? keys(head.id) : std::nullopt;
  if (!key)
    throw NoKeyError(
        fmt::format("it is encrypted, and its key (id {}) is not here; name the file of keys that has "
                    "it with --keys FILE",
                    head.id));
  cipher.emplace(head, *key);
  if (cipher->check() != head.check)
    throw NoKeyError(
        fmt::format("it is encrypted, and the key that is known under its id ({}) is another; name the file "
                    "of keys that has the "
                    "right one with --keys FILE",
                    head.id));
}

}  // namespace

bool is_encrypted(const StoredBytes& file) { return begins_as_encrypted(begin_of(file)); }

bool FrameWalk::read_head(std::uint64_t place, FrameHead& head) {
  file_.read(place, kFrameHead, block_);
  return parse_frame_head(block_, head) && head.place <= file_.size();
}

void FrameWalk::damaged(std::uint64_t place, std::uint64_t length, std::string what) {
  if (damages_.size() < kMostDamages)
    damages_.push_back({.place = place, .length = length, .what = std::move(what)});
  else
    damages_.back() = {.place = damages_.back().place,
                       .length = place + length - damages_.back().place,
                       .what = "many frames are damaged"};
}

/// Searches for the head of a frame. @returns its place, or the file's end
std::uint64_t FrameWalk::next_head(std::uint64_t place) {
  std::string block;
  FrameHead head;
  for (; place < file_.size(); place += kSearched) {
    file_.read(place, kSearched + kFrameHead - 1, block);
    for (std::size_t i = block.find("PHX"); i < kSearched && i != std::string::npos;
         i = block.find("PHX", i + 1))
      if (parse_frame_head(std::string_view(block).substr(i), head) && head.place <= file_.size())
        return place + i;
  }
  return file_.size();
}

bool FrameWalk::next(Frame& frame) {
  while (at_ < file_.size()) {
    FrameHead head;
    if (!read_head(at_, head)) {
      const std::uint64_t found = next_head(at_ + 1);
      damaged(at_, found - at_,
              found == file_.size() ? "the file ends in a frame, or its frames are damaged to the end"
                                    : "the head of a frame is damaged");
      at_ = found;
      continue;
    }
    if (head.stored() > file_.size() - at_) {
      damaged(at_, file_.size() - at_, "the file ends in a frame");
      at_ = file_.size();
      return false;
    }
    const std::uint64_t begin = std::exchange(at_, at_ + head.stored());
    if (head.place < place_ || head.counter <= counter_) {
      damaged(begin, head.stored(), "a frame is not in its order: it was repeated, moved or replaced");
      continue;
    }
    if (head.place > place_)
      damaged(begin, 0, fmt::format("{} bytes before this frame are missing", head.place - place_));
    place_ = head.end();
    counter_ = head.counter;
    frame = {.stored = begin, .head = head};
    return true;
  }
  return false;
}

std::optional<Frame> last_frame(const StoredBytes& file) {
  std::string bytes;
  if (file.size() < 2 * kEncryptedHead + kFrameExtra) return std::nullopt;
  file.read(file.size() - 4, 4, bytes);
  if (bytes.size() != 4) return std::nullopt;
  const std::uint64_t stored = kFrameExtra + std::uint64_t{Cursor(bytes).u32()};
  if (stored > file.size() - 2 * kEncryptedHead) return std::nullopt;
  Frame frame{.stored = file.size() - stored, .head = {}};
  file.read(frame.stored, kFrameHead, bytes);
  if (!parse_frame_head(bytes, frame.head) || frame.head.stored() != stored || frame.head.place > file.size())
    return std::nullopt;
  return frame;
}

std::optional<EncryptedSummary> summarise_encrypted(const StoredBytes& file) {
  const std::string begin = begin_of(file);
  if (!begins_as_encrypted(begin)) return std::nullopt;
  const std::optional<Frame> last = last_frame(file);
  return EncryptedSummary{.id = parse_encrypted_head(begin).id, .has_end = last && last->head.last};
}

DecryptedFile::DecryptedFile(const StoredBytes& file, const FindRecordingKey& keys, Unreadable unreadable)
    : file_(file), unreadable_(unreadable), head_(parse_encrypted_head(begin_of(file))), walk_(file) {
  find_cipher(head_, keys, cipher_);
  if (unreadable_ == Unreadable::kRefused) last_ = last_frame(file);
  if (!last_) static_cast<void>(frame_at(file.size()));  // finds all of them
  if (last_)
    size_ = last_->head.end();
  else if (!frames_.empty())
    size_ = frames_.back().head.end();
}

std::vector<Damage> DecryptedFile::damages() const {
  std::vector<Damage> all = walk_.damages();
  for (const auto& [place, length] : failed_)
    all.push_back(
        {.place = place, .length = length, .what = "a frame is damaged or was changed: its tag is wrong"});
  std::sort(all.begin(), all.end(), [](const Damage& a, const Damage& b) { return a.place < b.place; });
  return all;
}

/// @returns the frame that holds a place or, if none does, the next one; null: there is none
const Frame* DecryptedFile::frame_at(std::uint64_t place) {
  if (last_ && place >= last_->head.place) return &*last_;
  Frame frame;
  while (!walked_ && (frames_.empty() || frames_.back().head.end() <= place)) {
    if (walk_.next(frame))
      frames_.push_back(frame);
    else
      walked_ = true;
  }
  const auto found =
      std::upper_bound(frames_.begin(), frames_.end(), place,
                       [](std::uint64_t wanted, const Frame& each) { return wanted < each.head.end(); });
  return found == frames_.end() ? nullptr : &*found;
}

bool DecryptedFile::load(const Frame& frame) {
  if (loaded_ == frame.stored) return true;
  if (failed_.contains(frame.stored)) return false;
  loaded_ = 0;
  file_.read(frame.stored, frame.head.stored(), stored_);
  if (!cipher_->decrypt(stored_, content_) || content_.size() != frame.head.length) {
    failed_[frame.stored] = frame.head.stored();
    return false;
  }
  loaded_ = frame.stored;
  return true;
}

/// Names the damage at a place of the encrypted file, or the newest before it.
void DecryptedFile::refuse(std::uint64_t place) const {
  const std::vector<Damage> all = damages();
  const auto behind =
      std::upper_bound(all.begin(), all.end(), place,
                       [](std::uint64_t wanted, const Damage& damage) { return wanted < damage.place; });
  if (behind == all.begin())
    throw McapError(fmt::format("at byte {} of the encrypted file: a frame is missing", place));
  throw McapError(
      fmt::format("at byte {} of the encrypted file: {}", (behind - 1)->place, (behind - 1)->what));
}

void DecryptedFile::read(std::uint64_t place, std::uint64_t length, std::string& out) {
  out.clear();
  if (place >= size_) return;
  const std::uint64_t end = place + std::min(length, size_ - place);
  out.reserve(static_cast<std::size_t>(end - place));
  while (place < end) {
    const Frame* const frame = frame_at(place);
    const std::uint64_t begins = frame == nullptr ? end : frame->head.place;
    if (place < begins || !load(*frame)) {
      const std::uint64_t until = std::min(end, place < begins ? begins : frame->head.end());
      if (unreadable_ == Unreadable::kRefused) refuse(frame == nullptr ? file_.size() : frame->stored);
      // The first bytes of the content are known: they are those of every MCAP file.
      for (; place < until; ++place) out.push_back(place < kMagic.size() ? kMagic[place] : kFill);
      continue;
    }
    const std::uint64_t until = std::min(end, frame->head.end());
    out.append(content_, static_cast<std::size_t>(place - begins), static_cast<std::size_t>(until - place));
    place = until;
  }
}

}  // namespace phalanx::mcap
