// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <utility>

namespace phalanx {

/// A file descriptor that closes itself unless it is given away; below 0: none.
class Descriptor {
 public:
  explicit Descriptor(int value) noexcept : value_(value) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  [[nodiscard]] int value() const noexcept { return value_; }
  [[nodiscard]] int give_away() noexcept { return std::exchange(value_, -1); }

 private:
  int value_;
};

}  // namespace phalanx
