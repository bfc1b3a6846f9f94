// SPDX-License-Identifier: Apache-2.0
#include "record/mcap/mcap_repair.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

namespace phalanx::mcap {
namespace {

/// @returns the ciphertext of a whole frame with its tag
std::string_view body_of(std::string_view frame) noexcept {
  return frame.substr(kFrameHead, frame.size() - kFrameHead - 4);
}

constexpr std::uint64_t kBlock = 1U << 20U;  ///< read at once while a chunk is searched for [bytes]

/// The repair of one file: reads one after the other, writes one after the other.
class Repair {
 public:
  Repair(const ReadableFile& from, WritableFile& to) : from_(from), to_(to) {}

  Repaired run() {
    std::string magic;
    from_.read(0, kMagic.size(), magic);
    if (magic != kMagic) throw McapError("it does not begin as an MCAP file");
    write(begin_of_file());
    describe_from_summary();
    std::uint64_t place = kMagic.size();
    while (place < from_.size()) {
      try {
        read_record(from_, place, record_);
        if (is_end()) {
          result_.had_end = true;
          break;
        }
        keep();
        place = record_.end();
      } catch (const McapError& error) {
        const std::uint64_t next = next_chunk(place + 1);
        damaged(place, next - place, error.what());
        place = next;
      }
    }
    end_chunk();
    flush();
    name_missing_chunks();
    write(end_of_file(result_.summary, place_));
    flush();
    to_.truncate(place_);
    to_.synchronise();
    return std::move(result_);
  }

 private:
  /// Takes schemas and channels from the file's summary: those at its beginning may be damaged.
  void describe_from_summary() {
    try {
      old_ = read_summary(from_);
    } catch (const McapError&) {
      return;  // it has none
    }
    Bytes out;
    for (const Schema& schema : old_->schemas)
      if (add(schema)) put_schema(out, schema);
    for (const Channel& channel : old_->channels)
      if (add(channel)) put_channel(out, channel);
    write(out);
  }

  /// @returns false if the summary has the schema already
  bool add(const Schema& schema) {
    const auto same = [&](const Schema& other) { return other.id == schema.id; };
    if (std::any_of(result_.summary.schemas.begin(), result_.summary.schemas.end(), same)) return false;
    result_.summary.schemas.push_back(schema);
    return true;
  }
  bool add(const Channel& channel) {
    const auto same = [&](const Channel& other) { return other.id == channel.id; };
    if (std::any_of(result_.summary.channels.begin(), result_.summary.channels.end(), same)) return false;
    result_.summary.channels.push_back(channel);
    result_.summary.messages.emplace(channel.id, 0);
    return true;
  }

  /// @returns true at the end of the data, which is where the file's summary says that it is
  [[nodiscard]] bool is_end() const {
    if (record_.op != Op::kDataEnd && record_.op != Op::kFooter) return false;
    if (old_ && record_.op == Op::kDataEnd && record_.end() == old_->begin) return true;
    throw McapError("the data end before the file does");
  }

  /// Names the chunks that the old file's index has, and that were not found: their records are damaged.
  void name_missing_chunks() {
    if (!old_) return;
    const auto is_named = [&](std::uint64_t place) {
      return std::any_of(result_.damages.begin(), result_.damages.end(), [&](const Damage& damage) {
        return damage.place <= place && place < damage.place + damage.length;
      });
    };
    for (const ChunkEntry& chunk : old_->chunks)
      if (!found_.contains(chunk.place) && !is_named(chunk.place))
        result_.damages.push_back({.place = chunk.place,
                                   .length = chunk.length,
                                   .what = "the index has a chunk here, and there is none"});
  }

  /// Collects what is written: a chunk and its indexes are one write, and so one frame of an encrypted file.
  void write(const Bytes& bytes) {
    written_.insert(written_.end(), bytes.begin(), bytes.end());
    place_ += bytes.size();
  }

