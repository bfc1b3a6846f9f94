// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// Pairs of triangles among which a digit's first contact is sought, segment by segment. Each holds the path
/// parameter s up to which it is known to keep its distance. Allocated once.
struct PairList {
  struct Pair {
    std::int32_t triangle;  ///< index in the segment's mesh
    std::int32_t slot;      ///< slot in the object's tree
    double until;           ///< farther apart than the floor up to this s; evaluated again there
    bool near;              ///< may be within the margin when the horizon is reached
  };

  static constexpr int kMostOfASegment = 4096;
  std::vector<Pair> pair = std::vector<Pair>(std::size_t{kSegmentsPerDigit} * kMostOfASegment);
  int count = 0;
  /// Segment k of the digit has the pairs [begin[k], begin[k + 1]).
  std::array<int, kSegmentsPerDigit + 1> begin{};
};

}  // namespace phalanx
