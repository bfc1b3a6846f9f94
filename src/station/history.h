// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace phalanx {

/// Ring buffer of the newest `capacity` values, for one thread at a time. Real-time: push() and clear().
template <class T>
class History {
 public:
  explicit History(std::size_t capacity) : value_(capacity > 0 ? capacity : 1) {}

  void push(const T& value) noexcept {
    value_[next_] = value;
    next_ = next_ + 1 < value_.size() ? next_ + 1 : 0;
    if (size_ < value_.size()) ++size_;
  }
  void clear() noexcept { next_ = size_ = 0; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }

  /// @returns all values, the oldest first. Not real-time: it allocates.
  [[nodiscard]] std::vector<T> all() const {
    std::vector<T> out;
    out.reserve(size_);
    for (std::size_t i = 0; i < size_; ++i)
      out.push_back(value_[(next_ + value_.size() - size_ + i) % value_.size()]);
    return out;
  }

 private:
  std::vector<T> value_;
  std::size_t next_ = 0;
  std::size_t size_ = 0;
};

}  // namespace phalanx