  void flush() {
    to_.write(place_ - written_.size(), view_of(written_));
    written_.clear();
  }

  /// Writes the record as it is.
  void copy() {
    Bytes out;
    const std::size_t record = begin_record(out, record_.op);
    put_raw(out, record_.content);
    end_record(out, record);
    write(out);
  }

  /// Checks the record and writes it. @throws McapError; nothing has been written then
  void keep() {
    switch (record_.op) {
      case Op::kHeader:
        return;  // it is written already
      case Op::kSchema:
        if (add(parse_schema(record_.content))) copy();
        return;
      case Op::kChannel:
        if (add(parse_channel(record_.content))) copy();
        return;
      case Op::kMetadata: {
        Cursor fields(record_.content);
        std::string name(fields.text());
        static_cast<void>(fields.map());
        result_.summary.metadata.push_back(
            {.place = place_, .length = kRecordHead + record_.content.size(), .name = std::move(name)});
        return copy();
      }
      case Op::kChunk:
        return keep_chunk();
      case Op::kMessageIndex:
        return keep_index();
      case Op::kChunkIndex:
      case Op::kStatistics:
      case Op::kMetadataIndex:
      case Op::kSummaryOffset:
        return;  // of a summary whose beginning was lost
      default:
        throw McapError("a record of a kind that is not known");
    }
  }

  void keep_chunk() {
    ChunkEntry entry;
    Cursor fields(record_.content);
    entry.first = fields.u64();
    entry.last = fields.u64();
    entry.uncompressed = fields.u64();
    static_cast<void>(fields.u32());
    entry.compression = fields.text();
    entry.compressed = fields.u64();
    if (fields.rest().size() != entry.compressed || entry.last < entry.first)
      throw McapError("a chunk whose lengths or times contradict each other");
    const bool known = entry.compression.empty() || entry.compression == "zstd";
    std::map<std::uint16_t, Bytes> indexes;
    if (known) {
      reader_.read(record_.content, chunk_);
      for_each_message(
          chunk_.records,
          [&](const Message& message, std::uint64_t offset) {
            Bytes& index = indexes[message.channel];
            put(index, message.time);
            put(index, offset);
          },
          [&](Op op, std::string_view content) {
            if (op == Op::kSchema) add(parse_schema(content));
            if (op == Op::kChannel) add(parse_channel(content));
          });
    }
    end_chunk();
    flush();
    found_.insert(record_.place);
    entry.place = place_;
    entry.length = kRecordHead + record_.content.size();
    copy();
    open_ = std::move(entry);
    own_index_ = known;
    for (const auto& [channel, places] : indexes) put_index(channel, view_of(places));
  }

  /// Copies the index of a chunk that cannot be read. Other chunks get a new index.
  void keep_index() {
    if (!open_ || own_index_) return;
    Cursor fields(record_.content);
    const std::uint16_t channel = fields.u16();
    const std::string_view places = fields.text();
    if (places.size() % 16 != 0) throw McapError("an index whose length is wrong");
    put_index(channel, places);
  }

  void put_index(std::uint16_t channel, std::string_view places) {
    Bytes out;
    const std::size_t record = begin_record(out, Op::kMessageIndex);
    put(out, channel);
    put(out, places);
    end_record(out, record);
    open_->index[channel] = place_;
    open_->index_length += out.size();
    result_.summary.messages[channel] += places.size() / 16;
    write(out);
  }

  void end_chunk() {
    if (open_) result_.summary.chunks.push_back(std::move(*open_));
    open_.reset();
  }

  void damaged(std::uint64_t place, std::uint64_t length, std::string what) {
    end_chunk();
    result_.damages.push_back({.place = place, .length = length, .what = std::move(what)});
  }

