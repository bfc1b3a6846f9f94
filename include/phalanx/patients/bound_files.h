// SPDX-License-Identifier: Apache-2.0
// The files that a patient is bound to: a calibration of one device, and a range that was measured with it.
#pragma once

#include <string>

#include "phalanx/device/calibration.h"
#include "phalanx/registry/patient.h"

namespace phalanx {

/// @returns the methods of a calibration's channels: "goniometer", or "goniometer+jig" if they differ
[[nodiscard]] std::string calibration_methods(const Calibration& calibration);

/// Binds a calibration to a patient: absolute path, device, serial number, method and last day. A range that
/// was measured with another calibration is forgotten, and with it the own range.
/// @param expires  last day of validity, UTC, "2026-12-31"
/// @param today    UTC
/// @returns true if a range was forgotten
/// @throws SceneError if the file cannot be read; std::invalid_argument if `expires` is missing, no
/// date, or past
bool bind_calibration(Patient& patient, const std::string& file, const std::string& expires,
                      const std::string& today);

/// Binds a measured range, and takes its joints as the patient's own range.
/// @throws SceneError if the file or the calibration cannot be read; std::invalid_argument if the patient
/// has no calibration, if the range belongs to another device, serial number or calibration, or to a patient
/// with another label
void bind_range(Patient& patient, const std::string& file);

/// Forgets the calibration, and the range and own range that were measured with it.
void clear_calibration(Patient& patient);

/// Text about the validity of a patient's calibration: "until 2026-12-31", "expired on 2026-03-01", "none".
[[nodiscard]] std::string calibration_validity(const Patient& patient, const std::string& today);

}  // namespace phalanx
