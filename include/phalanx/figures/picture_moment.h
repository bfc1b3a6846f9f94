// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "phalanx/step/snapshot.h"

namespace phalanx {

/// Selector of the tick that a picture shows: the requested one; else that of the largest total force;
/// without any force the one in the middle of the motion.
class PictureMoment {
 public:
  /// @param ticks  number of ticks of the motion
  /// @param at     the requested tick, from 0
  explicit PictureMoment(std::uint64_t ticks, std::optional<std::uint64_t> at = std::nullopt)
      : middle_(ticks / 2), at_(at) {}
  /// Takes every tick, in order.
  void see(const Snapshot& snapshot);
  [[nodiscard]] const Snapshot& snapshot() const noexcept { return shown_; }

 private:
  std::uint64_t middle_;
  std::optional<std::uint64_t> at_;
  std::uint64_t tick_ = 0;
  double peak_ = 0.0;  ///< [N]
  Snapshot shown_;
};

}  // namespace phalanx
