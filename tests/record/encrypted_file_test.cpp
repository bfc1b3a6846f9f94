// SPDX-License-Identifier: Apache-2.0
#include "record/mcap/encrypted_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "record/mcap/mcap_reader.h"
#include "record/mcap/mcap_repair.h"
#include "record/mcap/mcap_writer.h"
#include "record/memory_file.h"
#include "record/stored_recording.h"
#include "record/temporary_folder.h"

namespace phalanx::mcap {
namespace {

using test::MemoryFile;
using test::test_encryption;
using test::test_keys;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr std::uint64_t kSecondNs = 1'000'000'000;

/// Writes `count` messages "secret N", one a chunk.
void write_secrets(WritableFile& file, int count) {
  McapWriter writer(file, {{.id = 1, .name = "one", .encoding = "protobuf", .data = "descriptor"}},
                    {{.id = 1, .schema = 1, .topic = "/secret", .message_encoding = "protobuf"}}, {});
  for (int i = 0; i < count; ++i) {
    writer.add(1, kSecondNs + static_cast<std::uint64_t>(i), fmt::format("secret {}", i));
    writer.write_chunk();
  }
  writer.finish();
}

std::string encrypted_secrets(int count) {
  MemoryFile disk;
  EncryptedFile file(disk, test_encryption());
  write_secrets(file, count);
  return disk.content;
}

std::vector<std::string> secrets_in(std::string_view bytes) {
  const ReadableFile file(InMemory{bytes}, test_keys());
  McapReader reader(file);
  std::vector<std::string> all;
  Message message;
  while (reader.next(message)) all.emplace_back(message.data);
  return all;
}

std::vector<std::string> secrets(int count) {
  std::vector<std::string> all;
  for (int i = 0; i < count; ++i) all.push_back(fmt::format("secret {}", i));
  return all;
}

/// @returns the frames of a file, as they are on the disk
std::vector<std::string> frames_of(std::string_view bytes) {
  const StoredBytes file(InMemory{bytes});
  FrameWalk walk(file);
  std::vector<std::string> frames;
  Frame frame;
  while (walk.next(frame)) frames.emplace_back(bytes.substr(frame.stored, frame.head.stored()));
  return frames;
}

std::string joined(std::string_view of, const std::vector<std::string>& frames) {
  std::string all(of.substr(0, 2 * kEncryptedHead));
  for (const std::string& frame : frames) all += frame;
  return all;
}

std::string why_refused(std::string_view bytes) {
  try {
    static_cast<void>(secrets_in(bytes));
  } catch (const McapError& error) {
    return error.what();
  } catch (const NoKeyError& error) {
    return error.what();
  }
  return "not refused";
}

TEST(EncryptedFile, IsReadAsItWasWrittenAndHoldsNoneOfIt) {
  const std::string bytes = encrypted_secrets(20);
  EXPECT_EQ(secrets_in(bytes), secrets(20));
  MemoryFile plain;
  write_secrets(plain, 20);
  const ReadableFile decrypted(InMemory{bytes}, test_keys());
  std::string all;
  decrypted.read(0, decrypted.size() + 1, all);
  EXPECT_TRUE(all == plain.content) << "the bytes of the MCAP file are the same";
  EXPECT_EQ(bytes.size(), 2 * kEncryptedHead + plain.content.size() + 22 * kFrameExtra)
      << "a frame for the beginning, each chunk, and the end";
  for (const char* text : {"MCAP", "secret", "descriptor", "zstd", "phalanx"})
    EXPECT_EQ(bytes.find(text), std::string::npos) << text;
  EXPECT_NE(encrypted_secrets(20), bytes) << "the salt is random";
}

TEST(EncryptedFile, AnyPartIsReadAlsoOfAWriteOfSeveralFrames) {
  constexpr std::uint64_t kSeed = 41;
  SCOPED_TRACE("seed 41");
  std::mt19937_64 random(kSeed);
  std::string written;
  MemoryFile disk;
  EncryptedFile file(disk, test_encryption());
  for (const std::uint32_t length : {1U, 10U, kMostFrame, 2 * kMostFrame + 7, 500U}) {
    std::string part(length, '\0');
    for (char& byte : part) byte = static_cast<char>(random());
    file.write(written.size(), part);
    written += part;
  }
  EXPECT_EQ(frames_of(disk.content).size(), 7U);
  const ReadableFile read(InMemory{disk.content}, test_keys());
  ASSERT_EQ(read.size(), written.size());
  std::string part;
  for (int i = 0; i < 40; ++i) {
    const std::uint64_t place = random() % (written.size() + 10);
    const std::uint64_t length = random() % (i % 2 == 0 ? 100 : 3U * kMostFrame);
    read.read(place, length, part);
    EXPECT_TRUE(part == written.substr(std::min<std::size_t>(place, written.size()), length))
        << place << ", " << length;
  }
}

TEST(EncryptedFile, WithoutItsKeyIsRefusedInWords) {
  const std::string bytes = encrypted_secrets(3);
  const auto read_with = [&](const FindRecordingKey& keys) { ReadableFile(InMemory{bytes}, keys); };
  EXPECT_THAT([&] { read_with({}); },
              ThrowsMessage<NoKeyError>(AllOf(HasSubstr(test_encryption().id), HasSubstr("is not here"),
                                              HasSubstr("--keys FILE"))));
  EXPECT_THAT([&] { read_with([](const std::string&) { return std::nullopt; }); },
              ThrowsMessage<NoKeyError>(HasSubstr("is not here")));
  EXPECT_THAT([&] { read_with([](const std::string&) { return RecordingKey{}; }); },
              ThrowsMessage<NoKeyError>(HasSubstr("is another")));
  RecordingEncryption named = test_encryption();
  named.id = "P07";
  MemoryFile disk;
  EXPECT_THAT([&] { EncryptedFile(disk, named); }, ThrowsMessage<std::invalid_argument>(HasSubstr("'P07'")));
  EXPECT_EQ(disk.content, "");
}

TEST(EncryptedFile, EveryFlippedBitIsNamedOrChangesNothing) {
  const std::string bytes = encrypted_secrets(4);
  std::size_t unchanged = 0;
  for (std::size_t i = 0; i < 8 * bytes.size(); ++i) {
    SCOPED_TRACE("bit " + std::to_string(i));
    std::string flipped = bytes;
    flipped[i / 8] = static_cast<char>(static_cast<unsigned char>(flipped[i / 8]) ^ 1U << i % 8);
    std::string refusal = why_refused(flipped);
    if (refusal == "not refused") {
      ASSERT_EQ(secrets_in(flipped), secrets(4)) << "less or something else is read, and nothing is said";
      ++unchanged;
    } else {
      ASSERT_THAT(refusal, HasSubstr("byte "));
    }
  }
  // One of the two heads, and the lengths and body checksums of frames, which only other readers need.
  EXPECT_LE(unchanged, 8 * (2 * kEncryptedHead + 6 * 4));
  EXPECT_GE(unchanged, 8 * 2 * kEncryptedHead);
}

TEST(EncryptedFile, ARemovedRepeatedOrMovedFrameIsNamed) {
  const std::string bytes = encrypted_secrets(5);
  const std::vector<std::string> whole = frames_of(bytes);
  ASSERT_EQ(whole.size(), 7U);
  ASSERT_EQ(joined(bytes, whole), bytes);
  const auto changed = [&](const auto& change) {
    std::vector<std::string> frames = whole;
    change(frames);
    return why_refused(joined(bytes, frames));
  };
  using Frames = std::vector<std::string>;
  EXPECT_THAT(changed([](Frames& f) { f.erase(f.begin() + 2); }), HasSubstr("before this frame are missing"));
  EXPECT_THAT(changed([](Frames& f) { std::swap(f[2], f[3]); }), HasSubstr("missing"));
  EXPECT_THAT(changed([](Frames& f) { f[3] = f[2]; }), HasSubstr("missing"));
  EXPECT_THAT(changed([](Frames& f) { f.pop_back(); }), HasSubstr("it has no end"));
  EXPECT_THAT(changed([](Frames& f) { f.erase(f.begin(), f.end() - 1); }), HasSubstr("missing"));
  EXPECT_THAT(changed([](Frames& f) { f.clear(); }), HasSubstr("does not begin as an MCAP file"));
  Frames repeated = whole;
  repeated.insert(repeated.begin() + 3, repeated[2]);
  EXPECT_EQ(secrets_in(joined(bytes, repeated)), secrets(5)) << "the second copy is left out";
  // A frame of another file of the same person, which has the same place and counter.
  const std::string other = encrypted_secrets(5);
  EXPECT_THAT(changed([&](Frames& f) { f[2] = frames_of(other)[2]; }), HasSubstr("its tag is wrong"));
}

/// A file whose writes can fail after they have put their bytes there.
class FailingFile final : public WritableFile {
 public:
  void write(std::uint64_t /*place*/, std::string_view bytes) override {
    written.emplace_back(bytes);
    if (fails) throw std::system_error(ENOSPC, std::generic_category(), "write");
  }
  void synchronise() override {}
  void truncate(std::uint64_t /*size*/) override {}

