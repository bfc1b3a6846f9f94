// SPDX-License-Identifier: Apache-2.0
// What a report of a patient is made from: the registry and the shipped exercises.
#pragma once

#include <string>

#include "phalanx/registry/registry.h"
#include "phalanx/report/report.h"

namespace phalanx {

/// Reads all that report_html() and report_fhir() need. The registry checks the role and writes the audit log:
/// "show", "results", "tests", "notes". Without assets/exercises the titles are names and no training is judged.
/// @param code_or_record  the patient
/// @param day    "2026-05-04", or empty: of all days
/// @param today  UTC
/// @throws RegistryError as Registry::patient(); std::invalid_argument as check_report_day()
[[nodiscard]] ReportInput read_report_input(Registry& registry, const Actor& actor,
                                            const std::string& code_or_record, const std::string& day,
                                            const std::string& today);

}  // namespace phalanx
