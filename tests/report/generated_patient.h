// SPDX-License-Identifier: Apache-2.0
// A patient with months of generated sessions, for tests and measurements of reports.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "phalanx/registry/registry.h"

namespace phalanx::testing {

/// What a generated row's detail states beyond the row.
struct GeneratedDetail {
  int counted = 0;   ///< trials that were scored
  int unscored = 0;  ///< trials with a reason why not
  int pain = -1;     ///< largest rating
  int fatigue = -1;
};

/// Content of a generated registry.
struct GeneratedPatient {
  Patient patient = {};
  std::vector<ResultRow> results = {};                  ///< by date
  std::map<std::string, GeneratedDetail> details = {};  ///< by ResultRow::recording
  std::vector<EnteredTest> tests = {};
  std::vector<PatientNote> notes = {};
};

/// Makes a simulated patient with `sessions` of 20 minutes, five a week: three trainings each, each tenth one
/// with assessments, each twentieth with entered tests. Some exercises are interrupted or not valid, some trials are
/// not scored, the largest pain is not the last one, one digit is not measured, and the calibration's method changes
/// after 60 % of the sessions. Each row has a result in detail, as large as a recorded one. Equal seeds give equal
/// patients.
[[nodiscard]] GeneratedPatient generated_patient(int sessions, std::uint64_t seed);

/// Adds the patient to a registry, as its owner. @returns the record id
std::string add_generated(Registry& registry, const GeneratedPatient& made);

}  // namespace phalanx::testing
