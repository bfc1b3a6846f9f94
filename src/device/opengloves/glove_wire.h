// SPDX-License-Identifier: Apache-2.0
// Lines from a glove, answers to it, through one file descriptor.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "phalanx/device/opengloves/opengloves_codec.h"

namespace phalanx {

/// Owns the descriptor. One thread uses it. No allocation; only wait() waits.
class GloveWire {
 public:
  /// Makes it non-blocking.
  explicit GloveWire(int descriptor) noexcept;
  GloveWire(const GloveWire&) = delete;
  GloveWire& operator=(const GloveWire&) = delete;
  ~GloveWire();

  enum class Piece {
    kNone,     ///< no whole line for now
    kLine,     ///< line()
    kTooLong,  ///< a line of more than kLongestLine bytes has ended; what it said is lost
  };
  [[nodiscard]] Piece next() noexcept;
  /// Without its line end; valid until the next call of next().
  [[nodiscard]] std::string_view line() const noexcept { return {line_.data(), line_size_}; }

  /// A whole answer, or none: what the system does not take now is written before the next one, which is
  /// dropped if that still does not go. @returns whether it was taken
  bool send(std::string_view answer) noexcept;
  /// Until something can be read, or what is left of an answer be written; at most one millisecond more
  /// than `seconds` of real time.
  void wait(double seconds) noexcept;
  /// The port is gone (unplugged).
  [[nodiscard]] bool lost() const noexcept { return lost_; }

  static constexpr std::size_t kLongestLine = 512;

 private:
  bool read_more() noexcept;
  void flush() noexcept;

  int descriptor_;
  bool lost_ = false;
  std::array<char, 1024> in_{};
  std::size_t in_begin_ = 0;
  std::size_t in_end_ = 0;
  std::array<char, kLongestLine> line_{};
  std::size_t line_size_ = 0;
  bool line_ended_ = true;  ///< line_ was given out: the next byte begins a new one
  bool too_long_ = false;
  std::array<char, kGloveAnswerSize> out_{};
  std::size_t out_begin_ = 0;
  std::size_t out_end_ = 0;
};

}  // namespace phalanx
