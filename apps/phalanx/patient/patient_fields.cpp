// SPDX-License-Identifier: Apache-2.0
#include "patient/patient_fields.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "phalanx/patients/bound_files.h"
#include "phalanx/patients/patient_change.h"
#include "phalanx/patients/prescribed_line.h"
#include "phalanx/patients/prescription_template.h"

namespace phalanx {
namespace {

/// Splits "index=12.5".
std::pair<std::string, std::string> name_and_value(const std::string& option, const std::string& text) {
  const std::size_t at = text.find('=');
  if (at == std::string::npos || at == 0)
    throw std::invalid_argument(fmt::format("{} {}: write NAME=VALUE", option, text));
  return {text.substr(0, at), text.substr(at + 1)};
}

double typed_number(const std::string& option, const std::string& text, const std::string& number) {
  double value = 0.0;
  if (!CLI::detail::lexical_cast(number, value) || !std::isfinite(value))
    throw std::invalid_argument(fmt::format(
        "{} {}: '{}' is not a number; write its digits alone, without a unit", option, text, number));
  return value;
}

void take_own_force(Patient& patient, const std::string& text) {
  const auto [name, value] = name_and_value("--own-force", text);
  int digit = 0;
  while (digit < kDigits && digit_name(digit) != name) ++digit;
  if (digit == kDigits)
    throw std::invalid_argument(fmt::format(
        "--own-force {}: '{}' is no digit; known are thumb, index, middle, ring, little", text, name));
  patient.own_force_n[static_cast<std::size_t>(digit)] = typed_number("--own-force", text, value);
}

void take_own_range(Patient& patient, const std::string& text) {
  const auto [name, value] = name_and_value("--own-range", text);
  const std::size_t comma = value.find(',');
  if (comma == std::string::npos)
    throw std::invalid_argument(
        fmt::format("--own-range {}: write JOINT=LEAST,LARGEST in degrees, as index_pip_flexion=2,80", text));
  const double least = typed_number("--own-range", text, value.substr(0, comma));
  const double largest = typed_number("--own-range", text, value.substr(comma + 1));
  patient.own_range_deg[name] = {least, largest};
}

void take_entry_check(Patient& patient, const PatientFields& fields, const std::string& today) {
  EntryCheck check;
  check.flexion_deg = fields.entry_check[0];
  check.release_deg = fields.entry_check[1];
  check.date = fields.entry_date.empty() ? today : fields.entry_date;
  judge_entry_check(check);
  patient.entry = check;
}

void clear_field(Patient& patient, const std::string& name) {
  if (name == "profile") patient.profile.clear();
  if (name == "calibration") clear_calibration(patient);
  if (name == "range") patient.range.clear();
  if (name == "own-force") patient.own_force_n = {};
  if (name == "own-range") patient.own_range_deg.clear();
  if (name == "force-limit") patient.force_limit_n.reset();
  if (name == "stiffness-limit") patient.stiffness_limit_n_per_mm.reset();
  if (name == "torque-limit") patient.torque_limit_nm.reset();
  if (name == "contraindications") patient.contraindications.clear();
  if (name == "warnings") patient.warnings.clear();
  if (name == "prescription") patient.prescription.clear();
  if (name == "entry-check") patient.entry.reset();
  if (name == "note") patient.note.clear();
}

/// Takes a line of a prescription. One for a shipped exercise is checked with it: it must not raise a dose
/// or a limit.
void take_prescription(Patient& patient, const std::string& line, std::vector<std::string>& said) {
  PrescribedExercise wanted = prescribed_exercise_of_line(line);
  if (std::string remark = check_prescribed(wanted); !remark.empty()) said.push_back(std::move(remark));
  const auto same =
      std::find_if(patient.prescription.begin(), patient.prescription.end(),
                   [&](const PrescribedExercise& each) { return each.exercise == wanted.exercise; });
  if (same == patient.prescription.end())
    patient.prescription.push_back(std::move(wanted));
  else
    *same = std::move(wanted);
}

void take_limits_and_texts(Patient& patient, const PatientFields& fields, std::vector<std::string>& said) {
  if (fields.force_limit_n) patient.force_limit_n = fields.force_limit_n;
  if (fields.stiffness_limit_n_per_mm) patient.stiffness_limit_n_per_mm = fields.stiffness_limit_n_per_mm;
  if (fields.torque_limit_nm) patient.torque_limit_nm = fields.torque_limit_nm;
  for (const std::string& text : fields.contraindications) patient.contraindications.push_back(text);
  for (const std::string& text : fields.warnings) patient.warnings.push_back(text);
  for (const std::string& name : fields.templates)
    take_prescription_template(patient, load_prescription_template(name));
  for (const std::string& line : fields.prescription) take_prescription(patient, line, said);
  if (!fields.symbol.empty()) patient.symbol = fields.symbol;
  if (!fields.profile.empty()) patient.profile = fields.profile;
  if (!fields.note.empty()) patient.note = fields.note;
}

void take_consent(Patient& patient, const PatientFields& fields, const std::string& today) {
  if (fields.consent.empty()) {
    if (!fields.consent_date.empty())
      throw std::invalid_argument("--consent-date: it belongs to --consent yes or no; state that, too");
    return;
  }
  patient.consent = fields.consent == "yes";
  patient.consent_date = fields.consent_date.empty() ? today : fields.consent_date;
}

}  // namespace

void add_patient_fields(CLI::App& command, PatientFields& fields) {
  const auto one = [&](const char* name, std::string& value, const char* help, const char* type) {
    return command.add_option(name, value, help)->type_name(type);
  };
  const auto many = [&](const char* name, std::vector<std::string>& values, const char* help,
                        const char* type) {
    command.add_option(name, values, help)->allow_extra_args(false)->type_name(type);
  };
  one("--side", fields.side, "the hand: right or left", "SIDE")->check(CLI::IsMember({"right", "left"}));
  std::vector<std::string> symbols;
  for (const std::string_view symbol : patient_symbols()) symbols.emplace_back(symbol);
  one("--symbol", fields.symbol, "picture beside the code, against confusion", "SYMBOL")
      ->check(CLI::IsMember(symbols));
  one("--profile", fields.profile, "the hand: a name in assets/profiles or a file", "NAME");
  one("--calibration", fields.calibration, "calibration file of the device; needs --expires", "FILE");
  one("--expires", fields.expires, "last day of the calibration, UTC", "DATE");
  one("--range", fields.range, "file with the own range, measured with this calibration", "FILE");
  many("--own-force", fields.own_force, "largest own force in N, as index=12.5; may be repeated", "DIGIT=N");
  many("--own-range", fields.own_range,
       "own active range in degrees, as index_pip_flexion=2,80; may be repeated", "JOINT=MIN,MAX");
  command.add_option("--force-limit-n", fields.force_limit_n, "lowers the limit of a fingertip's force")
      ->type_name("N");
  command
      .add_option("--stiffness-limit-n-per-mm", fields.stiffness_limit_n_per_mm,
                  "lowers the largest stiffness")
      ->type_name("N/MM");
  command.add_option("--torque-limit-nm", fields.torque_limit_nm, "lowers each joint's limit of torque")
      ->type_name("NM");
  many("--contraindication", fields.contraindications, "adds a reason against any session; may be repeated",
       "TEXT");
  many("--warning", fields.warnings, "adds a text that is shown before torque; may be repeated", "TEXT");
  many(
      "--template", fields.templates,
      "prescribes the lines of a template: a name in assets/prescriptions or a file; before --prescribe; may "
      "be repeated",
      "NAME");
  many("--prescribe", fields.prescription,
       "an exercise and what differs from its file, as 'train_press trials=12 most_minutes=10'; replaces the "
       "exercise's earlier line; may be repeated",
       "LINE");
  one("--consent", fields.consent, "the person consents to the recording of these data: yes or no", "YES|NO")
      ->check(CLI::IsMember({"yes", "no"}));
  one("--consent-date", fields.consent_date, "day of the consent, UTC [today]", "DATE");
  command
      .add_option("--entry-check", fields.entry_check,
                  "active flexion and release in degrees, measured by hand, as 45,30")
      ->delimiter(',')
      ->expected(2)
      ->type_name("FLEXION,RELEASE");
  one("--entry-date", fields.entry_date, "day of the entry check, UTC [today]", "DATE");
  one("--note", fields.note, "a remark; no names, no dates of birth", "TEXT");
}

void add_cleared_fields(CLI::App& command, PatientFields& fields) {
  command.add_option("--clear", fields.cleared, "empties a field before the others are set; may be repeated")
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"profile", "calibration", "range", "own-force", "own-range", "force-limit",
                             "stiffness-limit", "torque-limit", "contraindications", "warnings",
                             "prescription", "entry-check", "note"}))
      ->type_name("FIELD");
}

