// SPDX-License-Identifier: Apache-2.0
#include "phalanx/clinic/exercise_patient.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

#include "phalanx/core/error_text.h"
#include "phalanx/core/index.h"
#include "phalanx/exercise/reasons.h"
#include "phalanx/patients/patient_change.h"

namespace phalanx {
namespace {

constexpr double kPerDegree = std::numbers::pi / 180.0;  // [rad]

const PrescribedExercise* prescribed_of(const Patient& patient, const std::string& exercise) {
  const auto found =
      std::find_if(patient.prescription.begin(), patient.prescription.end(),
                   [&exercise](const PrescribedExercise& line) { return line.exercise == exercise; });
  return found == patient.prescription.end() ? nullptr : &*found;
}

/// Lowers a limit; none is infinite.
void lower(std::optional<double>& limit, std::optional<double> to) {
  if (to) limit = std::min(limit.value_or(*to), *to);
}

std::string joined(const std::vector<std::string>& texts) {
  return fmt::format("{}", fmt::join(texts, "; "));
}

int last_rating(const ExerciseResult& result, ExerciseInput::Kind kind) {
  int value = -1;
  for (const ExerciseRating& rating : result.ratings)
    if (rating.kind == kind) value = rating.value;
  return value;
}

/// What was done on a day.
struct DayDose {
  int repetitions = 0;
  double minutes = 0.0;
};

/// @param exercise  its name; empty: all trainings
DayDose dose_of_day(std::span<const ResultRow> results, const std::string& day, const std::string& exercise) {
  DayDose done;
  for (const ResultRow& row : results) {
    if (utc_date(row.date) != day) continue;
    if (exercise.empty() ? row.assessment : row.exercise != exercise) continue;
    done.repetitions += row.repetitions;
    done.minutes += row.seconds / 60.0;
  }
  return done;
}

/// @returns the entries of a session by the difficulty of its valid trials, in their order; empty: it states none
std::vector<TrainingSession> entries_of_trials(const ResultRow& row) {
  std::vector<TrainingSession> entries;
  const auto detail = nlohmann::json::parse(row.detail, nullptr, false);
  if (!detail.is_object() || !detail.contains("trials") || !detail["trials"].is_array()) return {};
  for (const auto& trial : detail["trials"]) {
    if (!trial.contains("difficulty") || !trial["difficulty"].is_number()) return {};
    if (!trial.contains("success") || !trial["success"].is_boolean()) continue;
    const double difficulty = trial["difficulty"].get<double>();
    if (entries.empty() || entries.back().difficulty != difficulty)
      entries.push_back(
          {.difficulty = difficulty, .successes = 0, .counted = 0, .continues = !entries.empty()});
    ++entries.back().counted;
    entries.back().successes += trial["success"].get<bool>() ? 1 : 0;
  }
  return entries;
}

/// Lowers `least` to the score of this name. @returns false if there is no valid one
bool lower_by(std::optional<double>& least, const ExerciseResult& result, const std::string& name) {
  for (const Score& score : result.scores) {
    if (score.name != name || !score.valid()) continue;
    lower(least, score.value);
    return true;
  }
  return false;
}

/// Judges an entry check by what the device needs, whatever its file asks for.
/// @returns none: no verdict follows, since a score is not valid and no valid one is too small
std::optional<EntryCheck> measured_entry(const RecordedExercise& exercise) {
  const ExerciseResult& result = exercise.result;
  if (!result.entry) return std::nullopt;
  std::optional<double> flexion;
  std::optional<double> release;
  bool whole = true;
  for (int d = 0; d < kDigits; ++d) {
    if (!exercise.start.exercise.digits[idx(d)] || !exercise.start.person.felt[idx(d)]) continue;
    whole = lower_by(flexion, result, fmt::format("entry_flexion_{}_deg", digit_name(d))) && whole;
    whole = lower_by(release, result, fmt::format("entry_release_{}_deg", digit_name(d))) && whole;
  }
  EntryCheck check = {.flexion_deg = std::clamp(flexion.value_or(0.0), 0.0, 180.0),
                      .release_deg = std::clamp(release.value_or(0.0), 0.0, 180.0),
                      .date = utc_date(exercise.begin_utc)};
  judge_entry_check(check);
  const EntryRequirement least;
  const bool too_small = (flexion && *flexion * kPerDegree < least.flexion) ||
                         (release && *release * kPerDegree < least.release);
  if (!too_small && !(whole && flexion && release)) return std::nullopt;
  return check;
}

/// @returns true if a known result from before `utc` has measured this own force of the digit: no person has entered it
bool was_measured(double force, int digit, double utc, std::span<const ResultRow> known) {
  const std::string name = fmt::format("{}_peak_force_n", digit_name(digit));
  return std::any_of(known.begin(), known.end(), [&](const ResultRow& row) {
    return row.valid && row.assessment && row.date <= utc &&
           std::any_of(row.scores.begin(), row.scores.end(), [&](const Score& score) {
             return score.valid() && score.name == name && score.value == force;
           });
  });
}

std::string condition(const RecordedExercise& exercise, const char* key) {
  const auto found = exercise.start.conditions.find(key);
  return found == exercise.start.conditions.end() ? std::string() : found->second;
}

}  // namespace

bool is_simulated(const Patient& patient) { return patient.code.starts_with(kSimulatedCode); }

std::string utc_date(double utc) {
  return fmt::format("{:%Y-%m-%d}", fmt::gmtime(static_cast<std::time_t>(utc)));
}

ExerciseRefusal::ExerciseRefusal(const std::string& reason, const std::string& at_terminal,
                                 const std::string& on_page)
    : std::invalid_argument(fmt::format("{}; {}", reason, at_terminal)),
      on_page_(fmt::format("{}; {}", reason, on_page)) {}

std::string refusal_on_page(const std::exception& error) {
  const auto* refused = dynamic_cast<const ExerciseRefusal*>(&error);
  return refused != nullptr ? refused->on_page() : error_text(error);
}

void refuse_patient(const Patient& patient, const ExerciseDescription& exercise, bool simulated,
                    const std::string& today) {
  const std::string& code = patient.code;
  if (simulated && !is_simulated(patient))
    throw ExerciseRefusal(
        fmt::format(
            "{}: results of a simulated participant or on a simulated device never join those of a person",
            code),
        fmt::format("name a patient whose code begins with {}, or leave --patient out", kSimulatedCode),
        fmt::format(
            "choose a patient whose code begins with {}, or start the station with the person's device",
            kSimulatedCode));
  if (!simulated && is_simulated(patient))
    throw ExerciseRefusal(
        fmt::format("{}: codes that begin with {} are of simulated patients", code, kSimulatedCode),
        "name the person's code, or add --demo", "choose the person, or a simulated participant");
  if (!patient.contraindications.empty())
    throw ExerciseRefusal(
        fmt::format("{} has a contraindication: {}", code, joined(patient.contraindications)),
        fmt::format("if it no longer holds, remove it with `phalanx patient edit {}`", code),
        "if it no longer holds, remove it in the patient's fields");
  if (!patient.consent)
    throw ExerciseRefusal(fmt::format("{} has not consented to the recording of their data", code),
                          fmt::format("enter the consent with `phalanx patient edit {} --consent yes`", code),
                          "enter the consent in the patient's fields");
  if (!patient.calibration_expires.empty() && patient.calibration_expires < today)
    throw ExerciseRefusal(
        fmt::format("the calibration of {} was valid until {}, and today is {}", code,
                    patient.calibration_expires, today),
        fmt::format("calibrate again (`phalanx device calibrate`) and enter it with `phalanx patient edit {} "
                    "--calibration FILE`",
                    code),
        "calibrate again on the patient's page");
  if (exercise.measure == ExerciseMeasure::kEntryCheck) return;
  if (patient.entry && !patient.entry->suitable)
    throw std::invalid_argument(fmt::format(
        "{} is not suitable on this device (it resists, it does not assist): active flexion {:.0f} deg and "
        "release {:.0f} deg on {}; repeat the entry check if that has changed",
        code, patient.entry->flexion_deg, patient.entry->release_deg, patient.entry->date));
  const bool needs_entry = exercise.kind == ExerciseKind::kTraining || needs_torque(exercise.measure);
  if (needs_entry && !patient.entry)
    throw ExerciseRefusal(fmt::format("{} has no entry check", code),
                          fmt::format("run it first: phalanx exercise run entry_check --patient {}", code),
                          "begin the entry check first");
}

void refuse_other_hand(const Patient& patient, Handedness opened) {
  if (opened == patient.side) return;
  const std::string reason = fmt::format("the station has a {} hand, and {} exercises the {} hand",
                                         side_name(opened), patient.code, side_name(patient.side));
  if (patient.profile.empty()) {
    const char* remedy = "the exercise's scene has another hand or a mirror; name one of this side";
    throw ExerciseRefusal(reason, remedy, "the exercise's scene has another hand; choose another exercise");
  }
  throw ExerciseRefusal(
      fmt::format("{}; the profile {} is of the other hand", reason, patient.profile),
      fmt::format("enter another with `phalanx patient edit {} --profile NAME`", patient.code),
      "enter another in the patient's fields");
}

ExerciseDescription exercise_of(const Patient& patient, ExerciseDescription exercise) {
  if (const PrescribedExercise* line = prescribed_of(patient, exercise.name)) {
    std::string text = line->exercise;
    for (const auto& [key, value] : line->overrides) text += fmt::format(" {}={}", key, value);
    if (line->repetitions_per_day > 0)
      text +=
          fmt::format(" most_repetitions={}", std::min(line->repetitions_per_day, exercise.dose.repetitions));
    if (line->minutes_per_day > 0.0)
      text += fmt::format(" most_minutes={}", std::min(line->minutes_per_day, exercise.dose.minutes));
    exercise = prescribed(std::move(exercise), parse_prescription(text));
  }
  lower(exercise.limits.force, patient.force_limit_n);
  lower(exercise.limits.torque, patient.torque_limit_nm);
  if (patient.stiffness_limit_n_per_mm)
    lower(exercise.limits.stiffness, 1e3 * *patient.stiffness_limit_n_per_mm);
  return exercise;
}

std::vector<TrainingSession> difficulty_history(std::span<const ResultRow> results,
                                                const std::string& exercise) {
  std::vector<TrainingSession> history;
  for (const ResultRow& row : results) {
    if (row.exercise != exercise || row.assessment || !row.valid) continue;
    const std::vector<TrainingSession> entries = entries_of_trials(row);
    if (entries.empty())
      history.push_back(
          {.difficulty = row.difficulty, .successes = row.successes, .counted = counted_trials(row)});
    history.insert(history.end(), entries.begin(), entries.end());
  }
  return history;
}

PersonLimits person_of(const Patient& patient, const ExerciseDescription& exercise,
                       std::span<const ResultRow> results, const std::string& today) {
  PersonLimits person;
  for (int d = 0; d < kDigits; ++d)
    if (patient.own_force_n[idx(d)] > 0.0) person.own_force[idx(d)] = patient.own_force_n[idx(d)];
  for (const auto& [name, range] : patient.own_range_deg)
    if (const auto joint = find_joint(name))
      person.own_range[idx(*joint)] =
          OwnRange{.min = kPerDegree * range.first, .max = kPerDegree * range.second};
  if (patient.force_limit_n) person.force_cap = std::min(person.force_cap, *patient.force_limit_n);
  if (patient.stiffness_limit_n_per_mm)
    person.stiffness_cap = std::min(person.stiffness_cap, 1e3 * *patient.stiffness_limit_n_per_mm);
  const DayDose done = dose_of_day(results, today, exercise.name);
  person.repetitions_today = done.repetitions;
  person.minutes_today = done.minutes;
  if (exercise.kind == ExerciseKind::kTraining) {
    const DayDose all = dose_of_day(results, today, {});
    if (all.repetitions >= kDayDose.repetitions || all.minutes >= kDayDose.minutes)
      throw std::invalid_argument(
          fmt::format("{} has done {} repetitions in {:.0f} active minutes of all trainings today (UTC), of "
                      "at most {} in "
                      "{:.0f}; go on tomorrow",
                      patient.code, all.repetitions, all.minutes, kDayDose.repetitions, kDayDose.minutes));
    // What is left of this exercise's dose is at most what is left of the day's.
    person.repetitions_today = std::max(person.repetitions_today,
                                        exercise.dose.repetitions - (kDayDose.repetitions - all.repetitions));
    person.minutes_today =
        std::max(person.minutes_today, exercise.dose.minutes - (kDayDose.minutes - all.minutes));
  }
  if (exercise.kind != ExerciseKind::kTraining || !exercise.difficulty) return person;
  const PrescribedExercise* line = prescribed_of(patient, exercise.name);
  const bool stated = line != nullptr && line->overrides.contains("difficulty");
  person.difficulty = stated
                          ? exercise.difficulty->start
                          : next_difficulty(difficulty_history(results, exercise.name), *exercise.difficulty);
  return person;
}

ResultRow result_row(const RecordedExercise& exercise, const std::string& recording) {
  const bool kept = exercise.invalid.empty() && exercise.other_program;
  const std::string why = !exercise.invalid.empty() ? exercise.invalid
                          : !exercise.difference.empty() && !kept
                              ? reason_text<Reason::kNotProven>(exercise.difference)
                              : std::string();
  const ExerciseResult made =
      kept ? read_exercise_result(exercise.recorded, exercise.start.exercise) : exercise.result;
  const ExerciseResult result = why.empty() ? made : without_scores(made, why);
  ResultRow row;
  row.recording = recording;
  row.number = exercise.number;
  row.exercise = exercise.start.exercise.name;
  row.assessment = result.kind == ExerciseKind::kAssessment;
  row.date = exercise.begin_utc;
  row.scores = result.scores;
  row.conditions = {.device = condition(exercise, "device"),
                    .serial = condition(exercise, "serial"),
                    .calibration_method = condition(exercise, "calibration"),
                    .contact_mode = condition(exercise, "contact_mode"),
                    .stabiliser = condition(exercise, "stabiliser"),
                    .rendering = condition(exercise, "rendering"),
                    .protocol = condition(exercise, "protocol")};
  if (exercise.start.simulated) row.conditions.device += kSimulatedDevice;
  row.interrupted = result.interrupted;
  row.valid = why.empty();
  row.invalid = why;
  row.seconds = result.seconds;
  row.repetitions = result.repetitions;
  row.successes = result.successes;
  row.difficulty = result.difficulty.value_or(0.0);
  row.pain = last_rating(result, ExerciseInput::Kind::kPain);
  row.fatigue = last_rating(result, ExerciseInput::Kind::kFatigue);
  row.detail = !why.empty() ? exercise_result_text(result) : kept ? exercise.recorded : exercise.text;
  return row;
}

ResultRow dose_row(const ExerciseStart& start, const ExerciseResult& result, const std::string& recording,
                   double utc, const std::string& why) {
  RecordedExercise exercise;
  exercise.number = 1;
  exercise.start = start;
  exercise.begin_utc = utc;
  exercise.result = result;
  exercise.invalid = why;
  return result_row(exercise, recording);
}

bool takes_late(const Patient& patient, const RecordedExercise& exercise, const std::string& recording,
                std::span<const ResultRow> known) {
  if (exercise.start.record != patient.record) return false;
  if (condition(exercise, "side") != side_name(patient.side)) return false;
  if (patient.entry && exercise.result.entry && patient.entry->date > utc_date(exercise.begin_utc))
    return false;
  return std::none_of(known.begin(), known.end(), [&](const ResultRow& row) {
    const bool same = row.recording == recording && row.number == exercise.number;
    const bool later = row.exercise == exercise.start.exercise.name && row.date > exercise.begin_utc;
    return row.valid && (same || later);
  });
}

bool take_measured(Patient& patient, const RecordedExercise& exercise) {
  if (!exercise.proven() || exercise.result.interrupted || exercise.result.kind != ExerciseKind::kAssessment)
    return false;
  bool changed = false;
  if (const auto entry = measured_entry(exercise)) {
    patient.entry = entry;
    changed = true;
  }
  const PersonLimits measured = with_measured({}, exercise.result);
  for (int d = 0; d < kDigits; ++d) {
    if (!measured.own_force[idx(d)]) continue;
    patient.own_force_n[idx(d)] = *measured.own_force[idx(d)];
    changed = true;
  }
  for (int joint = 0; joint < kJoints; ++joint) {
    const auto& range = measured.own_range[idx(joint)];
    if (!range) continue;
    patient.own_range_deg[std::string(joint_name(joint))] = {range->min / kPerDegree,
                                                             range->max / kPerDegree};
    changed = true;
  }
  return changed;
}

bool take_late(Patient& patient, const RecordedExercise& exercise, const std::string& recording,
               std::span<const ResultRow> known) {
  if (!takes_late(patient, exercise, recording, known)) return false;
  const std::array<double, kDigits> before = patient.own_force_n;
  const std::string text = patient_json(patient);
  if (!take_measured(patient, exercise)) return false;
  for (int d = 0; d < kDigits; ++d)
    if (before[idx(d)] > 0.0 && !was_measured(before[idx(d)], d, exercise.begin_utc, known))
      patient.own_force_n[idx(d)] = before[idx(d)];
  return patient_json(patient) != text;
}

}  // namespace phalanx
