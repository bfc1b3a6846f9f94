// SPDX-License-Identifier: Apache-2.0
#include "phalanx/exercise/exercise.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "exercise/run/exercise_trial.h"
#include "exercise/scores/trial_values.h"
#include "phalanx/core/index.h"
#include "phalanx/core/nearest_name.h"

namespace phalanx {
namespace {

constexpr std::array<std::string_view, kExerciseMeasures> kMeasureNames = {
    "range_of_motion", "total_active_motion", "press_and_hold", "force_tracking", "squeeze_release",
    "pinch",           "opposition",          "independence",   "smoothness",     "feel_and_find",
    "object_in_hand",  "own_force",           "entry_check"};

// Largest size of a result as text in a recording: SessionRecorder keeps 200,000 bytes of an event. The parts
// are upper bounds with the longest reasons and the escapes of JSON; a test compares them with results.
constexpr std::size_t kLargestResultBytes = 195'000;
constexpr std::size_t kResultHeadBytes = 8'000;
constexpr std::size_t kTrialBytes = 500;
constexpr std::size_t kScoreBytes = 290;
constexpr std::size_t kAnswerBytes = 1'200;

[[noreturn]] void refuse(std::string_view key, const std::string& value, std::string_view problem) {
  throw ExerciseError(fmt::format("{} = {}: {}", key, value, problem));
}

void check_number(std::string_view key, double value, const NumberRange& range, double unit = 1.0) {
  if (range.contains(value)) return;
  NumberRange shown = range;
  shown.min /= unit;
  shown.max /= unit;
  refuse(key, shortest_text(value / unit), fmt::format("it must be {}", shown.text()));
}

void check_text(std::string_view key, const std::string& text, std::size_t most) {
  if (text.size() > most)
    refuse(key, fmt::format("\"{}...\"", text.substr(0, 20)), fmt::format("at most {} bytes fit", most));
  if (std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }))
    refuse(key, "a text with control characters", "write one line");
}