  std::vector<std::string> written;
  bool fails = false;
};

TEST(EncryptedFile, NoNonceIsUsedTwiceWhenWritesAreRepeatedWithOtherBytes) {
  FailingFile disk;
  EncryptedFile file(disk, test_encryption());
  file.write(0, "the beginning");
  disk.fails = true;
  for (const char* bytes : {"a chunk", "a chunk", "another chunk", "an end"})
    EXPECT_THROW(file.write(13, bytes), std::system_error);
  disk.fails = false;
  file.write(13, "a chunk");
  file.write(20, "an end");
  file.truncate(13);
  file.write(13, "a third chunk");
  std::set<std::uint64_t> counters;
  for (std::size_t i = 1; i < disk.written.size(); ++i) {
    FrameHead head;
    ASSERT_TRUE(parse_frame_head(disk.written[i], head));
    EXPECT_TRUE(counters.insert(head.counter).second) << head.counter;
  }
  EXPECT_EQ(counters.size(), 8U);
  EXPECT_THROW(file.write(15, "x"), std::logic_error);
  EXPECT_THROW(file.write(100, "x"), std::logic_error);
}

TEST(EncryptedFile, AStaleFrameBehindTheEndIsNotRead) {
  MemoryFile disk;
  EncryptedFile file(disk, test_encryption());
  file.write(0, "the beginning");
  file.write(13, std::string(1000, 'x'));
  const std::string longer = disk.content;
  file.write(13, "a chunk");  // in the place of the longer one
  ASSERT_EQ(disk.content.size(), longer.size());
  const ReadableFile read(InMemory{disk.content}, test_keys());
  std::string all;
  read.read(0, 10000, all);
  EXPECT_EQ(all, "the beginninga chunk");
  EXPECT_EQ(read.undecrypted().size(), 1U) << "the rest of the longer one";
}

TEST(EncryptedFile, OneOfItsTwoHeadsIsEnough) {
  const std::string bytes = encrypted_secrets(3);
  const auto damaged = [&](bool first, bool second) {
    std::string with = bytes;
    for (std::size_t i = 0; i < kEncryptedHead; ++i) {
      if (first) with[i] ^= 0x55;
      if (second) with[kEncryptedHead + i] ^= 0x55;
    }
    return with;
  };
  EXPECT_EQ(secrets_in(damaged(true, false)), secrets(3));
  EXPECT_EQ(secrets_in(damaged(false, true)), secrets(3));
  EXPECT_THAT(why_refused(damaged(true, true)), HasSubstr("does not begin as an MCAP file"));
  std::string both = bytes;
  both[kEncryptedHead - 1] ^= 1;
  both[2 * kEncryptedHead - 1] ^= 1;
  EXPECT_THAT(why_refused(both), HasSubstr("damaged in both places"));
}

TEST(EncryptedFile, WithoutAKeyWholeFramesAreKeptAndTheKeyCompletesTheRest) {
  const std::string whole = encrypted_secrets(10);
  std::string bytes = whole.substr(0, whole.size() - 30);  // the end is torn
  const std::size_t third =
      joined(bytes, {}).size() + frames_of(bytes)[0].size() + frames_of(bytes)[1].size();
  bytes[third + 40] ^= 1;  // in the ciphertext of the second chunk
  MemoryFile kept;
  const KeptFrames result = keep_whole_frames(StoredBytes(InMemory{bytes}), kept);
  EXPECT_EQ(result.frames, 10U) << "the beginning and nine chunks";
  EXPECT_FALSE(result.had_end);
  ASSERT_EQ(result.damages.size(), 2U);
  EXPECT_EQ(result.damages[0].place, third);
  EXPECT_THAT(result.damages[0].what, HasSubstr("checksum is wrong"));
  EXPECT_THAT(result.damages[1].what, HasSubstr("ends in a frame"));
  EXPECT_THROW(static_cast<void>(keep_whole_frames(StoredBytes(InMemory{"a text"}), kept)), McapError);

  const ReadableFile from(InMemory{kept.content}, test_keys(), Unreadable::kFilled);
  MemoryFile disk;
  EncryptedFile to(disk, test_encryption());
  const Repaired repaired = repair(from, to);
  EXPECT_FALSE(repaired.damages.empty());
  std::vector<std::string> expected = secrets(10);
  expected.erase(expected.begin() + 1);
  EXPECT_EQ(secrets_in(disk.content), expected);
  EXPECT_EQ(frames_of(disk.content).size(), 11U)
      << "a chunk with its indexes is one frame in a repaired file, too";
}

// tests/record/encrypt_recording.py made the file, with another implementation of HKDF.
TEST(EncryptedFile, AFileThatAnotherProgramEncryptedIsRead) {
  const std::string bytes = testing::read_file(std::filesystem::path(PHALANX_SOURCE_DIR) /
                                               "tests/fuzz/corpus/fuzz_encrypted_recording/by_python");
  EXPECT_THAT(secrets_in(bytes), ElementsAre("secret 0", "secret 1", "secret 2"));
}

}  // namespace
}  // namespace phalanx::mcap
