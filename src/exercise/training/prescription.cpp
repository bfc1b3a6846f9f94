// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <charconv>
#include <cmath>

#include "phalanx/core/nearest_name.h"
#include "phalanx/exercise/training.h"

namespace phalanx {
namespace {

constexpr std::array<std::string_view, 7> kPrescriptionKeys = {
    "trials",        "target_success",   "difficulty",  "pain_limit",
    "fatigue_limit", "most_repetitions", "most_minutes"};
constexpr std::size_t kLongestLine = 400;

[[noreturn]] void refuse_line(std::string_view line, const std::string& problem) {
  throw ExerciseError(fmt::format("prescription \"{}\": {}", line.substr(0, 100), problem));
}

double read_number(std::string_view line, std::string_view key, std::string_view text,
                   const NumberRange& range) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !range.contains(value))
    refuse_line(line, fmt::format("{} = {}: write a number {}", key, text.substr(0, 30), range.text()));
  return value;
}

int read_whole(std::string_view line, std::string_view key, std::string_view text, const NumberRange& range) {
  const double value = read_number(line, key, text, range);
  if (value != std::floor(value))
    refuse_line(line, fmt::format("{} = {}: write a whole number", key, text.substr(0, 30)));
  return static_cast<int>(value);
}

void read_part(std::string_view line, std::string_view part, Prescription& prescription) {
  const std::size_t equals = part.find('=');
  if (equals == std::string_view::npos)
    refuse_line(line, fmt::format("\"{}\": write KEY=VALUE without blanks; keys are {}", part.substr(0, 40),
                                  fmt::join(kPrescriptionKeys, ", ")));
  const std::string_view key = part.substr(0, equals);
  const std::string_view value = part.substr(equals + 1);
  namespace ranges = exercise_ranges;
  const auto once = [&](const auto& field) {
    if (field) refuse_line(line, fmt::format("{} is stated twice; remove one", key));
  };
  if (key == "trials") {
    once(prescription.trials);
    prescription.trials = read_whole(line, key, value, ranges::kTrials);
  } else if (key == "target_success") {
    once(prescription.target_success);
    prescription.target_success = read_number(line, key, value, ranges::kTargetSuccess);
  } else if (key == "difficulty") {
    once(prescription.difficulty);
    prescription.difficulty = read_number(line, key, value, ranges::kDifficulty);
  } else if (key == "pain_limit") {
    once(prescription.pain_limit);
    prescription.pain_limit = read_whole(line, key, value, ranges::kRating);
  } else if (key == "fatigue_limit") {
    once(prescription.fatigue_limit);
    prescription.fatigue_limit = read_whole(line, key, value, ranges::kRating);
  } else if (key == "most_repetitions") {
    once(prescription.most_repetitions);
    prescription.most_repetitions = read_whole(line, key, value, ranges::kRepetitions);
  } else if (key == "most_minutes") {
    once(prescription.most_minutes);
    prescription.most_minutes = read_number(line, key, value, ranges::kMinutes);
  } else {
    refuse_line(line, fmt::format("{}: {}keys are {}", key.substr(0, 40),
                                  did_you_mean(key, kPrescriptionKeys), fmt::join(kPrescriptionKeys, ", ")));
  }
}

/// Lowers a limit of the exercise.
template <typename Number>
void lower(const Prescription& prescription, std::string_view key, const std::optional<Number>& wanted,
           Number& limit) {
  if (!wanted) return;
  if (*wanted > limit)
    throw ExerciseError(
        fmt::format("prescription of {}: {} = {}: the exercise allows at most {}; a prescription "
                    "can only lower it",
                    prescription.exercise, key, *wanted, limit));
  limit = *wanted;
}

}  // namespace

Prescription parse_prescription(std::string_view line) {
  if (line.size() > kLongestLine) refuse_line(line, fmt::format("it has more than {} bytes", kLongestLine));
  Prescription prescription;
  std::size_t begin = 0;
  while (begin < line.size()) {
    const std::size_t end = std::min(line.find(' ', begin), line.size());
    const std::string_view part = line.substr(begin, end - begin);
    begin = end + 1;
    if (part.empty()) continue;
    if (prescription.exercise.empty()) {
      if (part.find('=') != std::string_view::npos) refuse_line(line, "it begins with the exercise's name");
      prescription.exercise = part;
    } else {
      read_part(line, part, prescription);
    }
  }
  if (prescription.exercise.empty()) refuse_line(line, "it names no exercise");
  return prescription;
}

std::string prescription_text(const Prescription& prescription) {
  std::string text = prescription.exercise;
  const auto add = [&](std::string_view key, const auto& value) {
    if (value) text.append(fmt::format(" {}={}", key, shortest_text(static_cast<double>(*value))));
  };
  add("trials", prescription.trials);
  add("target_success", prescription.target_success);
  add("difficulty", prescription.difficulty);
  add("pain_limit", prescription.pain_limit);
  add("fatigue_limit", prescription.fatigue_limit);
  add("most_repetitions", prescription.most_repetitions);
  add("most_minutes", prescription.most_minutes);
  return text;
}

ExerciseDescription prescribed(ExerciseDescription exercise, const Prescription& prescription) {
  if (prescription.exercise != exercise.name)
    throw ExerciseError(
        fmt::format("the prescription is of {}, the exercise is {}; take that of the same name",
                    prescription.exercise, exercise.name));
  const bool adapts = prescription.trials || prescription.target_success || prescription.difficulty;
  if (adapts && exercise.kind != ExerciseKind::kTraining)
    throw ExerciseError(
        fmt::format("prescription of {}: an assessment has fixed conditions; leave out trials, "
                    "target_success and difficulty",
                    exercise.name));
  if (prescription.trials) exercise.trials = *prescription.trials;
  if (prescription.target_success) exercise.difficulty->target_success = *prescription.target_success;
  if (prescription.difficulty) exercise.difficulty->start = *prescription.difficulty;
  lower(prescription, "pain_limit", prescription.pain_limit, exercise.ratings.pain);
  lower(prescription, "fatigue_limit", prescription.fatigue_limit, exercise.ratings.fatigue);
  lower(prescription, "most_repetitions", prescription.most_repetitions, exercise.dose.repetitions);
  lower(prescription, "most_minutes", prescription.most_minutes, exercise.dose.minutes);
  while (exercise.kind == ExerciseKind::kTraining && prescription.most_repetitions && exercise.trials > 1 &&
         repetitions_of(exercise) > exercise.dose.repetitions)
    --exercise.trials;  // fewer repetitions a day make a session shorter
  check_exercise(exercise);
  return exercise;
}

}  // namespace phalanx
