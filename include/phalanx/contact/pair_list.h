// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// The pairs of triangles that a digit's first contact is sought among, segment by segment, and until which
/// path parameter each is known to keep its distance. Sized once.
struct PairList {
  struct Pair {
    std::int32_t triangle;  ///< of the segment
    std::int32_t slot;      ///< of the object
    double until;           ///< above the floor up to this s; evaluated anew there
    bool near;              ///< may be within the margin when the horizon is reached
  };

  static constexpr int kMostOfASegment = 2048;
  std::vector<Pair> pair = std::vector<Pair>(std::size_t{kSegmentsPerDigit} * kMostOfASegment);
  int count = 0;
  /// Segment k of the digit has the pairs [begin[k], begin[k + 1]).
  std::array<int, kSegmentsPerDigit + 1> begin{};
};

}  // namespace phalanx
