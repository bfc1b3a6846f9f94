// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/contact/contact_parameters.h"
#include "phalanx/force/force_parameters.h"
#include "phalanx/force/oscillation.h"
#include "phalanx/force/stabiliser.h"

namespace phalanx {

/// Every number of a step that is neither geometry nor state. A plain value: another set of parameters for
/// the same hand and object copies no mesh. docs/scenes.md lists the ranges, in the units of a scene's keys.
struct HapticParameters {
  ContactParameters contact;
  ForceLawParameters force;
  StabiliserParameters stabiliser;  ///< the default bounds the rise of a force
  OscillationParameters oscillation;
  LimitParameters limits;
  double rate_hz = 200.0;  ///< nominal rate of step() [Hz]

  /// Nominal period of a step [s].
  [[nodiscard]] double period() const noexcept { return 1.0 / rate_hz; }
};

}  // namespace phalanx
