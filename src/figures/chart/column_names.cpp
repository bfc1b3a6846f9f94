// SPDX-License-Identifier: Apache-2.0
#include "figures/chart/column_names.h"

#include <algorithm>
#include <cmath>

namespace phalanx {
namespace {

constexpr double kNameHeight = 8.5;  // height of a line of text [pt]
constexpr double kGap = 1.5;         // between two names
constexpr double kMostRoom = 90.0;

bool reads_as_number(const std::string& name) {
  return name.find_first_not_of("0123456789.-+e") == std::string::npos;
}

std::size_t step(double needed, double cell) {
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(needed / cell)));
}

}  // namespace

double draw_column_names(Svg& svg, const std::vector<std::string>& names, double left, double cell,
                         double bottom) {
  const double widest = text_width(names);
  const auto middle = [&](std::size_t i) { return left + cell * (static_cast<double>(i) + 0.5); };
  // Numbers may be thinned, since a reader can complete them; words may not.
  if (widest + kGap <= cell || std::all_of(names.begin(), names.end(), reads_as_number)) {
    for (std::size_t i = 0; i < names.size(); i += step(widest + kGap, cell))
      svg.text(middle(i), bottom + 11, names[i], Anchor::kMiddle);
    return bottom + 11;
  }
  const double room = std::min(widest, kMostRoom);
  for (std::size_t i = 0; i < names.size(); i += step(kNameHeight, cell))
    svg.text_upwards(middle(i) + 2.8, bottom + 5, cut_to(names[i], room + 1), Anchor::kEnd);
  return bottom + 5 + room;
}

}  // namespace phalanx
