// SPDX-License-Identifier: Apache-2.0
// A generated patient in a registry: what a report is made from is what was stored.
#pragma once

#include <string>

#include "phalanx/patients/patient_report.h"
#include "record/temporary_folder.h"
#include "report/generated_patient.h"

namespace phalanx::testing {

/// Registry of a temporary folder, with one patient.
class KeptRegistry {
 public:
  explicit KeptRegistry(const GeneratedPatient& made)
      : registry_({.folder = folder_ / "data"}, KeyStore::create(folder_ / "keys")),
        record_(add_generated(registry_, made)) {}

  [[nodiscard]] Registry& registry() { return registry_; }
  [[nodiscard]] const std::string& record() const { return record_; }
  /// @returns what a report of all days is made from, on 2026-11-29
  [[nodiscard]] ReportInput input() {
    return read_report_input(registry_, Actor::owner(), record_, "", "2026-11-29");
  }

 private:
  TemporaryFolder folder_;
  Registry registry_;
  std::string record_;
};

/// @returns KeptRegistry::input() of the patient
[[nodiscard]] inline ReportInput read_back(const GeneratedPatient& made) {
  return KeptRegistry(made).input();
}

}  // namespace phalanx::testing
