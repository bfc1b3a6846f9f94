// SPDX-License-Identifier: Apache-2.0
// Names of scores, tests and symbols for people, in the languages of a report.
#pragma once

#include <string>
#include <string_view>

#include "phalanx/report/report.h"

namespace phalanx::report {

/// @returns a score's name for people: "index_peak_force_n" is "Index finger: largest force". A name that is
/// not known keeps its words
[[nodiscard]] std::string score_label(std::string_view name, ReportLanguage language);
/// @returns why a score has no value, a trial does not count or an exercise ended, in the language. A German report
/// quotes a text that is no reason of this program
[[nodiscard]] std::string reason_label(std::string_view reason, ReportLanguage language);
/// @returns a method of calibration, mode of contacts or stabiliser in the language; a German one has the code in
/// parentheses. Methods of several channels are joined by "+". An unknown code stays as it is
[[nodiscard]] std::string condition_label(std::string_view code, ReportLanguage language);
/// @returns the device of a result, which also states if a simulated participant used it
[[nodiscard]] std::string device_label(std::string_view device, ReportLanguage language);
/// @returns the name of a prescription's key, such as pain_limit
[[nodiscard]] std::string prescription_key_label(std::string_view key, ReportLanguage language);
/// @returns a patient's picture word in the language
[[nodiscard]] std::string symbol_label(std::string_view symbol, ReportLanguage language);
/// @returns the title of a kind of test in the language
[[nodiscard]] std::string test_label(TestKind kind, ReportLanguage language);
/// @returns "index finger", "Zeigefinger"; an unknown digit as it is
[[nodiscard]] std::string digit_label(std::string_view digit, ReportLanguage language);
/// @returns a unit for people: "\u00B0" for "deg", nothing for "-"
[[nodiscard]] std::string unit_label(std::string_view unit);

}  // namespace phalanx::report
