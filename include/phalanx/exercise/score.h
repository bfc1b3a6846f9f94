// SPDX-License-Identifier: Apache-2.0
// A score of a trial: its value, unit and origin, or why there is none.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace phalanx {

/// Where a score's value comes from.
enum class ScoreOrigin : std::uint8_t {
  kMeasured,  ///< from sensors of the device
  kRendered,  ///< from forces that were computed and sent, not measured: transmissions lose a part of them
};

/// Returns the name in files: "measured" or "rendered".
[[nodiscard]] constexpr std::string_view score_origin_name(ScoreOrigin origin) noexcept {
  return origin == ScoreOrigin::kMeasured ? "measured" : "rendered";
}

/// One score. docs/exercises.md has the formula and the source of each.
struct Score {
  std::string name;    ///< "rmse_n", "tam_index_deg": lower case with the unit as its last part
  std::string unit;    ///< "N", "deg", "s", "-"
  double value = 0.0;  ///< finite if `invalid` is empty
  ScoreOrigin origin = ScoreOrigin::kMeasured;
  /// Why there is no value, for people: "not measured: the device has no sensor of the ring finger". Empty:
  /// there is one.
  std::string invalid;

  [[nodiscard]] bool valid() const noexcept { return invalid.empty(); }
};

}  // namespace phalanx
