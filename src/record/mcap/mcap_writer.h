// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "record/mcap/mcap_bytes.h"
#include "record/mcap/mcap_file.h"

struct ZSTD_CCtx_s;

namespace phalanx::mcap {

/// Description of the messages of one or more channels.
struct Schema {
  std::uint16_t id = 0;  ///< from 1 on
  std::string name;      ///< "phalanx.wire.Step"
  std::string encoding;  ///< "protobuf": `data` is a FileDescriptorSet
  std::string data;
};

/// A sequence of messages of one schema.
struct Channel {
  std::uint16_t id = 0;
  std::uint16_t schema = 0;      ///< Schema::id
  std::string topic;             ///< "/step"
  std::string message_encoding;  ///< "protobuf"
};

/// One message. Its bytes belong to the reader or the caller.
struct Message {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;  ///< number in its channel
  std::uint64_t time = 0;      ///< log_time and publish_time: UTC [ns since 1970]
  std::string_view data;
};

/// Index of one chunk, as it stands in the summary.
struct ChunkEntry {
  std::uint64_t first = 0;  ///< time of its first message
  std::uint64_t last = 0;
  std::uint64_t place = 0;                       ///< of the chunk's record in the file
  std::uint64_t length = 0;                      ///< of the chunk's record, with its head
  std::map<std::uint16_t, std::uint64_t> index;  ///< places of the MessageIndex records, by channel
  std::uint64_t index_length = 0;                ///< of all of them
  std::string compression;
  std::uint64_t compressed = 0;
  std::uint64_t uncompressed = 0;
};

/// Contents of the summary at a file's end, collected while the file is written.
struct Summary {
  std::uint64_t begin = 0;  ///< its place in the file that it was read from
  std::vector<Schema> schemas;
  std::vector<Channel> channels;
  std::vector<ChunkEntry> chunks;
  struct MetadataEntry {
    std::uint64_t place = 0;
    std::uint64_t length = 0;
    std::string name;
  };
  std::vector<MetadataEntry> metadata;
  std::map<std::uint16_t, std::uint64_t> messages;  ///< numbers of messages, by channel
};

/// @returns the beginning of a file: magic and header. @param profile  "ros2": a bag of ROS 2; empty: none
[[nodiscard]] Bytes begin_of_file(std::string_view profile = {});

/// @returns the end of a file: DataEnd, summary, summary offsets, footer and magic.
/// @param place  where it begins in the file
[[nodiscard]] Bytes end_of_file(const Summary& summary, std::uint64_t place);

void put_schema(Bytes& out, const Schema& schema);
void put_channel(Bytes& out, const Channel& channel);

/// Writes an MCAP file chunk by chunk. What has been accepted by close_chunk() stays readable whatever happens later. One
/// thread. Not real-time.
///
/// If the disk refuses a chunk, the chunk is kept, and write_chunk() tries again at the same place: nothing that was
/// written before is touched.
class McapWriter {
 public:
  /// Writes the beginning: header, schemas, channels, metadata; and synchronises it.
  /// @param metadata  one Metadata record each, by name. They are not compressed, and are not in a chunk
  /// @param profile   as begin_of_file()
  /// @throws std::system_error
  McapWriter(WritableFile& file, std::vector<Schema> schemas, std::vector<Channel> channels,
             const std::map<std::string, Map>& metadata, std::string_view profile = {});
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;
  ~McapWriter();

  /// Adds a message to the chunk that is open. @throws std::bad_alloc; nothing is added then
  void add(std::uint16_t channel, std::uint64_t time, std::string_view data);
  /// @returns the uncompressed bytes of the open chunk
  [[nodiscard]] std::size_t open_bytes() const noexcept { return records_.size(); }
  /// Compresses the open chunk, writes it with its indexes, and synchronises. Without messages it does nothing.
  /// @throws std::system_error; the chunk then stays pending
  void write_chunk();
  /// @returns true if a chunk is compressed, but not on the disk yet
  [[nodiscard]] bool pending() const noexcept { return !block_.empty(); }
  /// Writes the rest and the end of the file. Nothing may be added afterwards. @throws std::system_error; may be repeated
  void finish();

  [[nodiscard]] std::uint64_t size() const noexcept {
    return place_;
  }  ///< of what is on the disk for good [bytes]
  [[nodiscard]] const Summary& summary() const noexcept { return summary_; }

 private:
  void compress();
  void write_block();

  WritableFile& file_;
  Summary summary_;
  std::uint64_t place_ = 0;  ///< where the next chunk begins
  Bytes records_;            ///< of the open chunk
  std::uint64_t first_ = 0;
  std::uint64_t last_ = 0;
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>>
      open_index_;  ///< times and offsets
  std::map<std::uint16_t, std::uint32_t> sequence_;
  Bytes block_;       ///< a chunk with its indexes, not yet on the disk
  ChunkEntry entry_;  ///< of `block_`
  std::map<std::uint16_t, std::uint64_t> block_messages_;
  ZSTD_CCtx_s* context_;
};

}  // namespace phalanx::mcap