std::vector<std::string> change_patient(Patient& patient, const PatientFields& fields,
                                        const std::string& today) {
  std::vector<std::string> said;
  for (const std::string& name : fields.cleared) clear_field(patient, name);
  if (!fields.side.empty()) {
    const Handedness side = fields.side == "left" ? Handedness::kLeft : Handedness::kRight;
    if (take_side(patient, side)) said.push_back(cleared_by_side(side));
  }
  take_limits_and_texts(patient, fields, said);
  if (!fields.side.empty() || !fields.profile.empty()) check_profile_side(patient);
  take_consent(patient, fields, today);
  if (!fields.calibration.empty()) {
    if (bind_calibration(patient, fields.calibration, fields.expires, today))
      said.emplace_back("the range was measured with the calibration before, and is gone: measure it again");
  } else if (!fields.expires.empty()) {
    throw std::invalid_argument(
        "--expires: it is the last day of a calibration; state --calibration FILE, too");
  }
  if (!fields.range.empty()) bind_range(patient, fields.range);
  for (const std::string& text : fields.own_force) take_own_force(patient, text);
  for (const std::string& text : fields.own_range) take_own_range(patient, text);
  if (!fields.entry_check.empty())
    take_entry_check(patient, fields, today);
  else if (!fields.entry_date.empty())
    throw std::invalid_argument("--entry-date: it belongs to --entry-check; state that, too");
  return said;
}

std::string utc_day(double utc) {
  constexpr double kYear2100 = 4102444800.0;
  if (!(utc > 0.0 && utc < kYear2100)) return "unknown";
  return fmt::format("{:%Y-%m-%d}", fmt::gmtime(static_cast<std::time_t>(utc)));
}

std::string utc_today() { return utc_day(static_cast<double>(std::time(nullptr))); }

}  // namespace phalanx
