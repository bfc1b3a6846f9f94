// SPDX-License-Identifier: Apache-2.0
// Reading a recording's messages one after the other.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "record/mcap/mcap_reader.h"
#include "record/recording/topics.h"

namespace phalanx {

/// Parses a message. @returns false if it does not match its schema, or is larger than largest_message()
template <class Wire>
[[nodiscard]] bool parsed(const mcap::Message& message, Wire& into) {
  return message.data.size() <= largest_message(into) &&
         into.ParseFromArray(message.data.data(), static_cast<int>(message.data.size()));
}

/// @returns a value of the file's metadata, such as "version"; empty: it is not there, or not read yet
[[nodiscard]] inline std::string metadata_of(const mcap::McapReader& reader, const std::string& key) {
  const auto phalanx = reader.metadata().find("phalanx");
  if (phalanx == reader.metadata().end()) return {};
  const auto value = phalanx->second.find(key);
  return value == phalanx->second.end() ? std::string() : value->second;
}

/// Calls `on_message(schema, message, time)` for each message of a recording; the time is that since its beginning [s].
/// @param on_progress  gets the part that is read, 0 .. 1; may be empty
/// @param keys  of encrypted recordings; may be empty
/// @throws std::runtime_error naming the place and the remedy if the file is not whole, or is encrypted and without its key
template <class OnMessage>
void for_each_message_of(const std::filesystem::path& name, const std::function<void(double)>& on_progress,
                         const FindRecordingKey& keys, OnMessage on_message) {
  try {
    const mcap::ReadableFile file(name, keys);
    mcap::McapReader reader(file);
    mcap::Message message;
    std::optional<std::uint64_t> begin;
    std::uint64_t told = 0;
    while (reader.next(message)) {
      if (!begin) begin = message.time;
      const std::uint64_t since = message.time > *begin ? message.time - *begin : 0;
      on_message(reader.schema_of(message.channel), message, 1e-9 * static_cast<double>(since));
      if (on_progress && reader.place() >= told) {
        on_progress(static_cast<double>(reader.place()) /
                    static_cast<double>(std::max<std::uint64_t>(1, file.size())));
        told = reader.place() + file.size() / 200;
      }
    }
  } catch (const mcap::McapError& error) {
    throw std::runtime_error(
        fmt::format("{}: {}; phalanx session repair FILE keeps what is whole", name.string(), error.what()));
  } catch (const mcap::NoKeyError& error) {
    throw std::runtime_error(fmt::format("{}: {}", name.string(), error.what()));
  } catch (const std::system_error& error) {
    throw std::runtime_error(fmt::format("{}: cannot be read ({})", name.string(), error.code().message()));
  }
}

}  // namespace phalanx
