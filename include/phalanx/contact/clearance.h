// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace phalanx {

/// What is known of a segment's distance from the object without asking: a lower bound, spent as the segment
/// moves. Most segments at most ticks need nothing else.
class Clearance {
 public:
  /// A lower bound [m].
  [[nodiscard]] double bound() const noexcept { return bound_; }
  /// No point of the segment has moved farther than this [m].
  void spend(double moved) noexcept { bound_ = std::max(0.0, bound_ - moved); }

  /// Whether asking for a new bound is likely to pay: not for some turns after it did not.
  [[nodiscard]] bool worth_asking() noexcept {
    if (pause_ > 0) --pause_;
    return pause_ == 0;
  }
  /// @param bound   another lower bound at the same place [m]
  /// @param enough  whether it spared the search this time
  void learn(double bound, bool enough) noexcept {
    bound_ = std::max(bound_, bound);
    pause_ = enough ? 0 : kPause;
  }

 private:
  static constexpr int kPause = 4;
  double bound_ = 0.0;
  int pause_ = 0;
};

}  // namespace phalanx
