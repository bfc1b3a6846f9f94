// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "study/report/svg.h"

namespace phalanx {

/// Names under columns that are `cell` wide: level if they fit (every second one will do), else upright and
/// cut; as many as have room. @returns where they end [pt]
double draw_column_names(Svg& svg, const std::vector<std::string>& names, double left, double cell,
                         double bottom);

}  // namespace phalanx
