// SPDX-License-Identifier: Apache-2.0
// Times measured in rounds, one kind of load after the other in each, and what their percentiles say of a
// load.
#pragma once

#include <vector>

namespace phalanx::bench {

/// One value a step, all values of a round together [us].
using Rounds = std::vector<std::vector<double>>;

/// Nearest rank over the values of all rounds together; nothing measured is NaN.
/// @param percent  in (0, 100]
[[nodiscard]] double percentile(const Rounds& rounds, double percent);

struct Ratio {
  double value = 0.0;
  double low = 0.0;   ///< the middle 95 % of what rounds drawn anew give:
  double high = 0.0;  ///< a percentile bootstrap (Efron 1979) over whole rounds
};

/// percentile(loaded) / percentile(quiet). Rounds are drawn whole and both kinds together, for steps in a row
/// are not independent, and what else a machine does changes slowly.
/// @pre both have the same number of rounds
[[nodiscard]] Ratio ratio(const Rounds& loaded, const Rounds& quiet, double percent);

}  // namespace phalanx::bench
