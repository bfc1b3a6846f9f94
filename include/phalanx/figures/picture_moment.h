// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "phalanx/step/displayed_hand.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// Selector of the tick that a picture shows: the requested one; else that of the largest total force;
/// without any force the one in the middle of the motion. The snapshot is drawn with the digits apart.
class PictureMoment {
 public:
  /// @param ticks  number of ticks of the motion
  /// @param hand   follows the motion; none: the GDP is drawn
  /// @param at     the requested tick, from 0
  explicit PictureMoment(std::uint64_t ticks, std::optional<DisplayedHand> hand = std::nullopt,
                         std::optional<std::uint64_t> at = std::nullopt)
      : middle_(ticks / 2), hand_(std::move(hand)), at_(at) {}
  /// Takes every tick, in order.
  void see(const Snapshot& snapshot);
  [[nodiscard]] const Snapshot& snapshot() const noexcept { return shown_; }

 private:
  static constexpr double kFrame = 1.0 / 60.0;  ///< longest time between two ticks that the hand follows [s]

  std::uint64_t middle_;
  std::optional<DisplayedHand> hand_;
  double followed_ = 0.0;  ///< time of the tick that the hand followed last [s]
  std::optional<std::uint64_t> at_;
  std::uint64_t tick_ = 0;
  double peak_ = 0.0;  ///< [N]
  Snapshot shown_;
};

}  // namespace phalanx
