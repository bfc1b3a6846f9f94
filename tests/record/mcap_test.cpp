// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
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

using test::Stored;
using test::StoredRecording;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr std::uint64_t kSecond = 1'000'000'000;

std::vector<Schema> schemas() {
  return {{.id = 1, .name = "one", .encoding = "protobuf", .data = "descriptor"}};
}
std::vector<Channel> channels() {
  return {{.id = 1, .schema = 1, .topic = "/a", .message_encoding = "protobuf"},
          {.id = 2, .schema = 1, .topic = "/b", .message_encoding = "protobuf"}};
}

/// Writes `count` messages on two channels, `per_chunk` a chunk.
void write_messages(WritableFile& file, int count, int per_chunk, bool finish) {
  McapWriter writer(file, schemas(), channels(), {{"made", {{"by", "test"}}}});
  std::mt19937_64 random(7);
  for (int i = 0; i < count; ++i) {
    std::string data = std::to_string(i) + " ";
    for (int k = 0; k < 40; ++k) data.push_back(static_cast<char>(random()));
    writer.add(i % 3 == 0 ? 2 : 1, kSecond + static_cast<std::uint64_t>(i) * 1'000'000, data);
    if (i % per_chunk == per_chunk - 1) writer.write_chunk();
  }
  if (finish) writer.finish();
}

/// @returns the number before the first space of each message, in their order
std::vector<int> numbers_in(std::string_view bytes) {
  const ReadableFile file(InMemory{bytes}, test::test_keys());
  McapReader reader(file);
  std::vector<int> numbers;
  Message message;
  while (reader.next(message)) numbers.push_back(std::stoi(std::string(message.data)));
  return numbers;
}

std::vector<int> up_to(int count) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) numbers[static_cast<std::size_t>(i)] = i;
  return numbers;
}

/// Repairs a file; an encrypted one into an encrypted one.
Repaired repaired(std::string_view bytes, std::string& out) {
  const ReadableFile file(InMemory{bytes}, test::test_keys(), Unreadable::kFilled);
  StoredRecording to(file.encrypted() ? Stored::kEncrypted : Stored::kPlain);
  Repaired result = repair(file, to.file());
  out = to.memory.content;
  return result;
}

/// The places at which the chunks of a file end, with the indexes that follow them, and how many messages come before.
std::vector<std::pair<std::uint64_t, int>> chunk_ends(std::string_view bytes, int per_chunk) {
  std::string whole;
  std::vector<std::pair<std::uint64_t, int>> ends;
  const Repaired result = repaired(bytes, whole);
  for (std::size_t i = 0; i < result.summary.chunks.size(); ++i)
    ends.emplace_back(result.summary.chunks[i].place + result.summary.chunks[i].length,
                      per_chunk * static_cast<int>(i + 1));
  return ends;
}

TEST(Mcap, WhatIsWrittenIsReadInItsOrder) {
  test::MemoryFile file;
  write_messages(file, 250, 50, true);
  EXPECT_EQ(numbers_in(file.content), up_to(250));
  const ReadableFile readable(InMemory{file.content});
  EXPECT_TRUE(has_end(readable));
  McapReader reader(readable);
  Message message;
  ASSERT_TRUE(reader.next(message));
  EXPECT_EQ(message.channel, 2);
  EXPECT_EQ(message.time, kSecond);
  EXPECT_EQ(reader.channels().at(1).topic, "/a");
  EXPECT_EQ(reader.schema_of(2), "one");
  EXPECT_EQ(reader.metadata().at("made").at("by"), "test");
}

TEST(Mcap, AFileWithoutAnEndIsRefusedWhereItEnds) {
  test::MemoryFile file;
  write_messages(file, 100, 50, false);
  EXPECT_THAT([&] { static_cast<void>(numbers_in(file.content)); },
              ThrowsMessage<McapError>(HasSubstr("has no end")));
  EXPECT_THAT([] { static_cast<void>(numbers_in("a text")); },
              ThrowsMessage<McapError>(HasSubstr("does not begin as an MCAP file")));
}

/// @returns the file as it was at `until`, with an end
std::string ended_at(const std::string& bytes, std::uint64_t until) {
  const ReadableFile file(InMemory{bytes});
  const Summary summary = summarise_until(file, until);
  return bytes.substr(0, summary.begin) + std::string(view_of(end_of_file(summary, summary.begin)));
}

