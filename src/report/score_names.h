// SPDX-License-Identifier: Apache-2.0
// Names of scores, exercises and symbols for people, in the languages of a report.
#pragma once

#include <string>
#include <string_view>

#include "phalanx/report/report.h"

namespace phalanx::report {

/// @returns a score's name for people: "index_peak_force_n" is "Index finger: largest force". A name that is
/// not known keeps its words
[[nodiscard]] std::string score_label(std::string_view name, ReportLanguage language);
/// @returns the title of a shipped exercise in the language, else `title`, else the name
[[nodiscard]] std::string exercise_label(std::string_view name, std::string_view title,
                                         ReportLanguage language);
/// @returns a patient's picture word in the language
[[nodiscard]] std::string symbol_label(std::string_view symbol, ReportLanguage language);
/// @returns the title of a kind of test in the language
[[nodiscard]] std::string test_label(TestKind kind, ReportLanguage language);
/// @returns "index finger", "Zeigefinger"; an unknown digit as it is
[[nodiscard]] std::string digit_label(std::string_view digit, ReportLanguage language);
/// @returns a unit for people: "\u00B0" for "deg", nothing for "-"
[[nodiscard]] std::string unit_label(std::string_view unit);

}  // namespace phalanx::report
