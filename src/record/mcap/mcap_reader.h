// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/record/recording_keys.h"
#include "record/mcap/decrypted_file.h"
#include "record/mcap/mcap_bytes.h"
#include "record/mcap/mcap_writer.h"
#include "record/mcap/stored_bytes.h"

struct ZSTD_DCtx_s;

namespace phalanx::mcap {

/// Largest content of a record, and of a chunk once it is decompressed [bytes]. A larger one is refused: a file cannot make
/// the program use more memory.
inline constexpr std::uint64_t kMostBytes = 256U << 20U;
/// Largest sum of all schemas, channels and metadata of a file [bytes].
inline constexpr std::uint64_t kMostDescription = 16U << 20U;

/// An MCAP file, or bytes in memory, that is read at given places. An encrypted one is decrypted while it is read: places and
/// sizes are those of the MCAP file. Not for two threads at once.
class ReadableFile {
 public:
  /// @param keys  of encrypted files; may be empty
  /// @throws std::system_error if it cannot be opened; McapError if it is no regular file; NoKeyError if it is encrypted, and
  /// `keys` does not have its key
  explicit ReadableFile(const std::filesystem::path& file, const FindRecordingKey& keys = {},
                        Unreadable unreadable = Unreadable::kRefused);
  /// Reads from memory, which must outlive this object.
  explicit ReadableFile(InMemory memory, const FindRecordingKey& keys = {},
                        Unreadable unreadable = Unreadable::kRefused);
  ReadableFile(const ReadableFile&) = delete;
  ReadableFile& operator=(const ReadableFile&) = delete;
  ~ReadableFile();

  [[nodiscard]] std::uint64_t size() const noexcept;  ///< when it was opened
  /// Reads up to `length` bytes into `out`; fewer if the file ends before. @throws std::system_error, and McapError for a part
  /// that cannot be decrypted
  void read(std::uint64_t place, std::uint64_t length, std::string& out) const;
  [[nodiscard]] bool encrypted() const noexcept { return decrypted_ != nullptr; }
  /// @returns the parts of an encrypted file that could not be decrypted so far; places are those on the disk
  [[nodiscard]] std::vector<Damage> undecrypted() const;

 private:
  const StoredBytes stored_;
  const std::unique_ptr<DecryptedFile> decrypted_;  ///< null: not encrypted
};

/// A record at the top level of a file.
struct Record {
  Op op = Op::kHeader;
  std::uint64_t place = 0;  ///< of its head
  std::string content;

  [[nodiscard]] std::uint64_t end() const noexcept { return place + kRecordHead + content.size(); }
};

/// Reads the record at a place. @throws McapError if it does not fit into the file, or is larger than kMostBytes
void read_record(const ReadableFile& file, std::uint64_t place, Record& record);

[[nodiscard]] Schema parse_schema(std::string_view content);
[[nodiscard]] Channel parse_channel(std::string_view content);

/// A chunk whose checksum is right.
struct Chunk {
  std::uint64_t first = 0;  ///< time of its first message
  std::uint64_t last = 0;
  std::string compression;
  std::uint64_t compressed = 0;
  std::string records;  ///< decompressed
};

/// Decompresses chunks, in memory that it keeps.
class ChunkReader {
 public:
  ChunkReader();
  ChunkReader(const ChunkReader&) = delete;
  ChunkReader& operator=(const ChunkReader&) = delete;
  ~ChunkReader();

  /// @throws McapError if the content is no chunk, is larger than kMostBytes or does not have the checksum that it states
  void read(std::string_view content, Chunk& chunk);

 private:
  ZSTD_DCtx_s* context_;
};

[[nodiscard]] inline Message parse_message(std::string_view content) {
  Cursor fields(content);
  Message message;
  message.channel = fields.u16();
  message.sequence = fields.u32();
  message.time = fields.u64();
  static_cast<void>(fields.u64());  // publish_time, the same
  message.data = fields.rest();
  return message;
}

/// Calls `on_message(message, offset)` for each message of a chunk, and `on_other(op, content)` for its other records.
/// @throws McapError if a record does not fit
template <class OnMessage, class OnOther>
void for_each_message(std::string_view records, const OnMessage& on_message, const OnOther& on_other) {
  Cursor rest(records);
  std::uint64_t offset = 0;
  while (!rest.empty()) {
    const auto op = static_cast<Op>(rest.u8());
    const std::string_view content = rest.raw(rest.u64());
    if (op == Op::kMessage) {
      on_message(parse_message(content), offset);
    } else {
      on_other(op, content);
    }
    offset += kRecordHead + content.size();
  }
}

/// Reads all messages of a file in their order, from its beginning. Nothing in the file makes it use more memory than three
/// times kMostBytes. Not real-time.
class McapReader {
 public:
  /// @param file  outlives the reader
  /// @throws McapError if it does not begin as an MCAP file
  explicit McapReader(const ReadableFile& file);

  /// Reads the next message; its data is valid until the next call.
  /// @returns false at the end of the file's data
  /// @throws McapError naming the place of what is wrong. A file without an end is wrong: repair() ends it
  [[nodiscard]] bool next(Message& message);

  [[nodiscard]] const std::map<std::uint16_t, Schema>& schemas() const noexcept { return schemas_; }
  [[nodiscard]] const std::map<std::uint16_t, Channel>& channels() const noexcept { return channels_; }
  /// @returns the Metadata records that have been read so far
  [[nodiscard]] const std::map<std::string, Map>& metadata() const noexcept { return metadata_; }
  /// @returns the name of a channel's schema; empty: there is none
  [[nodiscard]] std::string_view schema_of(std::uint16_t channel) const noexcept;
  [[nodiscard]] std::uint64_t place() const noexcept { return place_; }  ///< read so far [bytes]

 private:
  void read_other(Op op, std::string_view content, bool in_chunk);
  void check_end() const;
  [[nodiscard]] bool next_chunk();

  const ReadableFile& file_;
  std::uint64_t place_ = 0;
  Record record_;
  ChunkReader chunks_;
  Chunk chunk_;
  std::uint64_t chunk_place_ = 0;
  std::string_view rest_;           ///< of the chunk
  std::optional<Summary> summary_;  ///< none: the file has no end
  std::size_t chunks_read_ = 0;
  std::uint64_t described_ = 0;  ///< bytes of schemas, channels and metadata
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::map<std::string, Map> metadata_;
};

/// Reads the summary at the file's end, without its chunks.
/// @throws McapError if the file has no end, or its summary's checksum is wrong
[[nodiscard]] Summary read_summary(const ReadableFile& file);

/// Collects the summary of what a file held when it had `until` bytes: of the whole chunks before that place, without the
/// contents of their messages. With end_of_file(summary, summary.begin) in the place of the rest it is a whole file, so a
/// recording can be read while it is written.
/// @param until  a place where the writer had closed a chunk, such as McapWriter::size(); elsewhere the last chunk may be
/// left out, or lack indexes
/// @throws McapError if it does not begin as an MCAP file, has fewer bytes, or has ended before
[[nodiscard]] Summary summarise_until(const ReadableFile& file, std::uint64_t until);

/// @returns true if the file begins as an MCAP file does
[[nodiscard]] bool begins_as_mcap(const ReadableFile& file);

/// @returns true if the file ends as a finished MCAP file does: with a footer and the magic
[[nodiscard]] bool has_end(const ReadableFile& file);

}  // namespace phalanx::mcap
