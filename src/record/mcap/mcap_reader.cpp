// SPDX-License-Identifier: Apache-2.0
#include "record/mcap/mcap_reader.h"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <new>
#include <utility>

namespace phalanx::mcap {
namespace {

constexpr std::uint64_t kFooterBytes = kRecordHead + 20;

ChunkEntry parse_chunk_index(std::string_view content) {
  Cursor fields(content);
  ChunkEntry chunk;
  chunk.first = fields.u64();
  chunk.last = fields.u64();
  chunk.place = fields.u64();
  chunk.length = fields.u64();
  Cursor places(fields.raw(fields.u32()));
  while (!places.empty()) {
    const std::uint16_t channel = places.u16();
    chunk.index[channel] = places.u64();
  }
  chunk.index_length = fields.u64();
  chunk.compression = fields.text();
  chunk.compressed = fields.u64();
  chunk.uncompressed = fields.u64();
  return chunk;
}

/// @returns the numbers of messages by channel of a Statistics record
std::map<std::uint16_t, std::uint64_t> parse_message_counts(std::string_view content) {
  Cursor fields(content);
  static_cast<void>(fields.raw(8 + 2 + 4 + 4 + 4 + 4 + 8 + 8));
  Cursor counts(fields.raw(fields.u32()));
  std::map<std::uint16_t, std::uint64_t> messages;
  while (!counts.empty()) {
    const std::uint16_t channel = counts.u16();
    messages[channel] = counts.u64();
  }
  return messages;
}

/// @returns null for a file that is not encrypted
std::unique_ptr<DecryptedFile> decrypting(const StoredBytes& file, const FindRecordingKey& keys,
                                          Unreadable unreadable) {
  return is_encrypted(file) ? std::make_unique<DecryptedFile>(file, keys, unreadable) : nullptr;
}

}  // namespace

ReadableFile::ReadableFile(const std::filesystem::path& file, const FindRecordingKey& keys,
                           Unreadable unreadable)
    : stored_(file), decrypted_(decrypting(stored_, keys, unreadable)) {}

ReadableFile::ReadableFile(InMemory memory, const FindRecordingKey& keys, Unreadable unreadable)
    : stored_(memory), decrypted_(decrypting(stored_, keys, unreadable)) {}

ReadableFile::~ReadableFile() = default;

std::uint64_t ReadableFile::size() const noexcept { return decrypted_ ? decrypted_->size() : stored_.size(); }

void ReadableFile::read(std::uint64_t place, std::uint64_t length, std::string& out) const {
  if (decrypted_)
    decrypted_->read(place, length, out);
  else
    stored_.read(place, length, out);
}

std::vector<Damage> ReadableFile::undecrypted() const {
  return decrypted_ ? decrypted_->damages() : std::vector<Damage>();
}

void read_record(const ReadableFile& file, std::uint64_t place, Record& record) {
  std::string head;
  file.read(place, kRecordHead, head);
  if (head.size() < kRecordHead) throw McapError("the file ends in the head of a record");
  Cursor fields(head);
  record.op = static_cast<Op>(fields.u8());
  record.place = place;
  const std::uint64_t length = fields.u64();
  if (length > file.size() - place - kRecordHead)
    throw McapError("a record is longer than the rest of the file");
  if (length > kMostBytes)
    throw McapError(fmt::format("a record has {} bytes; at most {} are read", length, kMostBytes));
  file.read(place + kRecordHead, length, record.content);
  if (record.content.size() != length) throw McapError("the file ends in a record");
}

Schema parse_schema(std::string_view content) {
  Cursor fields(content);
  Schema schema;
  schema.id = fields.u16();
  schema.name = fields.text();
  schema.encoding = fields.text();
  schema.data = fields.text();
  if (schema.id == 0) throw McapError("a schema has the number 0");
  return schema;
}

Channel parse_channel(std::string_view content) {
  Cursor fields(content);
  Channel channel;
  channel.id = fields.u16();
  channel.schema = fields.u16();
  channel.topic = fields.text();
  channel.message_encoding = fields.text();
  static_cast<void>(fields.map());
  return channel;
}

ChunkReader::ChunkReader() : context_(::ZSTD_createDCtx()) {
  if (context_ == nullptr) throw std::bad_alloc();
}

ChunkReader::~ChunkReader() { ::ZSTD_freeDCtx(context_); }

void ChunkReader::read(std::string_view content, Chunk& chunk) {
  Cursor fields(content);
  chunk.first = fields.u64();
  chunk.last = fields.u64();
  const std::uint64_t size = fields.u64();
  const std::uint32_t crc = fields.u32();
  chunk.compression = fields.text();
  const std::string_view packed = fields.raw(fields.u64());
  chunk.compressed = packed.size();
  if (size > kMostBytes)
    throw McapError(fmt::format("a chunk has {} bytes; at most {} are read", size, kMostBytes));
  if (chunk.compression.empty()) {
    chunk.records = packed;
  } else if (chunk.compression == "zstd") {
    // The frame's own word on its size comes first: it must not be trusted, but it saves the memory of a chunk that lies.
    if (::ZSTD_getFrameContentSize(packed.data(), packed.size()) != size)
      throw McapError("a chunk does not have the size that it states");
    chunk.records.resize(static_cast<std::size_t>(size));
    const std::size_t got = ::ZSTD_decompressDCtx(context_, chunk.records.data(), chunk.records.size(),
                                                  packed.data(), packed.size());
    if (::ZSTD_isError(got) != 0 || got != size) throw McapError("a chunk cannot be decompressed");
  } else {
    throw McapError(
        fmt::format("a chunk is compressed by '{}'; only zstd is known", chunk.compression.substr(0, 40)));
  }
  if (chunk.records.size() != size) throw McapError("a chunk does not have the size that it states");
  if (crc != 0 && crc32_of(chunk.records) != crc) throw McapError("a chunk's checksum is wrong");
}

McapReader::McapReader(const ReadableFile& file) : file_(file) {
  if (!begins_as_mcap(file_)) throw McapError("it does not begin as an MCAP file");
  place_ = kMagic.size();
  if (has_end(file_)) summary_ = read_summary(file_);
}

std::string_view McapReader::schema_of(std::uint16_t channel) const noexcept {
  const auto found = channels_.find(channel);
  if (found == channels_.end()) return {};
  const auto schema = schemas_.find(found->second.schema);
  return schema == schemas_.end() ? std::string_view() : schema->second.name;
}

/// The end is where the summary says that it is, and no chunk is missing: a damaged operation code hides nothing.
void McapReader::check_end() const {
  if (!summary_ || record_.end() != summary_->begin) throw McapError("the data end before the file does");
  if (chunks_read_ != summary_->chunks.size())
    throw McapError(
        fmt::format("{} chunks are there, and its index has {}", chunks_read_, summary_->chunks.size()));
}

void McapReader::read_other(Op op, std::string_view content, bool in_chunk) {
  if (op != Op::kSchema && op != Op::kChannel && (op != Op::kMetadata || in_chunk)) return;
  described_ += content.size();
  if (described_ > kMostDescription)
    throw McapError(fmt::format("schemas, channels and metadata have more than {} bytes", kMostDescription));
  if (op == Op::kSchema) {
    Schema schema = parse_schema(content);
    schemas_.insert_or_assign(schema.id, std::move(schema));
  } else if (op == Op::kChannel) {
    Channel channel = parse_channel(content);
    channels_.insert_or_assign(channel.id, std::move(channel));
  } else if (op == Op::kMetadata) {
    Cursor fields(content);
    const std::string name(fields.text());
    metadata_.insert_or_assign(name, fields.map());
  }
}

/// @returns false at the end of the data
bool McapReader::next_chunk() {
  for (;;) {
    if (place_ >= file_.size())
      throw McapError("it has no end: the program or the machine stopped while it was written");
    read_record(file_, place_, record_);
    place_ = record_.end();
    if (record_.op == Op::kDataEnd || record_.op == Op::kFooter) {
      check_end();
      return false;
    }
    if (record_.op != Op::kChunk) {
      read_other(record_.op, record_.content, false);
      continue;
    }
    chunk_place_ = record_.place;
    ++chunks_read_;
    chunks_.read(record_.content, chunk_);
    rest_ = chunk_.records;
    return true;
  }
}

bool McapReader::next(Message& message) {
  try {
    for (;;) {
      while (rest_.empty()) {
        if (!next_chunk()) {
          place_ = file_.size();
          rest_ = {};
          return false;
        }
      }
      Cursor rest(rest_);
      const auto op = static_cast<Op>(rest.u8());
      const std::string_view content = rest.raw(rest.u64());
      rest_ = rest.rest();
      if (op != Op::kMessage) {
        read_other(op, content, true);
        continue;
      }
      message = parse_message(content);
      if (!channels_.contains(message.channel))
        throw McapError("a message is of a channel that was not declared");
      return true;
    }
  } catch (const McapError& error) {
    throw McapError(fmt::format("at byte {}: {}", rest_.empty() ? place_ : chunk_place_, error.what()));
  }
}

Summary read_summary(const ReadableFile& file) {
  if (!has_end(file)) throw McapError("it has no end");
  const std::uint64_t footer_at = file.size() - kMagic.size() - kFooterBytes;
  Record record;
  read_record(file, footer_at, record);
  Cursor footer(record.content);
  const std::uint64_t begin = footer.u64();
  static_cast<void>(footer.u64());
  const std::uint32_t crc = footer.u32();
  if (begin < kMagic.size() || begin > footer_at || footer_at - begin > kMostBytes)
    throw McapError("its footer names no summary");
  std::string section;
  file.read(begin, footer_at - begin + kFooterBytes - 4, section);
  if (crc != 0 && crc32_of(section) != crc) throw McapError("its summary's checksum is wrong");
  Summary summary;
  summary.begin = begin;
  Cursor rest(std::string_view(section).substr(0, static_cast<std::size_t>(footer_at - begin)));
  while (!rest.empty()) {
    const auto op = static_cast<Op>(rest.u8());
    const std::string_view content = rest.raw(rest.u64());
    if (op == Op::kSchema) summary.schemas.push_back(parse_schema(content));
    if (op == Op::kChannel) summary.channels.push_back(parse_channel(content));
    if (op == Op::kChunkIndex) summary.chunks.push_back(parse_chunk_index(content));
    if (op == Op::kStatistics) summary.messages = parse_message_counts(content);
  }
  return summary;
}

namespace {

/// Head of a Chunk record. Its messages are not read. @param place  of the record
ChunkEntry chunk_entry(Cursor& fields, std::uint64_t place, std::uint64_t length) {
  ChunkEntry entry;
  entry.place = place;
  entry.length = kRecordHead + length;
  entry.first = fields.u64();
  entry.last = fields.u64();
  entry.uncompressed = fields.u64();
  static_cast<void>(fields.u32());  // checksum
  entry.compression = fields.text();
  entry.compressed = fields.u64();
  return entry;
}

}  // namespace

Summary summarise_until(const ReadableFile& file, std::uint64_t until) {
  constexpr std::uint64_t kSeen = 128;  ///< of each record; the head of a chunk or of an index needs less
  if (!begins_as_mcap(file)) throw McapError("it does not begin as an MCAP file");
  if (until > file.size())
    throw McapError(fmt::format("it has {} bytes, and {} were asked for", file.size(), until));
  Summary summary;
  std::map<std::uint16_t, std::uint64_t> in_last;  ///< messages of the last chunk
  const auto end_chunk = [&] {
    for (const auto& [channel, count] : std::exchange(in_last, {})) summary.messages[channel] += count;
  };
  std::uint64_t described = 0;
  std::string seen;
  Record record;
  std::uint64_t place = kMagic.size();
  bool cut_index = false;
  while (place < until) {
    file.read(place, kSeen, seen);
    Cursor fields(seen);
    const auto op = static_cast<Op>(fields.u8());
    cut_index = op == Op::kMessageIndex;
    if (until - place < kRecordHead) break;
    const std::uint64_t length = fields.u64();
    if (length > until - place - kRecordHead) break;
    cut_index = false;
    if (op == Op::kSchema || op == Op::kChannel || op == Op::kMetadata) {
      described += length;
      if (described > kMostDescription)
        throw McapError(
            fmt::format("schemas, channels and metadata have more than {} bytes", kMostDescription));
      read_record(file, place, record);
      if (op == Op::kSchema) summary.schemas.push_back(parse_schema(record.content));
      if (op == Op::kChannel) {
        summary.channels.push_back(parse_channel(record.content));
        summary.messages[summary.channels.back().id] = 0;
      }
      if (op == Op::kMetadata)
        summary.metadata.push_back({.place = place,
                                    .length = kRecordHead + length,
                                    .name = std::string(Cursor(record.content).text())});
    } else if (op == Op::kChunk) {
      end_chunk();
      summary.chunks.push_back(chunk_entry(fields, place, length));
    } else if (op == Op::kMessageIndex) {
      if (summary.chunks.empty()) throw McapError("an index comes before the first chunk");
      const std::uint16_t channel = fields.u16();
      in_last[channel] += fields.u32() / 16;  // bytes of an entry: time and offset
      summary.chunks.back().index[channel] = place;
      summary.chunks.back().index_length += kRecordHead + length;
    } else if (op != Op::kHeader) {
      throw McapError(fmt::format("its data end at byte {}, before byte {}", place, until));
    }
    place += kRecordHead + length;
  }
  if (cut_index && !summary.chunks.empty()) {
    place = summary.chunks.back().place;
    summary.chunks.pop_back();
  } else {
    end_chunk();
  }
  summary.begin = place;
  return summary;
}

bool begins_as_mcap(const ReadableFile& file) {
  std::string magic;
  file.read(0, kMagic.size(), magic);
  return magic == kMagic;
}

bool has_end(const ReadableFile& file) {
  std::string tail;
  const std::uint64_t length = kFooterBytes + kMagic.size();
  if (file.size() < kMagic.size() + length) return false;
  file.read(file.size() - length, length, tail);
  return tail.size() == length && tail[0] == static_cast<char>(Op::kFooter) && tail.ends_with(kMagic);
}

}  // namespace phalanx::mcap
