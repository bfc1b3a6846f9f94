// SPDX-License-Identifier: Apache-2.0
#include "registry/journal.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "phalanx/registry/registry_error.h"
#include "registry/private_file.h"

namespace phalanx::registry {
namespace {

constexpr std::string_view kBegin = "phalanx journal ";
constexpr std::string_view kHead = "phalanx journal 1 ";
constexpr std::size_t kGeneration = 32;
constexpr std::size_t kHeadBytes = kHead.size() + kGeneration + 1;
constexpr std::size_t kLengthBytes = 4;
constexpr std::uint64_t kLongestEvent = 32U << 20U;

std::string length_bytes(std::size_t length) {
  std::string out;
  for (unsigned i = 0; i < kLengthBytes; ++i) out.push_back(static_cast<char>((length >> (8U * i)) & 255U));
  return out;
}

std::uint64_t length_at(std::string_view bytes) noexcept {
  std::uint64_t out = 0;
  for (std::size_t i = kLengthBytes; i-- > 0;) out = 256 * out + static_cast<unsigned char>(bytes[i]);
  return out;
}

}  // namespace

Journal::Journal(std::filesystem::path file, std::string record, Key key)
    : file_(std::move(file)), record_(std::move(record)), key_(key) {}

bool Journal::exists() const { return stamp_of(file_).has_value(); }

std::uint64_t Journal::bytes() const {
  const std::optional<FileStamp> stamp = stamp_of(file_);
  return stamp ? stamp->bytes : 0;
}

std::string Journal::context(const std::string& generation, std::uint64_t number) const {
  return fmt::format("phalanx journal|{}|{}|{}", record_, generation, number);
}

std::string Journal::sealed_event(const std::string& generation, std::uint64_t number,
                                  const std::string& event) const {
  if (event.size() > kLongestEvent)
    throw std::invalid_argument(fmt::format("an entry of {} bytes is too long", event.size()));
  const std::string sealed = seal(key_, context(generation, number), event);
  return fmt::format("{}{}", length_bytes(sealed.size()), sealed);
}

std::string Journal::generation() const { return read({.events = 0, .bytes = bytes()}).generation; }

JournalContent Journal::read(const JournalPlace& from) const {
  JournalContent out;
  out.place = from;
  const std::optional<std::string> file = read_private_file(file_);
  if (!file) return out;
  const std::string_view text(*file);
  if (text.starts_with(kBegin) && text.size() >= kHeadBytes && !text.starts_with(kHead))
    throw RegistryError(RegistryFault::kNewer,
                        fmt::format("{} has a newer format; install a newer program", file_.string()));
  if (text.size() < kHeadBytes || !text.starts_with(kHead)) {
    out.torn = !text.empty();
    return out;
  }
  out.generation = text.substr(kHead.size(), kGeneration);
  std::uint64_t at = std::max<std::uint64_t>(from.bytes, kHeadBytes);
  std::uint64_t number = from.events;
  out.place.bytes = at;
  std::uint64_t damaged = 0;
  while (at + kLengthBytes <= text.size()) {
    const std::uint64_t length = length_at(text.substr(at));
    if (length == 0 || length > kLongestEvent + 64 || at + kLengthBytes + length > text.size()) break;
    std::optional<std::string> event =
        open_sealed(key_, context(out.generation, number), text.substr(at + kLengthBytes, length));
    at += kLengthBytes + length;
    ++number;
    if (!event) {
      ++damaged;  // counts only if a whole event follows: else it is torn
      continue;
    }
    out.damaged += std::exchange(damaged, 0);
    out.events.push_back(std::move(*event));
    out.ends.push_back(at);
    out.place = {.events = number, .bytes = at};
  }
  out.torn = out.place.bytes < text.size();
  return out;
}

JournalPlace Journal::append(const std::string& generation, const JournalPlace& at,
                             const std::string& event) {
  const std::string bytes = sealed_event(generation, at.events, event);
  append_private_file(file_, bytes);
  return {.events = at.events + 1, .bytes = at.bytes + bytes.size()};
}

JournalContent Journal::replace(const std::vector<std::string>& events) {
  JournalContent out;
  out.generation = random_record_id();
  std::string text = fmt::format("{}{}\n", kHead, out.generation);
  for (const std::string& event : events) {
    text += sealed_event(out.generation, out.place.events++, event);
    out.ends.push_back(text.size());
  }
  out.events = events;
  out.place.bytes = text.size();
  replace_private_file(file_, text);
  return out;
}

void Journal::cut(const JournalPlace& at) { cut_private_file(file_, at.bytes); }

void Journal::erase() { erase_private_file(file_); }

}  // namespace phalanx::registry
