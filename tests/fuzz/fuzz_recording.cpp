// SPDX-License-Identifier: Apache-2.0
// Whatever bytes a recording holds, reading it ends in messages or in an error with a message, a repair ends in a file that
// is read to its end, and neither needs more memory than the reader allows.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "phalanx/recording.pb.h"
#include "record/mcap/mcap_reader.h"
#include "record/mcap/mcap_repair.h"

namespace {

class InMemoryFile final : public phalanx::mcap::WritableFile {
 public:
  void write(std::uint64_t place, std::string_view bytes) override {
    if (bytes_.size() < place + bytes.size()) bytes_.resize(static_cast<std::size_t>(place) + bytes.size());
    bytes_.replace(static_cast<std::size_t>(place), bytes.size(), bytes);
  }
  void synchronise() override {}
  void truncate(std::uint64_t size) override { bytes_.resize(static_cast<std::size_t>(size)); }
  [[nodiscard]] std::string_view bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// @returns the number of messages up to the end or the first error
std::size_t read_all(std::string_view bytes, bool& whole) {
  std::size_t messages = 0;
  whole = false;
  try {
    const phalanx::mcap::ReadableFile file(phalanx::mcap::InMemory{bytes});
    static_cast<void>(phalanx::mcap::has_end(file));
    phalanx::mcap::McapReader reader(file);
    phalanx::mcap::Message message;
    phalanx::wire::Step step;
    while (reader.next(message)) {
      ++messages;
      static_cast<void>(step.ParseFromArray(message.data.data(), static_cast<int>(message.data.size())));
    }
    whole = true;
  } catch (const phalanx::mcap::McapError& error) {
    if (error.what()[0] == '\0') std::abort();
  }
  try {
    const phalanx::mcap::ReadableFile file(phalanx::mcap::InMemory{bytes});
    static_cast<void>(phalanx::mcap::read_summary(file));
  } catch (const phalanx::mcap::McapError&) {
  }
  return messages;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  bool whole = false;
  static_cast<void>(read_all(bytes, whole));
  InMemoryFile repaired;
  try {
    const phalanx::mcap::ReadableFile file(phalanx::mcap::InMemory{bytes});
    const phalanx::mcap::Repaired result = phalanx::mcap::repair(file, repaired);
    static_cast<void>(read_all(repaired.bytes(), whole));
    // A chunk may be of a channel that the file does not declare, or hold what is no record: its checksum is right all the same.
    const phalanx::mcap::ReadableFile again(phalanx::mcap::InMemory{repaired.bytes()});
    if (!phalanx::mcap::has_end(again)) std::abort();
    if (phalanx::mcap::read_summary(again).chunks.size() != result.summary.chunks.size()) std::abort();
  } catch (const phalanx::mcap::McapError& error) {
    if (error.what()[0] == '\0') std::abort();
  }
  return 0;
}
