// SPDX-License-Identifier: Apache-2.0
// Largest and smallest value that a signal held for a time.
#pragma once

#include <optional>
#include <span>

#include "phalanx/exercise/observation.h"

namespace phalanx {

/// Returns the largest value that was held:  max over i of min{x_k : t_i <= t_k <= t_i + hold}, where
/// t_i + hold <= t_last. Nothing if the steps do not span the hold. Takes time in proportion to the
/// number of steps.
/// @param value  of each step  @param hold  [s]
[[nodiscard]] std::optional<double> held_maximum(std::span<const Observation> steps,
                                                 std::span<const double> value, double hold);
/// Returns the smallest value that was held:  min over i of max{x_k : t_i <= t_k <= t_i + hold}.
[[nodiscard]] std::optional<double> held_minimum(std::span<const Observation> steps,
                                                 std::span<const double> value, double hold);

}  // namespace phalanx
