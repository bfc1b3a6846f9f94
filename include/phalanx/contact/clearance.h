// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace phalanx {

/// Lower bound on a segment's distance from the object. The segment's motion reduces it, so that most
/// segments at most ticks need no search. Real-time: O(1), no allocation.
class Clearance {
 public:
  /// Returns the lower bound [m].
  [[nodiscard]] double bound() const noexcept { return bound_; }
  /// Reduces the bound by a motion. No point of the segment has moved farther than `moved` [m].
  void spend(double moved) noexcept { bound_ = std::max(0.0, bound_ - moved); }

  /// @returns true if computing a new bound is likely to save a search. After a bound that did not, the
  /// answer is false for the next few calls.
  [[nodiscard]] bool worth_asking() noexcept {
    if (pause_ > 0) --pause_;
    return pause_ == 0;
  }
  /// Takes a newly computed bound.
  /// @param bound   lower bound at the same pose [m]
  /// @param enough  true if it made the search unnecessary
  void learn(double bound, bool enough) noexcept {
    bound_ = std::max(bound_, bound);
    pause_ = enough ? 0 : kPause;
  }

 private:
  static constexpr int kPause = 4;  ///< calls that worth_asking() refuses, + 1
  double bound_ = 0.0;
  int pause_ = 0;
};

}  // namespace phalanx
