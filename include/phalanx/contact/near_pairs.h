// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "phalanx/contact/triangle_distance.h"
#include "phalanx/core/math.h"

namespace phalanx {

class ObjectTree;
struct PlacedSegment;

/// Pairs of triangles within a distance of a segment at one pose, with their closest points, in the trees'
/// fixed order. Of one segment and one object: only a pose tells whether they still hold. A segment that was
/// blocked in the last tick, and has not moved, needs no search. Allocated once.
class NearPairs {
 public:
  struct Pair {
    std::int32_t triangle;  ///< index in the segment's mesh
    std::int32_t slot;      ///< slot in the object's tree
    TriangleDistance closest;
  };
  static constexpr std::size_t kMost = 512;

  /// Finds all pairs whose distance is at most `reach` [m], unless they are known.
  /// Real-time: no allocation, lock, throw or I/O.
  void find(const PlacedSegment& segment, const ObjectTree& object, double reach) noexcept;
  /// @returns true if find() at this pose with this reach has nothing to do
  [[nodiscard]] bool known(const Pose& X_WS, double reach) const noexcept {
    return count_ <= kMost && reach_ >= reach && is_at(X_WS);
  }
  /// Notes that the segment has stopped at a pose, without a search. What is known of this pose is kept.
  void stop_at(const Pose& X_WS) noexcept;
  /// Nothing is known any more: another segment or object is asked about next.
  void forget() noexcept { stop_at({Mat3::Zero(), Vec3::Zero()}); }
  /// @returns true if the last pose that was searched, or noted, is this one
  [[nodiscard]] bool is_at(const Pose& X_WS) const noexcept { return X_WS_.p == X_WS.p && X_WS_.R == X_WS.R; }
  /// @returns true if a pair is known to be within `distance` [m] at this pose
  [[nodiscard]] bool is_within(const Pose& X_WS, double distance) const noexcept {
    return is_at(X_WS) && least_squared_ <= distance * distance;
  }
  /// Number of pairs found; if it is more than kMost, none are kept.
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  /// @pre count() <= kMost
  [[nodiscard]] const Pair& operator[](std::size_t i) const noexcept { return pair_[i]; }

 private:
  Pose X_WS_ = {Mat3::Zero(), Vec3::Zero()};  ///< no segment is here
  double reach_ = -1.0;                       ///< [m]; negative: not searched
  double least_squared_ = 1e300;              ///< of the pairs found [m^2]
  std::size_t count_ = 0;
  std::vector<Pair> pair_ = std::vector<Pair>(kMost);
};

}  // namespace phalanx
