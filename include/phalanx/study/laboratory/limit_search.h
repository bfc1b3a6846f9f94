// SPDX-License-Identifier: Apache-2.0
// Two searches for the largest stiffness of a grid at which all seeds are stable. Neither tries all points.
#pragma once

#include <functional>
#include <vector>

namespace phalanx {

/// A grid point that was tried.
struct CheckedStiffness {
  int index = 0;  ///< index in the grid
  bool stable = false;
};

/// Result of a limit search.
struct LimitSearch {
  int limit = -1;             ///< grid index of the limit; -1: the grid's smallest stiffness is not stable
  bool at_least = false;      ///< the limit is the grid's last point: the true limit may be higher
  bool non_monotone = false;  ///< a checked point above the first unstable one is stable
  std::vector<CheckedStiffness> checked;  ///< every point that was tried, by increasing index
};

/// Finds the largest stable grid point that has only stable ones below it, among those that were checked:
///  1. coarse scan: every `coarse`-th point of the whole grid, and its last one;
///  2. bisection between the first coarse point that is unstable and the coarse point before it;
///  3. two further points on each side of the boundary. If one below it is unstable, the boundary
///     moves there, and two further points below that one are checked in turn.
/// The result guarantees, as far as the grid has the points:
///  - `limit` and the two points below it are stable;
///  - limit + 1 is unstable, and the two points above it were tried;
///  - every point that was tried below `limit` is stable, every coarse point there included.
/// The search can miss an unstable range if it is narrower than `coarse` points, lies between two coarse
/// points, and is more than two points below the limit.
/// @param size    number of grid points > 0
/// @param stable  verdict on a grid point; called at most once for each
/// @param coarse  > 0
/// @throws std::invalid_argument if size or coarse is not positive, and everything that `stable` throws.
[[nodiscard]] LimitSearch search_limit(int size, const std::function<bool(int)>& stable, int coarse = 4);

/// @returns an upper bound of the points that are tried on a grid of `size` if stability is monotone.
[[nodiscard]] int most_checked_if_monotone(int size, int coarse = 4);

/// Result of a traced limit.
struct TracedLimit {
  int limit = -1;             ///< grid index of the limit; -1: the grid's smallest stiffness is not stable
  bool at_least = false;      ///< the limit is the grid's last point: the true limit may be higher
  bool non_monotone = false;  ///< a seed that is unstable at a point was stable at a higher one
};

/// Finds the limit that search_limit() finds, with fewer trials, if each seed's stability is monotone in the
/// stiffness. A stiffness is stable if all seeds are: the limit is the least of the seeds' own limits. That of
/// the first seed is bisected over the whole grid. A further seed is tried at the least limit so far; only if
/// it is unstable there, its lower limit is sought downwards, in steps of 1, 2, 4 .. grid points, and
/// bisected. Seeds run one after the other. If their limits differ and their order is random, the expected number of
/// seeds that lower the limit is 1/2 + 1/3 + .. + 1/n: 2.6 of 20.
/// The result guarantees, also where stability is not monotone:
///  - all seeds are stable at `limit`;
///  - at limit + 1 a seed is unstable;
///  - at each `coarse`-th point below `limit` one seed is stable, seed (point / coarse) % seeds.
/// search_limit() tries all seeds at these points, two further points on each side of the limit, and each
/// `coarse`-th point above it.
/// @param size    number of grid points > 0
/// @param seeds   number of seeds > 0
/// @param stable  verdict on a grid point with a seed, 0 .. seeds - 1; called at most once for each pair
/// @param coarse  > 0
/// @throws std::invalid_argument if size, seeds or coarse is not positive, and everything that `stable`
/// throws.
[[nodiscard]] TracedLimit trace_limit(int size, int seeds,
                                      const std::function<bool(int index, int seed)>& stable, int coarse = 4);

/// @returns an upper bound of the calls of `stable` in trace_limit() if each seed's stability is monotone. It
/// lets each seed lower the limit of those before it: the mean is far below.
[[nodiscard]] int most_traced_if_monotone(int size, int seeds, int coarse = 4);

}  // namespace phalanx
