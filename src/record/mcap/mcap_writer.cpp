// SPDX-License-Identifier: Apache-2.0
#include "record/mcap/mcap_writer.h"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <new>
#include <utility>

namespace phalanx::mcap {
namespace {

constexpr int kLevel =
    1;  ///< of zstd: each further level costs more time than the bytes that it saves are worth

void put_offset(Bytes& out, Op group, std::uint64_t begin, std::uint64_t end) {
  if (begin == end) return;
  const std::size_t record = begin_record(out, Op::kSummaryOffset);
  put(out, static_cast<std::uint8_t>(group));
  put(out, begin);
  put(out, end - begin);
  end_record(out, record);
}

void put_statistics(Bytes& out, const Summary& summary) {
  std::uint64_t first = summary.chunks.empty() ? 0 : summary.chunks.front().first;
  std::uint64_t last = 0;
  for (const ChunkEntry& chunk : summary.chunks) {
    first = std::min(first, chunk.first);
    last = std::max(last, chunk.last);
  }
  std::uint64_t messages = 0;
  for (const auto& [channel, count] : summary.messages) messages += count;
  const std::size_t record = begin_record(out, Op::kStatistics);
  put(out, messages);
  put(out, static_cast<std::uint16_t>(summary.schemas.size()));
  put(out, static_cast<std::uint32_t>(summary.channels.size()));
  put(out, std::uint32_t{0});  // attachments
  put(out, static_cast<std::uint32_t>(summary.metadata.size()));
  put(out, static_cast<std::uint32_t>(summary.chunks.size()));
  put(out, first);
  put(out, last);
  put(out, static_cast<std::uint32_t>(10 * summary.messages.size()));
  for (const auto& [channel, count] : summary.messages) {
    put(out, channel);
    put(out, count);
  }
  end_record(out, record);
}

void put_chunk_index(Bytes& out, const ChunkEntry& chunk) {
  const std::size_t record = begin_record(out, Op::kChunkIndex);
  put(out, chunk.first);
  put(out, chunk.last);
  put(out, chunk.place);
  put(out, chunk.length);
  put(out, static_cast<std::uint32_t>(10 * chunk.index.size()));
  for (const auto& [channel, place] : chunk.index) {
    put(out, channel);
    put(out, place);
  }
  put(out, chunk.index_length);
  put(out, std::string_view(chunk.compression));
  put(out, chunk.compressed);
  put(out, chunk.uncompressed);
  end_record(out, record);
}

}  // namespace

void put_schema(Bytes& out, const Schema& schema) {
  const std::size_t record = begin_record(out, Op::kSchema);
  put(out, schema.id);
  put(out, std::string_view(schema.name));
  put(out, std::string_view(schema.encoding));
  put(out, std::string_view(schema.data));
  end_record(out, record);
}

void put_channel(Bytes& out, const Channel& channel) {
  const std::size_t record = begin_record(out, Op::kChannel);
  put(out, channel.id);
  put(out, channel.schema);
  put(out, std::string_view(channel.topic));
  put(out, std::string_view(channel.message_encoding));
  put(out, Map{});
  end_record(out, record);
}

Bytes begin_of_file(std::string_view profile) {
  Bytes out;
  put_raw(out, kMagic);
  const std::size_t header = begin_record(out, Op::kHeader);
  put(out, profile);
  put(out, std::string_view("phalanx"));
  end_record(out, header);
  return out;
}

Bytes end_of_file(const Summary& summary, std::uint64_t place) {
  Bytes out;
  const std::size_t data_end = begin_record(out, Op::kDataEnd);
  put(out, std::uint32_t{0});  // no checksum of the data: each chunk has one
  end_record(out, data_end);
  const std::size_t summary_at = out.size();
  Bytes offsets;
  const auto group = [&](Op op, const auto& items, const auto& write) {
    const std::uint64_t begin = place + out.size();
    for (const auto& item : items) write(item);
    put_offset(offsets, op, begin, place + out.size());
  };
  group(Op::kSchema, summary.schemas, [&](const Schema& schema) { put_schema(out, schema); });
  group(Op::kChannel, summary.channels, [&](const Channel& channel) { put_channel(out, channel); });
  group(Op::kStatistics, std::array{0}, [&](int) { put_statistics(out, summary); });
  group(Op::kChunkIndex, summary.chunks, [&](const ChunkEntry& chunk) { put_chunk_index(out, chunk); });
  group(Op::kMetadataIndex, summary.metadata, [&](const Summary::MetadataEntry& entry) {
    const std::size_t record = begin_record(out, Op::kMetadataIndex);
    put(out, entry.place);
    put(out, entry.length);
    put(out, std::string_view(entry.name));
    end_record(out, record);
  });
  const std::uint64_t offsets_at = place + out.size();
  put_raw(out, view_of(offsets));
  const std::size_t footer = begin_record(out, Op::kFooter);
  put(out, place + summary_at);
  put(out, offsets_at);
  // The checksum covers the summary, its offsets, and the footer up to here; so the footer's length must stand already.
  for (std::size_t i = 0; i < 8; ++i) out[footer - 8 + i] = static_cast<char>(i == 0 ? 20 : 0);
  put(out, crc32_of(view_of(out).substr(summary_at)));
  end_record(out, footer);
  put_raw(out, kMagic);
  return out;
}

McapWriter::McapWriter(WritableFile& file, std::vector<Schema> schemas, std::vector<Channel> channels,
                       const std::map<std::string, Map>& metadata, std::string_view profile)
    : file_(file), context_(::ZSTD_createCCtx()) {
  if (context_ == nullptr) throw std::bad_alloc();
  ::ZSTD_CCtx_setParameter(context_, ZSTD_c_compressionLevel, kLevel);
  summary_.schemas = std::move(schemas);
  summary_.channels = std::move(channels);
  Bytes out = begin_of_file(profile);
  for (const Schema& schema : summary_.schemas) put_schema(out, schema);
  for (const Channel& channel : summary_.channels) {
    put_channel(out, channel);
    summary_.messages[channel.id] = 0;
  }
  for (const auto& [name, map] : metadata) {
    const std::size_t place = out.size();
    const std::size_t record = begin_record(out, Op::kMetadata);
    put(out, std::string_view(name));
    put(out, map);
    end_record(out, record);
    summary_.metadata.push_back({.place = place, .length = out.size() - place, .name = name});
  }
  try {
    file_.write(0, view_of(out));
    file_.synchronise();
  } catch (...) {
    ::ZSTD_freeCCtx(context_);
    throw;
  }
  place_ = out.size();
}

McapWriter::~McapWriter() { ::ZSTD_freeCCtx(context_); }

void McapWriter::add(std::uint16_t channel, std::uint64_t time, std::string_view data) {
  // What needs memory comes first: without it, nothing is added.
  const std::size_t begin = records_.size();
  auto& index = open_index_[channel];
  auto& sequence = sequence_[channel];
  index.emplace_back(time, begin);
  try {
    const std::size_t record = begin_record(records_, Op::kMessage);
    put(records_, channel);
    put(records_, sequence);
    put(records_, time);
    put(records_, time);
    put_raw(records_, data);
    end_record(records_, record);
  } catch (...) {
    records_.resize(begin);
    index.pop_back();
    throw;
  }
  ++sequence;
  first_ = begin == 0 ? time : std::min(first_, time);
  last_ = begin == 0 ? time : std::max(last_, time);
}

void McapWriter::compress() {
  if (records_.empty()) return;
  Bytes packed(::ZSTD_compressBound(records_.size()));
  const std::size_t length =
      ::ZSTD_compress2(context_, packed.data(), packed.size(), records_.data(), records_.size());
  if (::ZSTD_isError(length) != 0)
    throw std::runtime_error(fmt::format("zstd: {}", ::ZSTD_getErrorName(length)));
  ChunkEntry entry;
  entry.first = first_;
  entry.last = last_;
  entry.place = place_;
  entry.compression = "zstd";
  entry.compressed = length;
  entry.uncompressed = records_.size();
  Bytes block;
  block.reserve(length + records_.size() / 8 + 1000);
  const std::size_t chunk = begin_record(block, Op::kChunk);
  put(block, first_);
  put(block, last_);
  put(block, std::uint64_t{records_.size()});
  put(block, crc32_of(view_of(records_)));
  put(block, std::string_view(entry.compression));
  put(block, std::uint64_t{length});
  put_raw(block, {packed.data(), length});
  end_record(block, chunk);
  entry.length = block.size();
  std::map<std::uint16_t, std::uint64_t> messages;
  for (const auto& [channel, places] : open_index_) {
    if (places.empty()) continue;
    entry.index[channel] = place_ + block.size();
    const std::size_t record = begin_record(block, Op::kMessageIndex);
    put(block, channel);
    put(block, static_cast<std::uint32_t>(16 * places.size()));
    for (const auto& [time, offset] : places) {
      put(block, time);
      put(block, offset);
    }
    end_record(block, record);
    messages[channel] = places.size();
  }
  entry.index_length = block.size() - entry.length;
  if (summary_.chunks.size() == summary_.chunks.capacity())  // write_block() needs no memory
    summary_.chunks.reserve(std::max<std::size_t>(1024, 2 * summary_.chunks.size()));
  block_ = std::move(block);
  entry_ = std::move(entry);
  block_messages_ = std::move(messages);
  records_.clear();
  open_index_.clear();
}

void McapWriter::write_block() {
  if (block_.empty()) return;
  file_.write(place_, view_of(block_));
  file_.synchronise();
  place_ += block_.size();
  summary_.chunks.push_back(std::move(entry_));
  for (const auto& [channel, count] : block_messages_) summary_.messages[channel] += count;
  block_messages_.clear();
  block_.clear();
}

void McapWriter::write_chunk() {
  write_block();  // one that was refused before
  compress();
  write_block();
}

void McapWriter::finish() {
  write_chunk();
  const Bytes end = end_of_file(summary_, place_);
  file_.write(place_, view_of(end));
  file_.truncate(place_ + end.size());  // an earlier try may have left more
  file_.synchronise();
}

}  // namespace phalanx::mcap
