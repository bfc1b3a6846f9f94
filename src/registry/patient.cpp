// SPDX-License-Identifier: Apache-2.0
#include "phalanx/registry/patient.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "phalanx/core/index.h"
#include "registry/crypto.h"
#include "registry/field_checks.h"
#include "registry/json_fields.h"

namespace phalanx {
namespace {

using nlohmann::json;
using registry::check_anonymous;
using registry::check_date;
using registry::check_number;

constexpr std::array<std::string_view, 12> kSymbols = {"sun",  "tree", "boat", "star", "fish",  "house",
                                                       "leaf", "moon", "bird", "bell", "apple", "kite"};
constexpr std::size_t kMostLines = 50;
constexpr std::size_t kLongestLine = 400;
constexpr std::size_t kLongestName = 200;

/// @returns true for digits that are a day in one of the usual orders: yyyymmdd, ddmmyyyy, mmddyyyy,
/// yymmdd, ddmmyy, mmddyy
bool looks_like_date(const std::string& code) {
  std::string digits;
  for (const char each : code) {
    if (each == '-') continue;
    if (each < '0' || each > '9') return false;
    digits.push_back(each);
  }
  const auto number = [&](std::size_t begin, std::size_t count) {
    return std::stoi(digits.substr(begin, count));
  };
  const auto is_day = [](int year, int month, int day) {
    return year <= 2030 && registry::is_day(year, month, day);
  };
  if (digits.size() == 8)
    return is_day(number(0, 4), number(4, 2), number(6, 2)) ||
           is_day(number(4, 4), number(2, 2), number(0, 2)) ||
           is_day(number(4, 4), number(0, 2), number(2, 2));
  if (digits.size() == 6)
    return is_day(1900 + number(0, 2), number(2, 2), number(4, 2)) ||
           is_day(1900 + number(4, 2), number(2, 2), number(0, 2)) ||
           is_day(1900 + number(4, 2), number(0, 2), number(2, 2));
  return false;
}

void check_code(const std::string& code) {
  if (!registry::has_only(code, "A-Z0-9-", 16))
    throw std::invalid_argument(
        fmt::format("the code \"{}\" must be 1 to 16 of A-Z, 0-9 and '-', as \"P07\"", code));
  if (looks_like_date(code))
    throw std::invalid_argument(
        fmt::format("the code \"{}\" looks like a date; choose one that states nothing, as \"P07\"", code));
}

bool is_joint(const std::string& name) {
  for (int joint = 0; joint < kJoints; ++joint)
    if (joint_name(joint) == name) return true;
  return false;
}

void check_lines(std::string_view field, const std::vector<std::string>& lines) {
  if (lines.size() > kMostLines)
    throw std::invalid_argument(
        fmt::format("{} has {} lines; at most {} are possible", field, lines.size(), kMostLines));
  for (const std::string& line : lines) {
    if (line.empty()) throw std::invalid_argument(fmt::format("{} has an empty line; remove it", field));
    check_anonymous(field, line, kLongestLine);
  }
}

void check_prescription(const PrescribedExercise& line) {
  if (!registry::has_only(line.exercise, "a-z0-9_", 64))
    throw std::invalid_argument(
        fmt::format("prescription: the exercise \"{}\" must be 1 to 64 of a-z, 0-9 and '_'", line.exercise));
  check_number("prescription: repetitions_per_day", line.repetitions_per_day, 0, 1000);
  check_number("prescription: minutes_per_day", line.minutes_per_day, 0.0, 240.0);
  check_anonymous("prescription: note", line.note, kLongestLine);
  if (line.overrides.size() > kMostLines)
    throw std::invalid_argument(fmt::format("prescription: at most {} overrides are possible", kMostLines));
  for (const auto& [key, value] : line.overrides) {
    if (!registry::has_only(key, "a-zA-Z0-9._", 64))
      throw std::invalid_argument(fmt::format("prescription: \"{}\" is no key of an exercise", key));
    check_anonymous("prescription: an override", value, kLongestLine);
  }
}

void check_limits(const Patient& patient) {
  constexpr double kLeast = 1e-6;
  if (patient.force_limit_n) check_number("force_limit_n", *patient.force_limit_n, kLeast, 100.0);
  if (patient.stiffness_limit_n_per_mm)
    check_number("stiffness_limit_n_per_mm", *patient.stiffness_limit_n_per_mm, kLeast, 10.0);
  if (patient.torque_limit_nm) check_number("torque_limit_nm", *patient.torque_limit_nm, kLeast, 5.0);
  for (const double force : patient.own_force_n) check_number("own_force_n", force, 0.0, 200.0);
  for (const auto& [joint, range] : patient.own_range_deg) {
    if (!is_joint(joint))
      throw std::invalid_argument(fmt::format(
          "own_range_deg: there is no joint \"{}\"; the first one is \"{}\"", joint, joint_name(0)));
    check_number("own_range_deg", range.first, -180.0, 180.0);
    check_number("own_range_deg", range.second, range.first, 180.0);
  }
}

PrescribedExercise parse_prescription(const json& object) {
  registry::JsonFields fields(object, "prescription");
  PrescribedExercise out;
  fields.read("exercise", out.exercise);
  fields.read("repetitions_per_day", out.repetitions_per_day);
  fields.read("minutes_per_day", out.minutes_per_day);
  fields.read("overrides", out.overrides);
  fields.read("note", out.note);
  fields.finish();
  return out;
}

EntryCheck parse_entry(const json& object) {
  registry::JsonFields fields(object, "entry");
  EntryCheck out;
  fields.read("flexion_deg", out.flexion_deg);
  fields.read("release_deg", out.release_deg);
  fields.read("date", out.date);
  fields.read("suitable", out.suitable);
  fields.finish();
  return out;
}

void read_optional(registry::JsonFields& fields, const char* name, std::optional<double>& value) {
  if (!fields.has(name)) return;
  double number = 0.0;
  fields.read(name, number);
  value = number;
}

}  // namespace

std::span<const std::string_view> patient_symbols() noexcept { return kSymbols; }

std::string_view side_name(Handedness side) noexcept { return side == Handedness::kLeft ? "left" : "right"; }

void check_patient_fields(const Patient& patient) {
  check_code(patient.code);
  if (std::find(kSymbols.begin(), kSymbols.end(), patient.symbol) == kSymbols.end())
    throw std::invalid_argument(
        fmt::format("there is no symbol \"{}\"; take one of {}", patient.symbol, fmt::join(kSymbols, ", ")));
  check_anonymous("profile", patient.profile, kLongestName);
  check_anonymous("calibration", patient.calibration, kLongestName);
  check_anonymous("calibration_device", patient.calibration_device, kLongestName);
  check_anonymous("calibration_serial", patient.calibration_serial, kLongestName);
  check_anonymous("calibration_method", patient.calibration_method, kLongestName);
  check_date("calibration_expires", patient.calibration_expires, true);
  check_anonymous("range", patient.range, kLongestName);
  check_limits(patient);
  check_lines("contraindications", patient.contraindications);
  check_lines("warnings", patient.warnings);
  if (patient.prescription.size() > kMostLines)
    throw std::invalid_argument(fmt::format("prescription: at most {} lines are possible", kMostLines));
  for (const PrescribedExercise& line : patient.prescription) check_prescription(line);
  check_date("consent_date", patient.consent_date, true);
  if (patient.entry) {
    check_number("entry: flexion_deg", patient.entry->flexion_deg, 0.0, 180.0);
    check_number("entry: release_deg", patient.entry->release_deg, 0.0, 180.0);
    check_date("entry: date", patient.entry->date, false);
  }
  check_anonymous("note", patient.note, 4000);
}

std::string patient_json(const Patient& patient) {
  json out = {{"record", patient.record},
              {"code", patient.code},
              {"side", side_name(patient.side)},
              {"symbol", patient.symbol},
              {"profile", patient.profile},
              {"calibration", patient.calibration},
              {"calibration_device", patient.calibration_device},
              {"calibration_serial", patient.calibration_serial},
              {"calibration_method", patient.calibration_method},
              {"calibration_expires", patient.calibration_expires},
              {"range", patient.range},
              {"own_range_deg", patient.own_range_deg},
              {"own_force_n", patient.own_force_n},
              {"contraindications", patient.contraindications},
              {"warnings", patient.warnings},
              {"prescription", json::array()},
              {"consent", patient.consent},
              {"consent_date", patient.consent_date},
              {"note", patient.note}};
  if (patient.force_limit_n) out["force_limit_n"] = *patient.force_limit_n;
  if (patient.stiffness_limit_n_per_mm) out["stiffness_limit_n_per_mm"] = *patient.stiffness_limit_n_per_mm;
  if (patient.torque_limit_nm) out["torque_limit_nm"] = *patient.torque_limit_nm;
  for (const PrescribedExercise& line : patient.prescription)
    out["prescription"].push_back({{"exercise", line.exercise},
                                   {"repetitions_per_day", line.repetitions_per_day},
                                   {"minutes_per_day", line.minutes_per_day},
                                   {"overrides", line.overrides},
                                   {"note", line.note}});
  if (patient.entry)
    out["entry"] = {{"flexion_deg", patient.entry->flexion_deg},
                    {"release_deg", patient.entry->release_deg},
                    {"date", patient.entry->date},
                    {"suitable", patient.entry->suitable}};
  return registry::json_line(out, "patient");
}

Patient parse_patient_json(std::string_view text) {
  registry::JsonFields fields(text, "patient");
  Patient out;
  std::string side = "right";
  fields.read("record", out.record);
  fields.read("code", out.code);
  fields.read("side", side);
  if (side != "left" && side != "right")
    throw std::invalid_argument(fmt::format("patient: the side \"{}\" must be left or right", side));
  out.side = side == "left" ? Handedness::kLeft : Handedness::kRight;
  fields.read("symbol", out.symbol);
  fields.read("profile", out.profile);
  fields.read("calibration", out.calibration);
  fields.read("calibration_device", out.calibration_device);
  fields.read("calibration_serial", out.calibration_serial);
  fields.read("calibration_method", out.calibration_method);
  fields.read("calibration_expires", out.calibration_expires);
  fields.read("range", out.range);
  fields.read("own_range_deg", out.own_range_deg);
  fields.read("own_force_n", out.own_force_n);
  read_optional(fields, "force_limit_n", out.force_limit_n);
  read_optional(fields, "stiffness_limit_n_per_mm", out.stiffness_limit_n_per_mm);
  read_optional(fields, "torque_limit_nm", out.torque_limit_nm);
  fields.read("contraindications", out.contraindications);
  fields.read("warnings", out.warnings);
  fields.read_with("prescription", [&](const json& lines) {
    if (!lines.is_array()) throw std::invalid_argument("patient: the prescription is no list");
    for (const json& line : lines) out.prescription.push_back(parse_prescription(line));
  });
  fields.read("consent", out.consent);
  fields.read("consent_date", out.consent_date);
  fields.read_with("entry", [&](const json& object) { out.entry = parse_entry(object); });
  fields.read("note", out.note);
  fields.finish();
  return out;
}

std::string patient_revision(const Patient& patient) {
  constexpr std::size_t kDigitsOfRevision = 32;
  return registry::sha256(patient_json(patient)).substr(0, kDigitsOfRevision);
}

}  // namespace phalanx
