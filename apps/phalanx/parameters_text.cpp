// SPDX-License-Identifier: Apache-2.0
#include "parameters_text.h"

#include <fmt/format.h>

namespace phalanx {
namespace {

// These switches have no default: the compiler then reports a law or a method without a name.

const char* law_name(ForceLaw law) {
  switch (law) {
    case ForceLaw::kHooke:
      return "Hooke";
    case ForceLaw::kKelvinVoigt:
      return "Kelvin-Voigt";
    case ForceLaw::kHuntCrossley:
      return "Hunt-Crossley";
    case ForceLaw::kDuffing:
      return "Duffing";
    case ForceLaw::kLinearThenCubic:
      return "linear then cubic";
    case ForceLaw::kOwn:
      return "own law";
  }
  return "";
}

std::string law_text(const ForceLawParameters& law) {
  return fmt::format("{}, k = {:.6g} N/mm", law_name(law.law), 1e-3 * law.stiffness);
}

std::string stabiliser_text(const StabiliserParameters& stabiliser) {
  switch (stabiliser.method) {
    case Stabiliser::kNone:
      return "no smoothing";
    case Stabiliser::kSmoothing:
      return fmt::format("smoothing \u2212{:.6g} to +{:.6g} N/s", -stabiliser.min_rate, stabiliser.max_rate);
    case Stabiliser::kRiseOnly:
      return fmt::format("rise-only smoothing +{:.6g} N/s", stabiliser.max_rate);
    case Stabiliser::kDirection:
      return "direction smoothing";
    case Stabiliser::kLowPass:
      return "low-pass";
    case Stabiliser::kKelvinVoigt:
      return "damper";
    case Stabiliser::kVirtualCoupling:
      return "virtual coupling";
    case Stabiliser::kPassivity:
      return "time-domain passivity";
    case Stabiliser::kEnergyBounding:
      return "energy bounding";
    case Stabiliser::kLocalWall:
      return "local wall";
    case Stabiliser::kOwn:
      return "own stabiliser";
  }
  return "";
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