TEST(Mcap, AFileThatIsBeingWrittenIsReadAsIfItEndedAfterAnyOfItsChunks) {
  test::MemoryFile longer;
  write_messages(longer, 500, 50, false);
  std::uint64_t closed_before = 0;
  for (int messages = 0; messages <= 500; messages += 50) {
    SCOPED_TRACE(messages);
    test::MemoryFile open;
    write_messages(open, messages, 50, false);
    const std::uint64_t closed = open.content.size();
    test::MemoryFile whole;
    write_messages(whole, messages, 50, true);
    EXPECT_EQ(ended_at(longer.content, closed), whole.content);
    for (std::uint64_t until = closed_before + 1; until < closed && messages > 0; ++until) {
      const std::string ended = ended_at(longer.content, until);
      const std::vector<int> numbers = numbers_in(ended);
      ASSERT_TRUE(numbers == up_to(messages - 50) || numbers == up_to(messages)) << until;
    }
    closed_before = closed;
  }
}

TEST(Mcap, WhatIsAskedOfAFileThatIsBeingWrittenIsRefusedWhereItCannotBe) {
  test::MemoryFile file;
  write_messages(file, 100, 50, false);
  const auto refused = [](const std::string& bytes, std::uint64_t until, const char* why) {
    const ReadableFile readable(InMemory{bytes});
    EXPECT_THAT([&] { static_cast<void>(summarise_until(readable, until)); },
                ThrowsMessage<McapError>(HasSubstr(why)));
  };
  const std::uint64_t size = file.content.size();
  refused("a text", 6, "does not begin as an MCAP file");
  refused(file.content, size + 1, "were asked for");
  test::MemoryFile whole;
  write_messages(whole, 100, 50, true);
  refused(whole.content, whole.content.size(), "before byte");
  constexpr std::uint64_t kSeed = 20261128;  // of bytes that are damaged
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < 2000; ++i) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", case " + std::to_string(i));
    std::string damaged = file.content;
    damaged[8 + random() % (size - 8)] = static_cast<char>(random());
    try {
      const std::string ended = ended_at(damaged, size);
      EXPECT_TRUE(has_end(ReadableFile(InMemory{ended})));
    } catch (const McapError&) {  // a refusal in words
    }
  }
}

/// Two chunks, of which a bit of the first is flipped.
void flip_a_bit_of_a_chunk(Stored stored) {
  StoredRecording file(stored);
  write_messages(file.file(), 100, 50, true);
  std::string bytes = file.memory.content;
  bytes[static_cast<std::size_t>(file.ends()[0]) + 100] ^= 4;
  EXPECT_THROW(static_cast<void>(numbers_in(bytes)), McapError);
}

TEST(Mcap, AChunkWithAFlippedBitIsRefused) { flip_a_bit_of_a_chunk(Stored::kPlain); }
TEST(McapEncrypted, AChunkWithAFlippedBitIsRefused) { flip_a_bit_of_a_chunk(Stored::kEncrypted); }

TEST(Mcap, ARepairedWholeFileIsTheSameFile) {
  test::MemoryFile file;
  write_messages(file, 250, 50, true);
  std::string out;
  const Repaired result = repaired(file.content, out);
  EXPECT_TRUE(result.had_end);
  EXPECT_TRUE(result.damages.empty());
  EXPECT_EQ(out, file.content);
}

/// @param stored  a chunk of an encrypted file is complete with its indexes: they are one frame
void truncate_a_thousand_times(Stored stored) {
  StoredRecording file(stored);
  write_messages(file.file(), 2000, 50, true);
  const std::string& content = file.memory.content;
  auto ends = chunk_ends(content, 50);
  if (stored == Stored::kEncrypted)
    for (std::size_t i = 0; i < ends.size(); ++i) ends[i].first = file.ends()[i + 1];
  const std::uint64_t begin = file.ends().front();
  constexpr std::uint64_t kSeed = 20261127;
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < 1000; ++i) {
    const std::uint64_t length = begin + random() % (content.size() - begin);
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", case " + std::to_string(i) + ", length " +
                 std::to_string(length));
    int complete = 0;
    for (const auto& [end, messages] : ends)
      if (end <= length) complete = messages;
    std::string out;
    static_cast<void>(repaired(std::string_view(content).substr(0, length), out));
    ASSERT_EQ(numbers_in(out), up_to(complete));
    ASSERT_TRUE(has_end(ReadableFile(InMemory{out}, test::test_keys())));
  }
}

