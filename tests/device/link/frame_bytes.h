// SPDX-License-Identifier: Apache-2.0
// A second, independent writer of frames: the tables of docs/link.md field by field, and a bitwise CRC.
#pragma once

#include <bit>
#include <cstdint>
#include <random>
#include <string_view>
#include <vector>

#include "phalanx/device/link/phalanx_link.h"

namespace phalanx::link_test {

using Bytes = std::vector<std::uint8_t>;

/// CRC-32 of IEEE 802.3, bit by bit from its definition.
inline std::uint32_t crc_of(const Bytes& bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? (crc >> 1) ^ 0xEDB88320U : crc >> 1;
  }
  return ~crc;
}

class FrameBytes {
 public:
  FrameBytes(std::uint8_t type, std::uint16_t size, std::uint32_t epoch, std::uint32_t sequence) {
    u8('P').u8('X').u8(1).u8(type).u16(size).u16(0).u32(epoch).u32(sequence);
  }
  FrameBytes& u8(int value) {
    bytes_.push_back(static_cast<std::uint8_t>(value));
    return *this;
  }
  FrameBytes& u16(std::uint16_t value) { return number(value, 2); }
  FrameBytes& u32(std::uint32_t value) { return number(value, 4); }
  FrameBytes& u64(std::uint64_t value) { return number(value, 8); }
  FrameBytes& i32(std::int32_t value) { return number(static_cast<std::uint32_t>(value), 4); }
  FrameBytes& f32(float value) { return u32(std::bit_cast<std::uint32_t>(value)); }
  FrameBytes& zeros(std::size_t count) {
    bytes_.insert(bytes_.end(), count, 0);
    return *this;
  }
  FrameBytes& text(std::string_view letters) {
    bytes_.insert(bytes_.end(), letters.begin(), letters.end());
    return *this;
  }
  /// The frame, closed with its CRC.
  [[nodiscard]] Bytes closed() {
    u32(crc_of(bytes_));
    return bytes_;
  }

 private:
  FrameBytes& number(std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) u8(static_cast<int>((value >> (8 * i)) & 0xFFU));
    return *this;
  }
  Bytes bytes_;
};

/// Puts the right CRC at the end of a frame that was changed.
inline void close_again(Bytes& frame) {
  frame.resize(frame.size() - PHX_CRC_SIZE);
  const std::uint32_t crc = crc_of(frame);
  for (int i = 0; i < 4; ++i) frame.push_back(static_cast<std::uint8_t>((crc >> (8 * i)) & 0xFFU));
}

inline Bytes encoded(const phx_message& message) {
  Bytes frame(phx_frame_size(message.header.type));
  frame.resize(phx_encode(&message, frame.data(), frame.size()));
  return frame;
}

inline constexpr std::uint8_t kAllTypes[] = {PHX_HELLO,   PHX_WELCOME, PHX_REFUSED,       PHX_CONFIGURE,
                                             PHX_SAMPLE,  PHX_COMMAND, PHX_COMMAND_WALLS, PHX_RESET,
                                             PHX_GOODBYE, PHX_PING,    PHX_PONG};

/// A valid message of a type with seeded numbers in every field.
phx_message random_message(std::uint8_t type, std::mt19937_64& random);

}  // namespace phalanx::link_test
