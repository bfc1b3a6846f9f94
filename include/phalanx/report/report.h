// SPDX-License-Identifier: Apache-2.0
// Report of a patient: an HTML page that prints well on A4, and a FHIR R4 bundle. docs/reports.md describes
// both. Pure functions of what the registry holds: they read no clock, disk or network.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/exercise/training.h"
#include "phalanx/registry/patient.h"
#include "phalanx/registry/result.h"
#include "phalanx/registry/trends.h"

namespace phalanx {

/// Language of a report.
enum class ReportLanguage : std::uint8_t { kEnglish, kGerman };
/// @returns the language of "en" or "de"
/// @throws std::invalid_argument naming the known languages
[[nodiscard]] ReportLanguage report_language(std::string_view name);

/// Exercise as a report names it.
struct ReportedExercise {
  std::string name = {};
  std::string title = {};                     ///< for people; in English
  std::string title_de = {};                  ///< in German; empty: as in English
  double target_success = 0.7;                ///< share of success that a training steers to [-]
  std::optional<SuccessReport> success = {};  ///< success_report(); none: not a training
  int sessions = 0;                           ///< valid ones of the training, in all
  bool needs_attention = false;               ///< the training is not known to be in its range
};

/// Content of a report.
struct ReportInput {
  Patient patient = {};
  std::vector<ResultRow> results = {};  ///< by date
  std::vector<EnteredTest> tests = {};
  std::vector<PatientNote> notes = {};
  std::vector<Trend> trends = {};                ///< make_trends() of results and tests
  std::vector<ReportedExercise> exercises = {};  ///< one that is missing has its name as its title
  std::string day = {};      ///< "2026-05-04", UTC: a session's report; empty: of all days
  std::string today = {};    ///< UTC
  std::string version = {};  ///< of this program
};

/// Checks the day of a report.
/// @throws std::invalid_argument unless `day` is empty or a date such as 2026-05-04
void check_report_day(const std::string& day);

/// Makes the report as one HTML document without foreign parts: no script, no font, no image is loaded. Scores,
/// doses, ratings, entered tests, limits, own force and entry check are in attributes, too, as the shortest text
/// that reads back the same double: `data-value`, beside `data-score`, `data-test`, `data-sum`, `data-day-of` or
/// `data-field`, which name it.
/// With a day: what was done and entered on it, each score with the value before; no trends, and no judgement of
/// trainings. The patient's fields are those of `today`.
/// @throws std::invalid_argument as check_report_day(), or if nothing was done or entered on the day
[[nodiscard]] std::string report_html(const ReportInput& input, ReportLanguage language);

/// Makes a FHIR R4 Bundle (type `collection`), UTF-8 JSON: an Observation for each score, for each exercise (with
/// dose, difficulty, success, pain and fatigue), and for each entered test; a Device for each device. The patient is
/// an identifier, the code. Codes are local; units are UCUM. A score without a value has `dataAbsentReason`. Without
/// results and tests there is no `entry`: JSON of FHIR has no empty lists.
/// @throws as report_html()
[[nodiscard]] std::string report_fhir(const ReportInput& input);

/// @returns a unit of this program in UCUM, https://ucum.org: "N", "deg", "1" for "-", "%", "{blocks}/min"
[[nodiscard]] std::string ucum_of(std::string_view unit);

}  // namespace phalanx
