// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "figures/chart/svg.h"

namespace phalanx {

/// Draws names under columns that are `cell` wide. They are level if they fit, perhaps only every second one.
/// Otherwise they are upright and cut, as many as have room. @returns their lower end [pt]
double draw_column_names(Svg& svg, const std::vector<std::string>& names, double left, double cell,
                         double bottom);

}  // namespace phalanx