  /// Searches for a chunk whose checksum is right. @returns its place, or the file's end
  [[nodiscard]] std::uint64_t next_chunk(std::uint64_t place) {
    std::string block;
    Record candidate;
    while (place < from_.size()) {
      from_.read(place, kBlock + kHead, block);
      const std::size_t heads =
          block.size() < kHead ? 0 : std::min<std::size_t>(kBlock, block.size() - kHead + 1);
      for (std::size_t i = block.find(static_cast<char>(Op::kChunk)); i < heads;
           i = block.find(static_cast<char>(Op::kChunk), i + 1))
        if (is_chunk(place + i, std::string_view(block).substr(i, kHead), candidate)) return place + i;
      place += kBlock;
    }
    return from_.size();
  }

  /// @param head  the first bytes of what may be a chunk; they show most of the places that are none
  [[nodiscard]] bool is_chunk(std::uint64_t place, std::string_view head, Record& candidate) {
    Cursor fields(head);
    static_cast<void>(fields.u8());
    const std::uint64_t length = fields.u64();
    const std::uint64_t first = fields.u64();
    const std::uint64_t last = fields.u64();
    const std::uint64_t size = fields.u64();
    static_cast<void>(fields.u32());
    if (length > from_.size() - place - kRecordHead || last < first || size > kMostBytes || size == 0)
      return false;
    const std::uint32_t name = fields.u32();
    if (name != 0 && (name != 4 || fields.raw(4) != "zstd")) return false;
    if (length > budget_) return false;  // a file that is made to be slow
    budget_ -= length;
    try {
      read_record(from_, place, candidate);
      reader_.read(candidate.content, chunk_);
      return true;
    } catch (const McapError&) {
      return false;
    }
  }

  /// Bytes of a chunk's record that are looked at first: its head, times, size, checksum, and the compression's name.
  static constexpr std::size_t kHead = kRecordHead + 8 + 8 + 8 + 4 + 4 + 4;

  const ReadableFile& from_;
  WritableFile& to_;
  std::optional<Summary> old_;                            ///< of `from_`; none: it has no end
  std::set<std::uint64_t> found_;                         ///< places of chunks in `from_`
  std::uint64_t budget_ = 2 * from_.size() + kMostBytes;  ///< bytes of records that may be tried in a search
  std::uint64_t place_ = 0;                               ///< in `to_`, with what is in `written_`
  Bytes written_;                                         ///< and not in `to_` yet
  Record record_;
  ChunkReader reader_;
  Chunk chunk_;
  std::optional<ChunkEntry> open_;  ///< the newest chunk, whose indexes follow
  bool own_index_ = false;
  Repaired result_;
};

}  // namespace

Repaired repair(const ReadableFile& from, WritableFile& to) { return Repair(from, to).run(); }

KeptFrames keep_whole_frames(const StoredBytes& from, WritableFile& to) {
  std::string bytes;
  from.read(0, 2 * kEncryptedHead, bytes);
  if (!begins_as_encrypted(bytes)) throw McapError("it does not begin as an encrypted recording");
  const Bytes head = begin_of_encrypted(parse_encrypted_head(bytes));
  to.write(0, view_of(head));
  std::uint64_t place = head.size();
  KeptFrames result;
  FrameWalk walk(from);
  Frame frame;
  while (walk.next(frame)) {
    from.read(frame.stored, frame.head.stored(), bytes);
    if (bytes.size() != frame.head.stored() || crc32_of(body_of(bytes)) != frame.head.body_crc) {
      result.damages.push_back(
          {.place = frame.stored, .length = frame.head.stored(), .what = "a frame's checksum is wrong"});
      continue;
    }
    to.write(place, bytes);
    place += bytes.size();
    ++result.frames;
    result.had_end = frame.head.last;
  }
  to.truncate(place);
  to.synchronise();
  result.damages.insert(result.damages.end(), walk.damages().begin(), walk.damages().end());
  std::sort(result.damages.begin(), result.damages.end(),
            [](const Damage& a, const Damage& b) { return a.place < b.place; });
  return result;
}

}  // namespace phalanx::mcap
