// SPDX-License-Identifier: Apache-2.0
// Length units of a mesh file's numbers, with their names in scenes, commands and uploads.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace phalanx {

/// Length unit.
struct LengthUnit {
  std::string_view name;
  double metres;  ///< metres per unit
};

inline constexpr std::array<LengthUnit, 4> kLengthUnits = {
    {{"m", 1.0}, {"mm", 1e-3}, {"cm", 1e-2}, {"in", 0.0254}}};

/// Returns the metres per unit, or nothing if no unit has this name. Real-time safe.
[[nodiscard]] constexpr std::optional<double> metres_per(std::string_view unit) noexcept {
  for (const LengthUnit& known : kLengthUnits)
    if (known.name == unit) return known.metres;
  return std::nullopt;
}

}  // namespace phalanx
