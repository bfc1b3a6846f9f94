// SPDX-License-Identifier: Apache-2.0
// The options of `phalanx patient add` and `edit`: fields of a patient.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/registry/patient.h"

namespace phalanx {

/// Fields as they were typed. What is empty changes nothing.
struct PatientFields {
  std::string side = {};
  std::string symbol = {};
  std::string profile = {};
  std::string calibration = {};             ///< a file; needs `expires`
  std::string expires = {};                 ///< "2026-12-31"
  std::string range = {};                   ///< a file
  std::vector<std::string> own_force = {};  ///< "index=12.5" [N]
  std::vector<std::string> own_range = {};  ///< "index_pip_flexion=2,80" [deg]
  std::optional<double> force_limit_n = {};
  std::optional<double> stiffness_limit_n_per_mm = {};
  std::optional<double> torque_limit_nm = {};
  std::vector<std::string> contraindications = {};
  std::vector<std::string> warnings = {};
  std::vector<std::string> templates = {};     ///< names of prescription templates; before `prescription`
  std::vector<std::string> prescription = {};  ///< lines of parse_prescription()
  std::string consent = {};                    ///< "yes" or "no"
  std::string consent_date = {};
  std::vector<double> entry_check = {};  ///< flexion, release [deg]
  std::string entry_date = {};
  std::string note = {};
  std::vector<std::string> cleared = {};  ///< fields that are made empty first
};

/// Adds the options of all fields.
void add_patient_fields(CLI::App& command, PatientFields& fields);
/// Adds --clear, for `edit`.
void add_cleared_fields(CLI::App& command, PatientFields& fields);

/// Changes a patient: first the cleared fields, then the others. Another side clears all that was
/// measured on the first hand: profile, calibration, range, own range, own force and entry check, unless the
/// same line states them.
/// @param today  UTC, "2026-05-04"
/// @returns what was changed beyond the typed fields, in words, a line each
/// @throws std::invalid_argument naming option, value and remedy; SceneError for a calibration or range file;
/// ExerciseError for a prescription
std::vector<std::string> change_patient(Patient& patient, const PatientFields& fields,
                                        const std::string& today);

/// @returns the date of a time, UTC, "2026-05-04"; "unknown" if it is not between 1970 and 2100
[[nodiscard]] std::string utc_day(double utc);
/// @returns today's date, UTC
[[nodiscard]] std::string utc_today();

}  // namespace phalanx
