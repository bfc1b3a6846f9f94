// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace phalanx {

/// Bytes of a message in the Common Data Representation (CDR, Object Management Group: DDS-XTypes 1.3, 7.4), version 1, little
/// endian, as ROS 2 keeps it: each number stands at a multiple of its size, counted from the end of the first four bytes.
class Cdr {
 public:
  /// Begins a message; what was there is dropped.
  void begin() { bytes_.assign("\0\1\0\0", kHead); }
  [[nodiscard]] std::string_view bytes() const noexcept { return bytes_; }

  template <class Number>
  Cdr& number(Number value) {
    static_assert(std::is_arithmetic_v<Number> && std::endian::native == std::endian::little);
    while ((bytes_.size() - kHead) % sizeof value != 0) bytes_ += '\0';
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes_.append(raw, sizeof value);
    return *this;
  }
  /// A text, with its length and a zero at its end.
  Cdr& text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size() + 1));
    bytes_.append(value);
    bytes_ += '\0';
    return *this;
  }
  /// Length of a sequence; its elements follow.
  Cdr& length(std::size_t elements) { return number(static_cast<std::uint32_t>(elements)); }

 private:
  static constexpr std::size_t kHead = 4;

  std::string bytes_;
};

}  // namespace phalanx
