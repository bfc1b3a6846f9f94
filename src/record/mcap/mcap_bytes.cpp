// SPDX-License-Identifier: Apache-2.0
#include "record/mcap/mcap_bytes.h"

#include <zlib.h>

#include <algorithm>

namespace phalanx::mcap {
namespace {

void put_number(Bytes& out, std::uint64_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) out.push_back(static_cast<char>(value >> (8U * i) & 0xffU));
}

}  // namespace

void put(Bytes& out, std::uint8_t value) { put_number(out, value, 1); }
void put(Bytes& out, std::uint16_t value) { put_number(out, value, 2); }
void put(Bytes& out, std::uint32_t value) { put_number(out, value, 4); }
void put(Bytes& out, std::uint64_t value) { put_number(out, value, 8); }

void put(Bytes& out, std::string_view text) {
  put(out, static_cast<std::uint32_t>(text.size()));
  put_raw(out, text);
}

void put(Bytes& out, const Map& map) {
  std::size_t bytes = 0;
  for (const auto& [key, value] : map) bytes += 8 + key.size() + value.size();
  put(out, static_cast<std::uint32_t>(bytes));
  for (const auto& [key, value] : map) {
    put(out, std::string_view(key));
    put(out, std::string_view(value));
  }
}

void put_raw(Bytes& out, std::string_view bytes) { out.insert(out.end(), bytes.begin(), bytes.end()); }

std::size_t begin_record(Bytes& out, Op op) {
  put(out, static_cast<std::uint8_t>(op));
  put(out, std::uint64_t{0});
  return out.size();
}

void end_record(Bytes& out, std::size_t begin) {
  const std::uint64_t length = out.size() - begin;
  for (std::size_t i = 0; i < 8; ++i) out[begin - 8 + i] = static_cast<char>(length >> (8U * i) & 0xffU);
}

std::uint64_t Cursor::number(std::size_t bytes) {
  const std::string_view from = raw(bytes);
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i)
    value |= static_cast<std::uint64_t>(static_cast<unsigned char>(from[i])) << (8U * i);
  return value;
}

std::string_view Cursor::raw(std::uint64_t length) {
  if (length > rest_.size()) throw McapError("a length is larger than the record that it is in");
  const std::string_view taken = rest_.substr(0, static_cast<std::size_t>(length));
  rest_.remove_prefix(static_cast<std::size_t>(length));
  return taken;
}

Map Cursor::map() {
  Cursor pairs(raw(u32()));
  Map map;
  while (!pairs.empty()) {
    const std::string_view key = pairs.text();
    map.emplace(key, pairs.text());
  }
  return map;
}

std::uint32_t crc32_of(std::string_view bytes, std::uint32_t before) noexcept {
  uLong crc = before;
  while (!bytes.empty()) {
    const std::size_t part = std::min<std::size_t>(bytes.size(), 1U << 30U);
    crc = ::crc32(crc, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(part));
    bytes.remove_prefix(part);
  }
  return static_cast<std::uint32_t>(crc);
}

}  // namespace phalanx::mcap
