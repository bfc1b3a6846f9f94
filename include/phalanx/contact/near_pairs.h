// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "phalanx/contact/candidate_pairs.h"
#include "phalanx/contact/triangle_distance.h"
#include "phalanx/core/math.h"

namespace phalanx {

class ObjectTree;
struct PlacedSegment;

/// Pairs of triangles within a distance of a segment at one pose, with their closest points, in the trees'
/// fixed order. They hold for exactly this pose, one segment and one object; carry() takes them to another
/// pose without their points. A segment that was blocked in the last tick, and has not moved, needs no
/// search. Allocated once.
class NearPairs {
 public:
  struct Pair {
    std::int32_t triangle;  ///< index in the segment's mesh
    std::int32_t slot;      ///< slot in the object's tree
    TriangleDistance closest;
  };
  static constexpr std::size_t kMost = 2048;

  /// Finds all pairs whose distance is at most `reach` [m]: among the candidates if these cover it, else in the
  /// trees, with the same bits. Does nothing if they are stored.
  /// @pre since the last clear(), the segment and the object are the same
  /// Real-time: no allocation, lock, throw or I/O.
  void find(const PlacedSegment& segment, const ObjectTree& object, double reach) noexcept;
  /// @returns true if all pairs within `reach` [m] at this pose are stored
  [[nodiscard]] bool holds(const Pose& X_WS, double reach) const noexcept {
    return !overflows() && reach_ >= reach && is_at(X_WS);
  }
  /// Stores a pose at which the segment has stopped, without a search. Pairs found at this pose stay.
  void stop_at(const Pose& X_WS) noexcept;
  /// Takes the pairs to a pose to which no point of the segment has moved farther than `moved` [m]. They are then
  /// complete within a reach that is smaller by this, but their closest points are those of the old pose.
  void carry(const Pose& X_WS, double moved) noexcept {
    X_WS_ = X_WS;
    carried_ = true;
    reach_ -= moved;
    const double least = std::max(0.0, std::sqrt(least_squared_) - moved);
    least_squared_ = least * least;
  }
  /// Removes pairs and pose.
  void clear() noexcept {
    stop_at({Mat3::Zero(), Vec3::Zero()});
    candidates_.clear();
  }
  /// Returns the pairs that the segment may come near to next. Static mode has none.
  [[nodiscard]] CandidatePairs& candidates() noexcept { return candidates_; }
  /// @returns true if the pose of the last find(), stop_at() or carry() is this one, to the last bit
  [[nodiscard]] bool is_at(const Pose& X_WS) const noexcept { return X_WS_.p == X_WS.p && X_WS_.R == X_WS.R; }
  /// @returns true if a pair that was found at this pose is within `distance` [m]
  [[nodiscard]] bool is_within(const Pose& X_WS, double distance) const noexcept {
    return is_at(X_WS) && least_squared_ <= distance * distance;
  }
  /// Returns a lower bound on the distance at this pose [m]; 0 if the pairs are not of this pose.
  [[nodiscard]] double bound(const Pose& X_WS) const noexcept {
    return is_at(X_WS) && reach_ > 0.0 ? std::min(reach_, std::sqrt(least_squared_)) : 0.0;
  }
  /// Returns the number of pairs found.
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  /// @returns true if more pairs were found than can be stored: then they are not complete
  [[nodiscard]] bool overflows() const noexcept { return count_ > kMost; }
  /// @pre !overflows()
  [[nodiscard]] const Pair& operator[](std::size_t i) const noexcept { return pair_[i]; }

 private:
  /// Stores a pair, or counts it.
  void add(const Pair& pair) noexcept;
  /// Finds all pairs within `reach` among the candidates. @pre they cover it
  void find_among_candidates(const PlacedSegment& segment, const ObjectTree& object, double reach) noexcept;

  Pose X_WS_ = {Mat3::Zero(), Vec3::Zero()};  ///< no segment is here
  bool carried_ = false;                      ///< the closest points are those of an earlier pose
  double reach_ = -1.0;                       ///< [m]; negative: not searched
  double least_squared_ = 1e300;              ///< of the pairs found [m^2]
  std::size_t count_ = 0;
  CandidatePairs candidates_;
  std::vector<Pair> pair_ = std::vector<Pair>(kMost);
};

}  // namespace phalanx
