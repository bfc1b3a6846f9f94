// SPDX-License-Identifier: Apache-2.0
// A recording with other content, for what a program must not believe.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "record/mcap/mcap_reader.h"
#include "record/mcap/mcap_writer.h"

namespace phalanx::testing {

/// Copies a plain recording, with `from` replaced by `to` in each message. Both have the same length, so that the
/// messages stay readable; all checksums are those of the new content.
/// @returns the replacements
inline int copy_changed(const std::filesystem::path& recording, const std::filesystem::path& copy,
                        const std::string& from, const std::string& to) {
  struct Kept {
    std::uint16_t channel = 0;
    std::uint64_t time = 0;
    std::string data;
  };
  const mcap::ReadableFile file(recording);
  mcap::McapReader reader(file);
  std::vector<Kept> kept;
  int replaced = 0;
  for (mcap::Message message; reader.next(message);) {
    kept.push_back({.channel = message.channel, .time = message.time, .data = std::string(message.data)});
    std::string& data = kept.back().data;
    for (std::size_t at = data.find(from); at != std::string::npos; at = data.find(from, at + to.size())) {
      data.replace(at, from.size(), to);
      ++replaced;
    }
  }
  std::vector<mcap::Schema> schemas;
  for (const auto& [id, schema] : reader.schemas()) schemas.push_back(schema);
  std::vector<mcap::Channel> channels;
  for (const auto& [id, channel] : reader.channels()) channels.push_back(channel);
  mcap::DiskFile out(copy);
  mcap::McapWriter writer(out, schemas, channels, reader.metadata());
  constexpr std::size_t kChunk = 1U << 20U;
  for (const Kept& message : kept) {
    writer.add(message.channel, message.time, message.data);
    if (writer.open_bytes() > kChunk) writer.write_chunk();
  }
  writer.finish();
  return replaced;
}

}  // namespace phalanx::testing
