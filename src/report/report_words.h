// SPDX-License-Identifier: Apache-2.0
// The fixed texts of a report in its languages, and its numbers.
#pragma once

#include <string>
#include <string_view>

#include "phalanx/report/report.h"

namespace phalanx::report {

/// Fixed texts. Those with {} are formats.
struct Words {
  const char* language;  ///< "en"
  const char* report;
  const char* session_report;
  const char* right_hand;
  const char* left_hand;
  const char* of_day;   ///< {}: day
  const char* made_on;  ///< {}: day
  const char* record;
  const char* no_device;  ///< what the device is not, and what it does not do
  const char* days_done;
  const char* exercises_done;
  const char* minutes_done;
  const char* trials_done;
  const char* to_note;
  const char* contraindication;
  const char* warning;
  const char* not_suitable;
  const char* no_consent;
  const char* calibration_expired;  ///< {}: day
  const char* incomplete_one;
  const char* incomplete_done;  ///< {}: number, above 1
  const char* as_of;            ///< {}: what, day
  const char* simulated;        ///< a simulated participant did the exercises
  const char* proven_better;
  const char* proven_worse;
  const char* proven_title;
  const char* nothing_proven;
  const char* tests;
  const char* test;
  const char* tests_lead;
  const char* assessments;
  const char* assessments_lead;
  const char* band_is;  ///< {}: difference with unit
  const char* trainings;
  const char* trainings_lead;
  const char* success_share;
  const char* difficulty;
  const char* target_range;
  const char* week_dose;
  const char* minutes_a_week;
  const char* done;
  const char* done_lead;
  const char* done_key;
  const char* value_before;
  const char* date;
  const char* exercise;
  const char* minutes;
  const char* trials;
  const char* successes;
  const char* of_counted;  ///< {}: successes, trials that were scored
  const char* successes_of_counted;
  const char* pain;     ///< largest
  const char* fatigue;  ///< largest
  const char* remark;
  const char* state;
  const char* complete;
  const char* interrupted;
  const char* not_valid;
  const char* score;
  const char* value;
  const char* origin;
  const char* measured;
  const char* rendered;
  const char* side;
  const char* more_affected;
  const char* less_affected;
  const char* rater;
  const char* note;
  const char* notes;
  const char* faults;
  const char* faults_lead;
  const char* no_faults;
  const char* not_measured;
  const char* not_measured_lead;
  const char* occurrences;
  const char* reason;
  const char* conditions;
  const char* conditions_lead;
  const char* under_conditions;  ///< {}: letter
  const char* patient;
  const char* limits;
  const char* force_limit;
  const char* stiffness_limit;
  const char* torque_limit;
  const char* entry_check;
  const char* entry_flexion;  ///< {}: number
  const char* entry_release;  ///< {}: number
  const char* suitable;
  const char* calibration;
  const char* until;  ///< {}: day
  const char* none;
  const char* prescription;
  const char* trials_a_day;        ///< {}: number
  const char* most_minutes_a_day;  ///< {}: number
  const char* own_force;
  const char* consent;
  const char* yes;
  const char* no;
  const char* verdict;
  const char* one_value;
  const char* improved;
  const char* worse;
  const char* not_proven;
  const char* no_difference;  ///< none is published
  const char* within;         ///< {}: difference
  const char* beyond;         ///< {}: difference
  const char* other_conditions;
  const char* how_to_read;
  const char* how_measured;
  const char* how_proven;
  const char* how_trained;
  const char* how_dose;
  const char* device;
  const char* serial;
  const char* method;
  const char* contact;
  const char* stabiliser;
  const char* rendering;
  const char* protocol;
  const char* not_recorded;
  const char* trial_invalid;  ///< {}: number of trials
};

[[nodiscard]] const Words& words_of(ReportLanguage language) noexcept;

/// @returns four significant digits without an exponent where that is short; with a decimal comma in German,
/// and a real minus sign
[[nodiscard]] std::string number_label(double value, ReportLanguage language);
/// @returns the number with its unit, parted by a narrow space: "12.5 N", "40\u00B0"
[[nodiscard]] std::string value_label(double value, std::string_view unit, ReportLanguage language);
/// @returns minutes of a time [s], with one decimal below ten
[[nodiscard]] std::string minutes_label(double seconds, ReportLanguage language);
/// @returns a change with its sign
[[nodiscard]] std::string change_label(double change, std::string_view unit, ReportLanguage language);
/// @returns the shortest text that reads back the same double
[[nodiscard]] std::string exact_text(double value);

}  // namespace phalanx::report
