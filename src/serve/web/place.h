// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>

namespace phalanx::web {

/// One of the connections that there may be at once, given back when it goes.
class Place {
 public:
  /// @param taken  how many are; outlives the place
  explicit Place(std::size_t& taken) noexcept : taken_(&taken) { ++taken; }
  Place(Place&& other) noexcept : taken_(std::exchange(other.taken_, nullptr)) {}
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;
  Place& operator=(Place&&) = delete;
  ~Place() {
    if (taken_ != nullptr) --*taken_;
  }

 private:
  std::size_t* taken_;
};

}  // namespace phalanx::web
