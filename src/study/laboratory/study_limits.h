// SPDX-License-Identifier: Apache-2.0
// Upper bounds for the size of a study. A larger one is a mistake in the file, and would not end
// in a lifetime.
#pragma once

namespace phalanx {

inline constexpr int kMostValues = 10'000;        ///< of an axis, of the stiffness grid, and of seeds
inline constexpr double kMostPoints = 1'000'000;  ///< of a study
inline constexpr double kLargestFirstSeed = 1e15;
inline constexpr double kLargestStiffness = 100.0;  ///< of the grid, as of force.stiffness_n_per_mm [N/mm]

}  // namespace phalanx
