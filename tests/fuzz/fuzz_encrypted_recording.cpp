// SPDX-License-Identifier: Apache-2.0
// Whatever bytes an encrypted recording holds, reading and repairing it end in messages or in an error with a
// message. And whatever is done to the frames of one, nothing is read from it but what was written, in its
// order; if something is missing, an error or a damage says so.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "record/mcap/encrypted_file.h"
#include "record/mcap/mcap_reader.h"
#include "record/mcap/mcap_repair.h"
#include "record/mcap/mcap_writer.h"

namespace {

using namespace phalanx;  // NOLINT(google-build-using-namespace)

constexpr int kMessages = 6;

class FuzzedFile final : public mcap::WritableFile {
 public:
  void write(std::uint64_t place, std::string_view bytes) override {
    if (content.size() < place + bytes.size()) content.resize(static_cast<std::size_t>(place) + bytes.size());
    content.replace(static_cast<std::size_t>(place), bytes.size(), bytes);
  }
  void synchronise() override {}
  void truncate(std::uint64_t size) override { content.resize(static_cast<std::size_t>(size)); }

  std::string content;
};

/// The key of tests/record/stored_recording.h, under every id.
std::optional<RecordingKey> fuzzing_key(const std::string& /*id*/) {
  RecordingKey key{};
  for (std::size_t i = 0; i < key.size(); ++i) key[i] = static_cast<unsigned char>(3 * i + 1);
  return key;
}

RecordingEncryption fuzzing_encryption() {
  return {.id = "00112233445566778899aabbccddeeff", .key = *fuzzing_key("")};
}

void demand(bool so) {
  if (!so) std::abort();
}

/// @returns the messages up to the end or the first error. @param whole  set to true if there was no error
std::vector<std::string> messages_of(std::string_view bytes, bool& whole) {
  std::vector<std::string> messages;
  whole = false;
  try {
    const mcap::ReadableFile file(mcap::InMemory{bytes}, fuzzing_key);
    mcap::McapReader reader(file);
    mcap::Message message;
    while (reader.next(message)) messages.emplace_back(message.data);
    whole = true;
  } catch (const mcap::McapError& error) {
    demand(error.what()[0] != '\0');
  } catch (const mcap::NoKeyError& error) {
    demand(error.what()[0] != '\0');
  }
  return messages;
}

/// Repairs with the key and without it. @returns the repaired file; empty: it was refused
std::string repaired(std::string_view bytes, std::size_t& damages) {
  FuzzedFile kept;
  try {
    static_cast<void>(mcap::keep_whole_frames(mcap::StoredBytes(mcap::InMemory{bytes}), kept));
    demand(mcap::keep_whole_frames(mcap::StoredBytes(mcap::InMemory{kept.content}), kept).frames <=
           bytes.size());
  } catch (const mcap::McapError&) {
  }
  FuzzedFile disk;
  try {
    const mcap::ReadableFile from(mcap::InMemory{bytes}, fuzzing_key, mcap::Unreadable::kFilled);
    mcap::EncryptedFile to(disk, fuzzing_encryption());
    damages = mcap::repair(from, to).damages.size() + from.undecrypted().size();
  } catch (const mcap::McapError& error) {
    demand(error.what()[0] != '\0');
    return {};
  } catch (const mcap::NoKeyError&) {
    return {};
  }
  return disk.content;
}

/// @returns an encrypted file of messages "0", "1" and so on, one a chunk
const std::string& made() {
  static const std::string kMade = [] {
    FuzzedFile disk;
    mcap::EncryptedFile file(disk, fuzzing_encryption());
    mcap::McapWriter writer(file, {{.id = 1, .name = "one", .encoding = "protobuf", .data = "descriptor"}},
                            {{.id = 1, .schema = 1, .topic = "/a", .message_encoding = "protobuf"}}, {});
    for (int i = 0; i < kMessages; ++i) {
      writer.add(1, 1'000'000'000, std::to_string(i));
      writer.write_chunk();
    }
    writer.finish();
    return disk.content;
  }();
  return kMade;
}

/// Does to the file what the data say, four bytes each: flip bits, cut, and remove, repeat, swap
/// or move frames.
std::string treated(std::string_view data) {
  std::string file = made();
  while (data.size() >= 4) {
    const auto at = [&](std::size_t i) {
      return static_cast<std::size_t>(static_cast<unsigned char>(data[i]));
    };
    const std::size_t kind = at(0) % 5;
    const std::size_t number = at(1) + 256 * at(2);
    if (kind == 0 && !file.empty())
      file[number % file.size()] = static_cast<char>(file[number % file.size()] ^ data[3]);
    if (kind == 1) file.resize(number % (file.size() + 1));
    const mcap::StoredBytes stored(mcap::InMemory{file});
    mcap::FrameWalk walk(stored);
    std::vector<mcap::Frame> frames;
    for (mcap::Frame frame; walk.next(frame);) frames.push_back(frame);
    if (kind > 1 && !frames.empty()) {
      const mcap::Frame& one = frames[at(1) % frames.size()];
      const mcap::Frame& other = frames[at(2) % frames.size()];
      const std::string bytes =
          file.substr(static_cast<std::size_t>(one.stored), static_cast<std::size_t>(one.head.stored()));
      if (kind == 2) file.erase(static_cast<std::size_t>(one.stored), bytes.size());
      if (kind == 3) file.insert(static_cast<std::size_t>(other.stored), bytes);
      if (kind == 4)
        file.replace(static_cast<std::size_t>(other.stored), static_cast<std::size_t>(other.head.stored()),
                     bytes);
    }
    data.remove_prefix(4);
  }
  return file;
}

/// Demands that the messages are some of those that were written, in their order.
void demand_written(const std::vector<std::string>& messages) {
  int last = -1;
  for (const std::string& message : messages) {
    const int number = std::atoi(message.c_str());
    demand(message == std::to_string(number) && number > last && number < kMessages);
    last = number;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  bool whole = false;
  std::size_t damages = 0;
  static_cast<void>(messages_of(bytes, whole));
  static_cast<void>(repaired(bytes, damages));

  const std::string file = treated(bytes.substr(0, 64));
  const std::vector<std::string> read = messages_of(file, whole);
  demand_written(read);
  demand(!whole || read.size() == kMessages);
  const std::string again = repaired(file, damages);
  if (!again.empty()) {
    bool repaired_whole = false;
    const std::vector<std::string> kept = messages_of(again, repaired_whole);
    demand_written(kept);
    demand(kept.size() >= read.size() || damages > 0);
    demand(kept.size() == kMessages || damages > 0 || !whole);
  }
  return 0;
}