bool is_name(std::string_view name) {
  return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

bool can_train(ExerciseMeasure measure) {
  return !has_answers(measure) && measure != ExerciseMeasure::kOwnForce &&
         measure != ExerciseMeasure::kEntryCheck;
}

void check_span(std::string_view key, const std::optional<DifficultySpan>& span, const NumberRange& range) {
  if (!span) return;
  check_number(key, span->easy, range);
  check_number(key, span->hard, range);
}

void check_training(const ExerciseDescription& exercise) {
  if (!can_train(exercise.measure))
    refuse("kind", "\"training\"",
           fmt::format("{} is an assessment; write kind = \"assessment\"",
                       exercise_measure_name(exercise.measure)));
  if (!exercise.success)
    refuse("success", "none", "a training needs the table [success] with a score and at_least or at_most");
  if (!is_name(exercise.success->score))
    refuse("success.score", fmt::format("\"{}\"", exercise.success->score.substr(0, 64)),
           "write the name of a score, as docs/exercises.md lists them");
  check_number(exercise.success->at_most ? "success.at_most" : "success.at_least", exercise.success->bound,
               exercise_ranges::kBound);
  if (!exercise.difficulty)
    refuse("difficulty", "none", "a training needs the table [difficulty] with what changes");
  const Difficulty& difficulty = *exercise.difficulty;
  check_number("difficulty.start", difficulty.start, exercise_ranges::kDifficulty);
  check_number("difficulty.target_success", difficulty.target_success, exercise_ranges::kTargetSuccess);
  check_span("difficulty.target", difficulty.target, exercise_ranges::kShare);
  check_span("difficulty.tolerance", difficulty.tolerance, exercise_ranges::kTolerance);
  check_span("difficulty.rate_hz", difficulty.rate_hz, exercise_ranges::kRate);
  check_span("difficulty.success", difficulty.success, exercise_ranges::kBound);
  if (!difficulty.target && !difficulty.tolerance && !difficulty.rate_hz && !difficulty.success)
    refuse("difficulty", "no span",
           "state at least one of target, tolerance, rate_hz, success as [easy, hard]");
}

/// The rule's score must be one of a trial. The names of a trial's scores do not depend on its observations.
void check_success_score(const ExerciseDescription& exercise) {
  PersonLimits person;
  person.own_force.fill(10.0);
  person.own_range.fill(OwnRange{.min = 0.0, .max = 1.0});
  const TrialPlan plan = plan_trial(exercise, person, 0, 0.0);
  const std::vector<Score> scores = trial_scores(exercise, person, plan, {});
  if (scored_by(*exercise.success, plan, scores) != nullptr) return;
  std::vector<std::string> names;
  for (const Score& score : scores) names.push_back(score.name);
  refuse("success.score", fmt::format("\"{}\"", exercise.success->score),
         fmt::format("{}a trial of {} has the scores {}", did_you_mean(exercise.success->score, names),
                     exercise_measure_name(exercise.measure), fmt::join(names, ", ")));
}

/// The result must fit into one event of a recording, with all repetitions and the longest reasons.
void check_result_size(const ExerciseDescription& exercise) {
  const auto trials = static_cast<std::size_t>(repetitions_of(exercise));
  std::size_t all = kResultHeadBytes;
  if (has_answers(exercise.measure)) {
    all += trials * 2 * kAnswerBytes;
  } else {
    PersonLimits person;
    person.own_force.fill(10.0);
    person.own_range.fill(OwnRange{.min = 0.0, .max = 1.0});
    const std::size_t scores =
        trial_scores(exercise, person, plan_trial(exercise, person, 0, 0.0), {}).size();
    const std::size_t means = digits_in_turn(exercise.measure) ? kDigits : 1;  // of the whole exercise
    all += 2 * trials * (kTrialBytes + scores * kScoreBytes) + means * scores * kScoreBytes;
  }
  if (all <= kLargestResultBytes) return;
  const double most = static_cast<double>(exercise.trials) * static_cast<double>(kLargestResultBytes) /
                      static_cast<double>(all);
  refuse(
      "trials", fmt::format("{}", exercise.trials),
      fmt::format("the result of so many trials with so many scores may have {} bytes, more than the {} of "
                  "an event in a recording; plan about {:.0f}, or fewer digits",
                  all, kLargestResultBytes, std::max(1.0, std::floor(most))));
}

void check_objects(const ExerciseDescription& exercise) {
  if (exercise.measure != ExerciseMeasure::kObjectInHand) {
    if (!exercise.objects.empty())
      refuse("objects", fmt::format("{} objects", exercise.objects.size()),
             "only the measure object_in_hand has objects; remove them");
    return;
  }
  if (exercise.objects.size() < 2 || exercise.objects.size() > 6)
    refuse("objects", fmt::format("{} objects", exercise.objects.size()), "state 2 to 6 objects");
  for (std::size_t i = 0; i < exercise.objects.size(); ++i) {
    const ObjectChoice& object = exercise.objects[i];
    const std::string key = fmt::format("objects.{}", i);
    check_text(key + ".title", object.title, 60);
    if (object.title.empty()) refuse(key + ".title", "\"\"", "write what the participant can answer");
    if (object.kind != "sphere" && object.kind != "box" && object.kind != "cylinder")
      refuse(key + ".kind", fmt::format("\"{}\"", object.kind.substr(0, 64)),
             "write sphere, box or cylinder");
    check_number(key + ".size_mm", object.size, exercise_ranges::kObjectSize, kMm);
  }
}

void check_limits(const LoweredLimits& limits) {
  if (limits.stiffness)
    check_number("limits.stiffness_n_per_mm", *limits.stiffness, exercise_ranges::kStiffness, 1e3);
  if (limits.force) check_number("limits.force_n", *limits.force, exercise_ranges::kForce);
  if (limits.torque) check_number("limits.torque_nm", *limits.torque, exercise_ranges::kTorque);
}

void check_feel(const FeelStimuli& feel) {
  check_number("feel.softest_n_per_mm", feel.softest, exercise_ranges::kStiffness, 1e3);
  check_number("feel.stiffest_n_per_mm", feel.stiffest, exercise_ranges::kStiffness, 1e3);
  check_number("feel.largest_force_n", feel.largest_force, exercise_ranges::kForce);
  check_number("feel.deep_mm", feel.deep, exercise_ranges::kDepth, kMm);
  if (feel.stiffest <= feel.softest)
    refuse("feel.stiffest_n_per_mm", shortest_text(feel.stiffest * 1e-3),
           "it must exceed feel.softest_n_per_mm");
}

void check_digits(const ExerciseDescription& exercise) {
  const auto& digits = exercise.digits;
  if (std::none_of(digits.begin(), digits.end(), [](bool digit) { return digit; }))
    refuse("digits", "[]", "name at least one digit");
  const bool fingers_only =
      exercise.measure == ExerciseMeasure::kPinch || exercise.measure == ExerciseMeasure::kOpposition;
  if (fingers_only && digits[0])
    refuse("digits", "thumb", "the thumb takes part in any case; name only the fingers");
  const auto count = std::count(digits.begin(), digits.end(), true);
  if (exercise.measure == ExerciseMeasure::kIndependence && count < 2)
    refuse("digits", "one digit", "independence compares digits; name at least two");
}

void check_times(const ExerciseDescription& exercise) {
  check_number("trial_s", exercise.trial_s, exercise_ranges::kTrialSeconds);
  check_number("rest_s", exercise.rest_s, exercise_ranges::kRest);
  check_number("warm_up_s", exercise.warm_up_s, exercise_ranges::kWarmUp);
  const bool moves_target = exercise.measure == ExerciseMeasure::kForceTracking;
  if (const double least = moves_target ? 6.0 : 3.0;
      exercise.measure != ExerciseMeasure::kObjectInHand && exercise.trial_s < least)
    refuse("trial_s", shortest_text(exercise.trial_s),
           fmt::format("a trial of {} needs at least {} s", exercise_measure_name(exercise.measure), least));
}

[[noreturn]] void refuse_follower(const ExerciseDescription& exercise, int digit) {
  throw ExerciseError(
      fmt::format("{}: the {} follows another digit of this device and cannot be measured; leave it out of "
                  "`digits`, or use a "
                  "device that measures it",
                  exercise.name, digit_name(digit)));
}

void check_felt(const ExerciseDescription& exercise, const PersonLimits& person) {
  if (exercise.measure == ExerciseMeasure::kRangeOfMotion ||
      exercise.measure == ExerciseMeasure::kTotalActiveMotion)
    return;  // these say "not measured" for single joints and digits
  const bool thumb_too =
      exercise.measure == ExerciseMeasure::kPinch || exercise.measure == ExerciseMeasure::kOpposition;
  if (thumb_too && !person.felt[0]) refuse_follower(exercise, 0);
  const bool some_suffice =
      digits_in_turn(exercise.measure) || exercise.measure == ExerciseMeasure::kEntryCheck;
  int felt = 0;
  int follower = -1;
  for (int digit = 0; digit < kDigits; ++digit) {
    if (!exercise.digits[idx(digit)]) continue;
    if (person.felt[idx(digit)])
      ++felt;
    else
      follower = digit;
  }
  if (follower >= 0 && (!some_suffice || felt == 0)) refuse_follower(exercise, follower);
}

void check_own_force(const ExerciseDescription& exercise, const PersonLimits& person) {
  for (int digit = 0; digit < kDigits; ++digit) {
    const bool takes_part =
        exercise.digits[idx(digit)] || (exercise.measure == ExerciseMeasure::kPinch && digit == 0);
    if (!takes_part || !person.felt[idx(digit)]) continue;
    const std::optional<double>& force = person.own_force[idx(digit)];
    if (!force)
      throw ExerciseError(fmt::format(
          "{}: its target is a share of the own maximal force, and that of the {} is not measured; do the "
          "assessment own_force first",
          exercise.name, digit_name(digit)));
    if (!(*force >= 0.5) || !std::isfinite(*force))
      throw ExerciseError(
          fmt::format("{}: the own maximal force of the {} is {} N, below 0.5 N; measure it again by "
                      "own_force, or choose "
                      "an exercise without forces",
                      exercise.name, digit_name(digit), shortest_text(*force)));
  }
}

void check_own_range(const ExerciseDescription& exercise, const PersonLimits& person) {
  for (int digit = 0; digit < kDigits; ++digit) {
    if (!exercise.digits[idx(digit)] || !person.felt[idx(digit)]) continue;
    bool any = false;
    for (const int joint : flexion_joints(digit))
      if (const auto& range = person.own_range[idx(joint)])
        any = any || (std::isfinite(range->max - range->min) && range->max - range->min > 5.0 * kDeg);
    if (!any)
      throw ExerciseError(fmt::format(
          "{}: its target is a share of the own range of motion, and no joint of the {} has one of more than "
          "5 degrees; do the assessment range_of_motion first",
          exercise.name, digit_name(digit)));
  }
}

}  // namespace

