// SPDX-License-Identifier: Apache-2.0
// The units that a mesh file's numbers may have, by the names that scenes, commands and uploads use.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace phalanx {

struct LengthUnit {
  std::string_view name;
  double metres;  ///< that one of it is [m]
};

inline constexpr std::array<LengthUnit, 4> kLengthUnits = {
    {{"m", 1.0}, {"mm", 1e-3}, {"cm", 1e-2}, {"in", 0.0254}}};

/// @returns metres per unit; nothing if none has this name. Real-time safe.
[[nodiscard]] constexpr std::optional<double> metres_per(std::string_view unit) noexcept {
  for (const LengthUnit& known : kLengthUnits)
    if (known.name == unit) return known.metres;
  return std::nullopt;
}

}  // namespace phalanx
