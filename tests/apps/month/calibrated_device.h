// SPDX-License-Identifier: Apache-2.0
// The simulated exoskeleton behind the link, calibrated by `phalanx device calibrate`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "record/temporary_folder.h"

namespace phalanx::testing {

/// What a calibration has left.
struct CalibratedDevice {
  int exit_code = -1;
  std::string said;            ///< by `phalanx device calibrate`
  std::filesystem::path file;  ///< calibration; there only if the exit code is 0
  double largest_error =
      0.0;  ///< of the calibrated angle at the two positions, to the controller's own angle [rad]
};

/// Calibrates `phalanx device simulate` through UDP by `phalanx device calibrate --method goniometer`. Its
/// patient moves the index finger's knuckle between two positions; both angles are read from the controller's
/// log, as from a goniometer. The other channels keep the device's own numbers, from an earlier file.
/// @param environment  "NAME=VALUE" of the programs
[[nodiscard]] CalibratedDevice calibrate_through_the_link(const TemporaryFolder& folder,
                                                          const std::vector<std::string>& environment);

}  // namespace phalanx::testing