std::string_view exercise_kind_name(ExerciseKind kind) noexcept {
  return kind == ExerciseKind::kTraining ? "training" : "assessment";
}

std::string_view exercise_measure_name(ExerciseMeasure measure) noexcept {
  return kMeasureNames[static_cast<std::size_t>(measure)];
}

std::optional<ExerciseMeasure> find_exercise_measure(std::string_view name) noexcept {
  for (std::size_t i = 0; i < kMeasureNames.size(); ++i)
    if (kMeasureNames[i] == name) return static_cast<ExerciseMeasure>(i);
  return std::nullopt;
}

bool needs_own_force(ExerciseMeasure measure) noexcept {
  return measure == ExerciseMeasure::kPressAndHold || measure == ExerciseMeasure::kForceTracking ||
         measure == ExerciseMeasure::kPinch;
}

bool needs_own_range(ExerciseMeasure measure) noexcept { return measure == ExerciseMeasure::kSmoothness; }

bool needs_torque(ExerciseMeasure measure) noexcept {
  return needs_own_force(measure) || has_answers(measure) || measure == ExerciseMeasure::kSqueezeRelease ||
         measure == ExerciseMeasure::kOwnForce;
}

bool digits_in_turn(ExerciseMeasure measure) noexcept {
  switch (measure) {
    case ExerciseMeasure::kPinch:
    case ExerciseMeasure::kOpposition:
    case ExerciseMeasure::kIndependence:
    case ExerciseMeasure::kSmoothness:
    case ExerciseMeasure::kOwnForce:
      return true;
    default:
      return false;
  }
}

