// SPDX-License-Identifier: Apache-2.0
// Lines from a glove and answers to it, through one file descriptor.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "device/descriptor.h"
#include "phalanx/device/opengloves/opengloves_codec.h"

namespace phalanx {

/// Line buffer that owns the descriptor. For one thread. It allocates nothing; only wait() waits.
class GloveWire {
 public:
  /// Makes the descriptor non-blocking.
  explicit GloveWire(int descriptor) noexcept;
  GloveWire(const GloveWire&) = delete;
  GloveWire& operator=(const GloveWire&) = delete;
  ~GloveWire();

  enum class Piece {
    kNone,     ///< no whole line for now
    kLine,     ///< line()
    kTooLong,  ///< a line of more than kLongestLine bytes has ended; its content is lost
  };
  [[nodiscard]] Piece next() noexcept;
  /// @returns the line without its line end; valid until the next call of next().
  [[nodiscard]] std::string_view line() const noexcept { return {line_.data(), line_size_}; }

  /// Sends an answer whole or not at all. Bytes that the system does not take now are written before the next
  /// answer. If that still fails, the next answer is dropped. @returns true if it was taken
  bool send(std::string_view answer) noexcept;
  /// Waits until something can be read, or the rest of an answer can be written. It waits at most one
  /// millisecond more than `seconds` of real time.
  void wait(double seconds) noexcept;
  /// @returns true if the port is gone (unplugged).
  [[nodiscard]] bool lost() const noexcept { return lost_; }

  static constexpr std::size_t kLongestLine = 512;

 private:
  void flush() noexcept;

  int descriptor_;
  bool lost_ = false;
  ReadBuffer<1024> in_;
  std::array<char, kLongestLine> line_{};
  std::size_t line_size_ = 0;
  bool line_ended_ = true;  ///< line_ was returned: the next byte begins a new one
  bool too_long_ = false;
  std::array<char, kGloveAnswerSize> out_{};
  std::size_t out_begin_ = 0;
  std::size_t out_end_ = 0;
};

}  // namespace phalanx
