// SPDX-License-Identifier: Apache-2.0
// The bytes of an MCAP file (https://mcap.dev/spec, version 0): numbers are little-endian, a text or an array follows its
// length. A file is the magic, records (operation code, length, content), and the magic again.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace phalanx::mcap {

inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};
inline constexpr std::size_t kRecordHead = 9;  ///< bytes before a record's content: operation code, length

/// Operation codes of the records that are written or read here.
enum class Op : std::uint8_t {
  kHeader = 1,
  kFooter = 2,
  kSchema = 3,
  kChannel = 4,
  kMessage = 5,
  kChunk = 6,
  kMessageIndex = 7,
  kChunkIndex = 8,
  kStatistics = 11,
  kMetadata = 12,
  kMetadataIndex = 13,
  kSummaryOffset = 14,
  kDataEnd = 15,
};

/// A file, or a part of it, that is not what the specification says. what() names the part.
class McapError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

using Bytes = std::vector<char>;
using Map = std::map<std::string, std::string>;

// ---- writing: each appends to `out`
void put(Bytes& out, std::uint8_t value);
void put(Bytes& out, std::uint16_t value);
void put(Bytes& out, std::uint32_t value);
void put(Bytes& out, std::uint64_t value);
void put(Bytes& out, std::string_view text);  ///< with its length of 32 bits
void put(Bytes& out, const Map& map);
void put_raw(Bytes& out, std::string_view bytes);  ///< without a length
/// Begins a record. @returns the place that end_record() needs
[[nodiscard]] std::size_t begin_record(Bytes& out, Op op);
void end_record(Bytes& out, std::size_t begin);

/// Reads the content of a record from its beginning. Every function throws McapError if the content ends too early; no length
/// in the file is believed beyond it.
class Cursor {
 public:
  explicit Cursor(std::string_view content) : rest_(content) {}

  [[nodiscard]] std::uint8_t u8() { return static_cast<std::uint8_t>(number(1)); }
  [[nodiscard]] std::uint16_t u16() { return static_cast<std::uint16_t>(number(2)); }
  [[nodiscard]] std::uint32_t u32() { return static_cast<std::uint32_t>(number(4)); }
  [[nodiscard]] std::uint64_t u64() { return number(8); }
  [[nodiscard]] std::string_view text() { return raw(u32()); }
  [[nodiscard]] Map map();
  [[nodiscard]] std::string_view raw(std::uint64_t length);
  [[nodiscard]] std::string_view rest() { return raw(rest_.size()); }
  [[nodiscard]] bool empty() const noexcept { return rest_.empty(); }

 private:
  [[nodiscard]] std::uint64_t number(std::size_t bytes);

  std::string_view rest_;
};

/// @returns the checksum (CRC-32 of ISO 3309, as zlib's) of `bytes`, continued from `before`
[[nodiscard]] std::uint32_t crc32_of(std::string_view bytes, std::uint32_t before = 0) noexcept;

[[nodiscard]] inline std::string_view view_of(const Bytes& bytes) noexcept {
  return {bytes.data(), bytes.size()};
}

}  // namespace phalanx::mcap
