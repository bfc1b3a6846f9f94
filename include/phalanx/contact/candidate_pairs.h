// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "phalanx/core/math.h"

namespace phalanx {

class ObjectTree;
struct PlacedSegment;

/// Pairs of triangles that a moving segment may come near to. They belong to one segment and one object, and keep the
/// order of a search in the trees. One search lists them for many poses, each with a lower bound on its distance. The
/// way adds up bounds on the motion of the segment's points: a pair at distance d stays farther than r until the way
/// has grown by d - r. See docs/contact.md "A segment that slides". Real-time except for allocate(): no allocation,
/// lock, throw or I/O.
class CandidatePairs {
 public:
  struct Pair {
    std::int32_t triangle;  ///< index in the segment's mesh
    std::int32_t slot;      ///< slot in the object's tree
    double touches;         ///< way before which the pair does not touch [m]
  };
  static constexpr std::size_t kMost = 4096;
  /// A segment that needs pairs within more than this is better searched directly [m].
  static constexpr double kMostReach = 1e-3;
  /// Way for which a new list lasts, less where more than kMost pairs are within it [m].
  static constexpr double kAhead = 0.3e-3;

  /// Allocates the memory. Without it nothing is listed. Set-up only.
  void allocate() {
    pair_.resize(kMost);
    bound_.resize(kMost);
  }
  /// Lists the pairs within `reach` [m] at this pose, and those of the next kAhead of the way, or less: those that are
  /// met last are left out where the pairs exceed kMost. Does nothing if the list covers the reach. Lists none if the
  /// reach exceeds kMostReach or about kMost / 2 pairs are within it; after too many, not for the next few calls.
  /// @pre since the last clear(), the segment and the object are the same
  void list(const PlacedSegment& segment, const ObjectTree& object, double reach) noexcept;
  /// Adds the way to this pose.
  /// @returns true if all pairs within `reach` [m] are listed
  [[nodiscard]] bool cover(const PlacedSegment& segment, double reach) noexcept;
  /// Calls use(pair) for each pair that may be within `reach` [m] at the last pose of cover(). use() may call
  /// measured(pair, distance).
  template <class Use>
  void for_each(double reach, Use&& use) noexcept {
    const double limit = way_ + reach * (1.0 + 1e-9) + kRounding;
    for (std::size_t i = 0; i < count_; ++i)
      if (pair_[i].touches <= limit) use(pair_[i]);
  }
  /// Takes a pair's distance at the last pose of cover() [m].
  void measured(Pair& pair, double distance) const noexcept { pair.touches = way_ + distance; }
  /// @returns true if no pair is listed
  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
  /// Removes the pairs.
  void clear() noexcept {
    count_ = 0;
    complete_ = -1.0;
    ahead_ = kAhead;
    pause_ = 0;
  }

 private:
  /// Drops the half of the pairs that are met last.
  /// @returns the least bound of those [m]
  double drop_half() noexcept;

  static constexpr double kRounding = 1e-12;  ///< of a bound [m]
  static constexpr int kPause = 16;           ///< calls of list() that do nothing after too many pairs

  Pose X_WS_ = {Mat3::Zero(), Vec3::Zero()};  ///< where the way has been added up to
  double way_ = 0.0;                          ///< since the pairs were listed [m]
  double complete_ = -1.0;  ///< way before which no other pair touches [m]; negative: nothing is listed
  double ahead_ = kAhead;   ///< way for which the next list should last [m]
  int pause_ = 0;
  std::size_t count_ = 0;
  std::vector<Pair> pair_;     ///< of kMost pairs, or empty
  std::vector<double> bound_;  ///< memory of drop_half(), as large
};

}  // namespace phalanx
