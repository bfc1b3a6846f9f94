// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>

#include "phalanx/core/constants.h"
#include "phalanx/simulation/patient.h"

namespace phalanx {
namespace {

[[noreturn]] void refuse(std::string_view name, double value, std::string_view rule) {
  throw std::invalid_argument(
      fmt::format("patient's {} = {}: must be {}; change the value", name, value, rule));
}

void require_not_negative(std::string_view name, double value) {
  if (!(value >= 0.0 && value < kInfinity)) refuse(name, value, "finite and >= 0");
}

void require_above_0(std::string_view name, double value) {
  if (!(value > 0.0 && value < kInfinity)) refuse(name, value, "finite and > 0");
}

}  // namespace

void check_patient(const PatientParameters& patient) {
  for (int j = 0; j < kJoints; ++j) {
    const auto i = static_cast<std::size_t>(j);
    require_not_negative(fmt::format("stiffness of {} [N m/rad]", joint_name(j)), patient.stiffness[i]);
    require_not_negative(fmt::format("damping of {} [N m s/rad]", joint_name(j)), patient.damping[i]);
  }
  require_not_negative("press [N]", patient.press);
  if (!(patient.press_spread >= 0.0 && patient.press_spread <= 1.0))
    refuse("press_spread", patient.press_spread, "0 .. 1");
  require_above_0("approach_min [m/s]", patient.approach_min);
  require_above_0("approach_max [m/s]", patient.approach_max);
  if (patient.approach_max < patient.approach_min)
    refuse("approach_max [m/s]", patient.approach_max,
           fmt::format("at least approach_min, {}", patient.approach_min));
  require_not_negative("tremor [m]", patient.tremor);
  require_above_0("tremor_min_hz [Hz]", patient.tremor_min_hz);
  require_above_0("tremor_max_hz [Hz]", patient.tremor_max_hz);
  if (patient.tremor_max_hz < patient.tremor_min_hz)
    refuse("tremor_max_hz [Hz]", patient.tremor_max_hz,
           fmt::format("at least tremor_min_hz, {}", patient.tremor_min_hz));
  require_not_negative("bump [N]", patient.bump);
  require_not_negative("bump_start [s]", patient.bump_start);
  require_not_negative("bump_duration [s]", patient.bump_duration);
}

}  // namespace phalanx