TEST(Mcap, OfAThousandTruncationsEveryCompleteChunkIsKept) { truncate_a_thousand_times(Stored::kPlain); }
TEST(McapEncrypted, OfAThousandTruncationsEveryCompleteChunkIsKept) {
  truncate_a_thousand_times(Stored::kEncrypted);
}

void damage_parts(Stored stored) {
  StoredRecording file(stored);
  write_messages(file.file(), 500, 50, true);
  const auto ends = chunk_ends(file.memory.content, 50);
  constexpr std::uint64_t kSeed = 3;
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", case " + std::to_string(i));
    std::string bytes = file.memory.content;
    const std::uint64_t end = stored == Stored::kEncrypted ? file.ends()[3] : ends[2].first;
    const std::size_t begin = static_cast<std::size_t>(end) + random() % 100;
    const std::size_t length = 1 + random() % 300;
    for (std::size_t k = begin; k < begin + length; ++k) bytes[k] = static_cast<char>(random());
    std::string out;
    const Repaired result = repaired(bytes, out);
    const std::vector<int> kept = numbers_in(out);
    // The damage is in the indexes of the third chunk, which are made again, in the fourth chunk, or in both.
    ASSERT_GE(kept.size(), 450U);
    for (const int number : kept) ASSERT_TRUE(number < 500);
    for (int number = 0; number < 500; ++number)
      if (number < 150 || number >= 200) {
        ASSERT_TRUE(std::find(kept.begin(), kept.end(), number) != kept.end()) << number;
      }
  }
}

TEST(Mcap, AfterADamagedPartTheNextChunksAreKept) { damage_parts(Stored::kPlain); }
TEST(McapEncrypted, AfterADamagedPartTheNextChunksAreKept) { damage_parts(Stored::kEncrypted); }

TEST(Mcap, AFlippedBitOfAnOperationCodeHidesNothing) {
  test::MemoryFile file;
  write_messages(file, 250, 50, true);
  const ReadableFile whole(InMemory{file.content});
  std::size_t flipped = 0;
  Record record;
  for (std::uint64_t place = kMagic.size(); place + kMagic.size() < file.content.size();
       place = record.end()) {
    read_record(whole, place, record);
    for (unsigned bit = 0; bit < 8; ++bit) {
      SCOPED_TRACE("place " + std::to_string(place) + ", bit " + std::to_string(bit));
      std::string bytes = file.content;
      bytes[static_cast<std::size_t>(place)] =
          static_cast<char>(static_cast<unsigned>(bytes[static_cast<std::size_t>(place)]) ^ 1U << bit);
      ++flipped;
      try {
        EXPECT_EQ(numbers_in(bytes), up_to(250)) << "less is read, and nothing is said";
      } catch (const McapError&) {
      }
      std::string out;
      const Repaired result = repaired(bytes, out);
      const std::vector<int> kept = numbers_in(out);
      EXPECT_GE(kept.size(), 200U) << "one chunk is lost at most";
      if (kept.size() < 250) {
        EXPECT_FALSE(result.damages.empty());
      }
    }
  }
  EXPECT_GT(flipped, 100U);
}

void damage_the_beginning(Stored stored) {
  StoredRecording file(stored);
  write_messages(file.file(), 250, 50, true);
  std::string bytes = file.memory.content;
  // In the length of the first schema, behind magic and header; of an encrypted file, in the frame of the beginning.
  bytes[stored == Stored::kEncrypted ? static_cast<std::size_t>(file.ends()[0]) - 100 : 33] ^= 0x7f;
  std::string out;
  EXPECT_FALSE(repaired(bytes, out).damages.empty());
  EXPECT_EQ(numbers_in(out), up_to(250));
}

