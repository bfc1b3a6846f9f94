// SPDX-License-Identifier: Apache-2.0
#include "patient/patient_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "patient/patient_fields.h"
#include "phalanx/core/constants.h"
#include "phalanx/exercise/exercise.h"
#include "phalanx/patients/bound_files.h"
#include "phalanx/patients/prescribed_line.h"

namespace phalanx {
namespace {

/// Lines "  name: value".
class FieldLines {
 public:
  void add(std::string_view name, const std::string& value) {
    text_.append(fmt::format("  {:<18} {}\n", fmt::format("{}:", name), printable(value)));
  }
  void add_if(std::string_view name, const std::string& value) {
    if (!value.empty()) add(name, value);
  }
  void add_each(std::string_view name, const std::vector<std::string>& values) {
    for (const std::string& value : values) add(name, value);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

void add_limits(FieldLines& lines, const Patient& patient) {
  if (patient.force_limit_n) lines.add("force limit", fmt::format("{} N", *patient.force_limit_n));
  if (patient.stiffness_limit_n_per_mm)
    lines.add("stiffness limit", fmt::format("{} N/mm", *patient.stiffness_limit_n_per_mm));
  if (patient.torque_limit_nm) lines.add("torque limit", fmt::format("{} Nm", *patient.torque_limit_nm));
}

void add_measured(FieldLines& lines, const Patient& patient) {
  for (const auto& [joint, range] : patient.own_range_deg)
    lines.add("own range", fmt::format("{} {:.1f} to {:.1f} deg", joint, range.first, range.second));
  for (int digit = 0; digit < kDigits; ++digit) {
    const double force = patient.own_force_n[static_cast<std::size_t>(digit)];
    if (force > 0.0) lines.add("own force", fmt::format("{} {:.1f} N", digit_name(digit), force));
  }
}

void add_calibration(FieldLines& lines, const Patient& patient, const std::string& today) {
  if (patient.calibration.empty()) {
    lines.add("calibration", "none");
    return;
  }
  lines.add("calibration", fmt::format("{} ({} {}, {}), {}", patient.calibration, patient.calibration_device,
                                       patient.calibration_serial, patient.calibration_method,
                                       calibration_validity(patient, today)));
  lines.add_if("range", patient.range);
}

std::string verdict_of(const EntryCheck& check) {
  return fmt::format(
      "flexion {:.1f} deg, release {:.1f} deg: {}", check.flexion_deg, check.release_deg,
      check.suitable ? "suitable" : "not suitable on this device (it resists, it does not assist)");
}

/// The newest entry check that was measured. @returns none if there is none
std::optional<EntryCheck> measured_entry_check(std::span<const ResultRow> results, std::string& recording) {
  const ResultRow* newest = nullptr;
  for (const ResultRow& row : results)
    if (row.valid && !row.interrupted && row.exercise == "entry_check" &&
        (newest == nullptr || row.date >= newest->date))
      newest = &row;
  if (newest == nullptr) return std::nullopt;
  const EntryRequirement least;
  EntryCheck check{
      .flexion_deg = 180.0, .release_deg = 180.0, .date = utc_day(newest->date), .suitable = false};
  bool measured = false;
  for (const Score& score : newest->scores) {
    const bool flexion = score.name.starts_with("entry_flexion_");
    if (!score.valid() || (!flexion && !score.name.starts_with("entry_release_"))) continue;
    double& value = flexion ? check.flexion_deg : check.release_deg;
    value = std::min(value, score.value);
    measured = true;
  }
  if (!measured) return std::nullopt;
  check.suitable = check.flexion_deg * kDeg >= least.flexion && check.release_deg * kDeg >= least.release;
  recording = newest->recording;
  return check;
}

/// @returns true if the field of the patient is this measurement
bool is_same_check(const EntryCheck& field, const EntryCheck& measured) {
  constexpr double kClose = 0.01;  // [deg]
  return field.date == measured.date && std::abs(field.flexion_deg - measured.flexion_deg) < kClose &&
         std::abs(field.release_deg - measured.release_deg) < kClose;
}

std::string score_text(const Score& score) {
  if (!score.valid()) return fmt::format("{}: {}", score.name, score.invalid);
  return fmt::format("{} = {:.6g} {} ({})", score.name, score.value, score.unit,
                     score_origin_name(score.origin));
}

std::string state_of(const ResultRow& row) {
  if (!row.valid) return fmt::format("not valid: {}", row.invalid);
  return row.interrupted ? "interrupted" : "complete";
}

}  // namespace

std::string printable(std::string_view text) {
  std::string plain(text);
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }, ' ');
  return plain;
}

std::string patient_text(const Patient& patient, const std::string& today) {
  FieldLines lines;
  lines.add("record", patient.record);
  lines.add("hand", std::string(side_name(patient.side)));
  lines.add("symbol", patient.symbol);
  lines.add("consent",
            fmt::format("{}{}", patient.consent ? "yes" : "no",
                        patient.consent_date.empty() ? "" : fmt::format(", {}", patient.consent_date)));
  lines.add_if("profile", patient.profile);
  add_calibration(lines, patient, today);
  add_measured(lines, patient);
  add_limits(lines, patient);
  lines.add_each("contraindication", patient.contraindications);
  lines.add_each("warning", patient.warnings);
  for (const PrescribedExercise& each : patient.prescription) {
    lines.add("prescribed", prescribed_exercise_line(each));
    lines.add_if("  note", each.note);
  }
  lines.add_if("note", patient.note);
  return fmt::format("{}\n{}", printable(patient.code), lines.text());
}

std::string entry_checks_text(const Patient& patient, std::span<const ResultRow> results) {
  FieldLines lines;
  std::string recording;
  const std::optional<EntryCheck> measured = measured_entry_check(results, recording);
  const bool same = measured && patient.entry && is_same_check(*patient.entry, *measured);
  if (measured)
    lines.add("entry check",
              fmt::format("{} (measured, {}, {})", verdict_of(same ? *patient.entry : *measured),
                          measured->date, recording));
  if (patient.entry && !same)
    lines.add("entry check",
              fmt::format("{} (entered by hand, {})", verdict_of(*patient.entry), patient.entry->date));
  return lines.text();
}

std::string result_text(const ResultRow& row) {
  std::string text = printable(
      fmt::format("{}  {} ({}), {}, {} trials, {:.0f} s", utc_day(row.date), row.exercise,
                  row.assessment ? "assessment" : fmt::format("training, difficulty {:.2f}", row.difficulty),
                  state_of(row), row.repetitions, row.seconds));
  if (!row.assessment) text.append(fmt::format(", {} successful", row.successes));
  if (row.pain >= 0) text.append(fmt::format(", pain {}", row.pain));
  if (row.fatigue >= 0) text.append(fmt::format(", fatigue {}", row.fatigue));
  text.append(printable(fmt::format("  [{} {}]", row.recording, row.number)));
  text.append("\n");
  for (const Score& score : row.scores) text.append(fmt::format("    {}\n", printable(score_text(score))));
  return text;
}

std::string test_text(const EnteredTest& test) {
  const TestKindInfo& kind = test_kind(test.kind);
  std::string side(test_side_name(test.side));
  std::replace(side.begin(), side.end(), '_', ' ');
  return printable(fmt::format("{}  {} {:.6g} {}, {} (entered by hand, rater {}){}{}", test.date, kind.title,
                               test.value, kind.unit, side, test.rater, test.note.empty() ? "" : ": ",
                               test.note));
}

}  // namespace phalanx
