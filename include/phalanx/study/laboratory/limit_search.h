// SPDX-License-Identifier: Apache-2.0
// The largest stable stiffness of a grid, without trying all of it and without believing that stability is
// monotone.
#pragma once

#include <functional>
#include <vector>

namespace phalanx {

struct CheckedStiffness {
  int index = 0;  ///< in the grid
  bool stable = false;
};

struct LimitSearch {
  int limit = -1;             ///< grid index of the limit; -1: the grid's smallest stiffness is not stable
  bool at_least = false;      ///< the limit is the grid's last point: the true limit may be higher
  bool non_monotone = false;  ///< a checked point above the first unstable one is stable
  std::vector<CheckedStiffness> checked;  ///< every point that was tried, by rising index
};

/// The largest grid point that is stable and has only stable ones below it, as far as they were checked:
///  1. coarse scan: every `coarse`-th point of the whole grid, and its last one;
///  2. bisection between the first coarse point that is unstable and the coarse point before it;
///  3. two further points on each side of the boundary. If one below it is unstable, the boundary moves
///  there, and two
///     further points below that one are checked in turn.
/// Guaranteed of the result: `limit` and the two points below it are stable, limit + 1 is unstable and the
/// two points above that were tried (as far as the grid has them), every point that was tried below `limit`
/// is stable, and so is every coarse one there. Not guaranteed: an unstable stretch narrower than `coarse`
/// points, wholly between two coarse points and more than two points below the limit, is not seen.
/// @param size    number of grid points > 0
/// @param stable  verdict on a grid point; asked at most once for each
/// @param coarse  > 0
/// @throws std::invalid_argument if size or coarse is not positive, and whatever `stable` throws.
[[nodiscard]] LimitSearch search_limit(int size, const std::function<bool(int)>& stable, int coarse = 4);

/// How many points are tried on a grid of `size` where stability is monotone: no more than this.
[[nodiscard]] int most_checked_if_monotone(int size, int coarse = 4);

}  // namespace phalanx