bool has_answers(ExerciseMeasure measure) noexcept {
  return measure == ExerciseMeasure::kFeelAndFind || measure == ExerciseMeasure::kObjectInHand;
}

int repetitions_of(const ExerciseDescription& exercise) {
  if (exercise.measure == ExerciseMeasure::kFeelAndFind) return exercise.trials + exercise.trials / 2;
  if (exercise.measure == ExerciseMeasure::kObjectInHand)
    return exercise.trials * static_cast<int>(exercise.objects.size());
  if (!digits_in_turn(exercise.measure)) return exercise.trials;
  return exercise.trials * static_cast<int>(std::count(exercise.digits.begin(), exercise.digits.end(), true));
}

void check_exercise(const ExerciseDescription& exercise) {
  if (!is_name(exercise.name))
    refuse("name", fmt::format("\"{}\"", exercise.name.substr(0, 64)), "write 1 to 64 of a-z, 0-9, _ and -");
  check_text("title", exercise.title, 120);
  if (exercise.title.empty()) refuse("title", "\"\"", "write one line for people");
  check_text("title_de", exercise.title_de, 120);
  check_text("instruction", exercise.instruction, 300);
  if (exercise.instruction.empty()) refuse("instruction", "\"\"", "write what the participant should do");
  if (!is_name(exercise.scene))
    refuse("scene", fmt::format("\"{}\"", exercise.scene.substr(0, 64)),
           "write the name of a scene; `phalanx scene list` shows them");
  check_digits(exercise);
  check_number("trials", exercise.trials, exercise_ranges::kTrials);
  check_times(exercise);
  check_number("target", exercise.target, exercise_ranges::kShare);
  check_number("tolerance", exercise.tolerance, exercise_ranges::kTolerance);
  check_number("rate_hz", exercise.rate_hz, exercise_ranges::kRate);
  if (exercise.kind == ExerciseKind::kTraining) {
    check_training(exercise);
  } else if (exercise.success || exercise.difficulty) {
    refuse(exercise.success ? "success" : "difficulty", "a table",
           "an assessment has fixed conditions; remove it, or write kind = \"training\"");
  }
  check_number("dose.most_repetitions", exercise.dose.repetitions, exercise_ranges::kRepetitions);
  check_number("dose.most_minutes", exercise.dose.minutes, exercise_ranges::kMinutes);
  check_number("ratings.pain_limit", exercise.ratings.pain, exercise_ranges::kRating);
  check_number("ratings.fatigue_limit", exercise.ratings.fatigue, exercise_ranges::kRating);
  check_limits(exercise.limits);
  check_feel(exercise.feel);
  check_objects(exercise);
  check_number("entry.least_flexion_deg", exercise.entry.flexion, exercise_ranges::kEntryAngle, kDeg);
  check_number("entry.least_release_deg", exercise.entry.release, exercise_ranges::kEntryAngle, kDeg);
  if (exercise.measure == ExerciseMeasure::kFeelAndFind && (exercise.trials < 10 || exercise.trials > 40))
    refuse("trials", fmt::format("{}", exercise.trials), "feel_and_find needs 10 to 40 answers");
  if (const int all = repetitions_of(exercise); all > exercise.dose.repetitions)
    refuse("dose.most_repetitions", fmt::format("{}", exercise.dose.repetitions),
           fmt::format("the exercise has {} trials; allow them, or plan fewer", all));
  if (exercise.success) check_success_score(exercise);
  check_result_size(exercise);
}