TEST(Mcap, DamageAtTheBeginningLeavesTheMessagesReadable) { damage_the_beginning(Stored::kPlain); }
TEST(McapEncrypted, DamageAtTheBeginningLeavesTheMessagesReadable) {
  damage_the_beginning(Stored::kEncrypted);
}

void refuse_a_chunk(Stored stored) {
  StoredRecording stored_file(stored);
  test::MemoryFile& file = stored_file.memory;
  McapWriter writer(stored_file.file(), schemas(), channels(), {});
  writer.add(1, kSecond, "0 ");
  writer.write_chunk();
  const std::uint64_t size = writer.size();
  writer.add(1, 2 * kSecond, "1 ");
  file.refuses = ENOSPC;
  EXPECT_THROW(writer.write_chunk(), std::system_error);
  EXPECT_TRUE(writer.pending());
  writer.add(1, 3 * kSecond, "2 ");
  EXPECT_THROW(writer.write_chunk(), std::system_error);
  EXPECT_EQ(writer.size(), size);
  file.refuses = 0;
  writer.write_chunk();
  EXPECT_FALSE(writer.pending());
  writer.finish();
  EXPECT_EQ(numbers_in(file.content), up_to(3));
}

TEST(Mcap, AChunkThatTheDiskRefusedIsWrittenAtItsPlace) { refuse_a_chunk(Stored::kPlain); }
TEST(McapEncrypted, AChunkThatTheDiskRefusedIsWrittenAtItsPlace) { refuse_a_chunk(Stored::kEncrypted); }

void damage_four_bytes(Stored stored) {
  StoredRecording stored_file(stored);
  const test::MemoryFile& file = stored_file.memory;
  write_messages(stored_file.file(), 100, 50, true);
  constexpr std::uint64_t kSeed = 11;
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < 2000; ++i) {
    std::string bytes = file.content;
    for (int k = 0; k < 4; ++k)
      bytes[8 + random() % (bytes.size() - 8)] = static_cast<char>(random() % 3 == 0 ? 0xff : random());
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", case " + std::to_string(i));
    try {
      static_cast<void>(numbers_in(bytes));
    } catch (const McapError&) {
    } catch (const NoKeyError&) {             // the head names another id
    } catch (const std::invalid_argument&) {  // of std::stoi: the bytes of a damaged message
    }
    std::string out;
    try {
      static_cast<void>(repaired(bytes, out));
    } catch (const McapError&) {
    } catch (const NoKeyError&) {  // the head names another id
    }
  }
}

TEST(Mcap, NoLengthInTheFileIsBelieved) { damage_four_bytes(Stored::kPlain); }
TEST(McapEncrypted, NoLengthInTheFileIsBelieved) { damage_four_bytes(Stored::kEncrypted); }

TEST(Mcap, AnUnknownCompressionIsKeptByARepair) {
  test::MemoryFile file;
  write_messages(file, 150, 50, true);
  std::string bytes = file.content;
  std::size_t changed = 0;
  for (std::size_t at = bytes.find("\x04\0\0\0zstd", 0, 8); at != std::string::npos;
       at = bytes.find("\x04\0\0\0zstd", at + 1, 8)) {
    bytes.replace(at + 4, 4, "none");
    ++changed;
  }
  ASSERT_EQ(changed, 6U) << "three chunks, three indexes of them";
  std::string out;
  const Repaired result = repaired(bytes.substr(0, bytes.size() - 100), out);
  EXPECT_EQ(result.summary.chunks.size(), 3U);
  EXPECT_EQ(result.summary.messages.at(1) + result.summary.messages.at(2), 150U);
  EXPECT_THAT([&] { static_cast<void>(numbers_in(out)); },
              ThrowsMessage<McapError>(HasSubstr("compressed by 'none'")));
}

TEST(Mcap, AFileIsLockedWhileItIsWritten) {
  const testing::TemporaryFolder folder;
  const auto name = folder / "a.mcap";
  {
    DiskFile file(name);
    write_messages(file, 100, 50, true);
    EXPECT_TRUE(is_being_written(name));
    EXPECT_THROW(DiskFile{name}, std::system_error);
  }
  EXPECT_FALSE(is_being_written(name));
  EXPECT_EQ(numbers_in(testing::read_file(name)), up_to(100));
}

}  // namespace
}  // namespace phalanx::mcap
