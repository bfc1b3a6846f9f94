// SPDX-License-Identifier: Apache-2.0
#include "parameters_text.h"

#include <fmt/format.h>

#include <array>

namespace phalanx {
namespace {

std::string law_text(const ForceLawParameters& law) {
  static constexpr std::array<const char*, 5> kNames = {"Hooke", "Kelvin-Voigt", "Hunt-Crossley", "Duffing",
                                                        "linear then cubic"};
  return fmt::format("{}, k = {:.6g} N/mm", kNames[static_cast<std::size_t>(law.law)], 1e-3 * law.stiffness);
}

std::string stabiliser_text(const StabiliserParameters& stabiliser) {
  static constexpr std::array<const char*, 10> kNames = {"no smoothing",
                                                         "",
                                                         "",
                                                         "direction smoothing",
                                                         "low-pass",
                                                         "damper",
                                                         "virtual coupling",
                                                         "time-domain passivity",
                                                         "energy bounding",
                                                         "local wall"};
  switch (stabiliser.method) {
    case Stabiliser::kSmoothing:
      return fmt::format("smoothing \u2212{:.6g} to +{:.6g} N/s", -stabiliser.min_rate, stabiliser.max_rate);
    case Stabiliser::kRiseOnly:
      return fmt::format("rise-only smoothing +{:.6g} N/s", stabiliser.max_rate);
    default:
      return kNames[static_cast<std::size_t>(stabiliser.method)];
  }
}

}  // namespace

std::string parameters_text(const SceneDescription& scene, std::uint64_t ticks) {
  const HapticParameters& parameters = scene.parameters;
  const std::string cap = parameters.limits.fingertip_force_enabled
                              ? fmt::format("fingertip limit {:.6g} N", parameters.limits.fingertip_force)
                              : "no fingertip limit";
  return fmt::format("{}; {}; {}; {:.6g} Hz, {} ticks", law_text(parameters.force),
                     stabiliser_text(parameters.stabiliser), cap, parameters.rate_hz, ticks);
}

}  // namespace phalanx