void check_person(const ExerciseDescription& exercise, const PersonLimits& person) {
  if (!(person.force_cap > 0.0) || !(person.stiffness_cap > 0.0) ||
      !(person.stable_stiffness.value_or(1.0) > 0.0))
    throw ExerciseError(
        fmt::format("{}: the person's limits of force and stiffness must be above 0", exercise.name));
  if (exercise.measure == ExerciseMeasure::kFeelAndFind && !person.stable_stiffness)
    throw ExerciseError(fmt::format(
        "{}: the largest stiffness at which this device is stable is not known, so that no pair of sponges "
        "can be presented; measure it with this scene and stabiliser (docs/stability.md), and state it",
        exercise.name));
  check_felt(exercise, person);
  if (needs_own_force(exercise.measure)) check_own_force(exercise, person);
  if (needs_own_range(exercise.measure)) check_own_range(exercise, person);
  if (person.difficulty) check_number("difficulty", *person.difficulty, exercise_ranges::kDifficulty);
  if (person.repetitions_today >= exercise.dose.repetitions ||
      !(person.minutes_today < exercise.dose.minutes))
    throw ExerciseError(fmt::format(
        "{}: today's dose is used up: {} of {} repetitions, {:.1f} of {} minutes; continue tomorrow",
        exercise.name, person.repetitions_today, exercise.dose.repetitions, person.minutes_today,
        shortest_text(exercise.dose.minutes)));
}

}  // namespace phalanx
