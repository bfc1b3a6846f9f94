// SPDX-License-Identifier: Apache-2.0
// Inputs of an ExerciseRun, what it shows, and its result.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exercise/run/exercise_machine.h"
#include "exercise/scores/trial_values.h"
#include "phalanx/core/index.h"
#include "phalanx/exercise/reasons.h"

namespace phalanx {
namespace {

bool is_whole(double value, double least, double most) {
  return value >= least && value <= most && value == std::floor(value);
}

double digit_force(const Observation& observation, int digit) {
  const double measured = observation.measured_force[idx(digit)];
  return std::isfinite(measured) ? measured : observation.force[idx(digit)];
}

}  // namespace

std::string ExerciseRun::Impl::input(const ExerciseInput& input) {
  if (view.phase == ExercisePhase::kDone) return fmt::format("the exercise has ended: {}", ended_);
  std::string refused;
  switch (input.kind) {
    case ExerciseInput::Kind::kBegin:
      refused = begin();
      break;
    case ExerciseInput::Kind::kPause:
      if (!active()) return "nothing runs that could be paused";
      pause("paused; resume when you are ready");
      break;
    case ExerciseInput::Kind::kResume:
      refused = resume();
      break;
    case ExerciseInput::Kind::kSkip:
      refused = skip();
      break;
    case ExerciseInput::Kind::kPain:
    case ExerciseInput::Kind::kFatigue:
      refused = rate(input);
      break;
    case ExerciseInput::Kind::kAnswer:
      refused = answer(input.value);
      break;
    case ExerciseInput::Kind::kAbort:
      if (closing_)
        end_rating();  // its trials are done
      else
        finish(reason_text<Reason::kPersonEnded>(), true);
      break;
    case ExerciseInput::Kind::kDifficulty:
      refused = override_difficulty(input.value);
      break;
  }
  show(nullptr);
  return refused;
}

std::string ExerciseRun::Impl::begin() {
  if (view.phase != ExercisePhase::kReady) return "the exercise has begun already";
  enter(exercise.warm_up_s > 0.0 ? ExercisePhase::kWarmUp : ExercisePhase::kRest);
  return {};
}

std::string ExerciseRun::Impl::resume() {
  if (view.phase != ExercisePhase::kPaused) return "it is not paused";
  view.note.clear();
  go_on();
  return {};
}

std::string ExerciseRun::Impl::skip() {
  switch (view.phase) {
    case ExercisePhase::kWarmUp:
      enter(ExercisePhase::kRating);
      return {};
    case ExercisePhase::kRating:
      end_rating();
      return {};
    case ExercisePhase::kRest:
      phase_s_ = std::max(phase_s_, exercise.rest_s);
      return {};
    case ExercisePhase::kTrial:
    case ExercisePhase::kAnswer:
      end_trial(reason_text<Reason::kTrialSkipped>(), false);
      return {};
    default:
      return "there is nothing to skip; begin or resume first";
  }
}

std::string ExerciseRun::Impl::rate(const ExerciseInput& input) {
  const bool pain = input.kind == ExerciseInput::Kind::kPain;
  const char* what = pain ? "pain" : "fatigue";
  if (!is_whole(input.value, 0.0, 10.0))
    return fmt::format("{} {}: a rating is a whole number from 0 to 10", what, shortest_text(input.value));
  const int value = static_cast<int>(input.value);
  ratings_.push_back({.time = time_, .kind = input.kind, .value = value});
  const int limit = pain ? exercise.ratings.pain : exercise.ratings.fatigue;
  if (value >= limit) {
    std::string reason = pain ? reason_text<Reason::kPainLimit>(value, limit)
                              : reason_text<Reason::kFatigueLimit>(value, limit);
    if (closing_)
      closing_ = fmt::format("{}; {}", *closing_, reason);
    else
      finish(std::move(reason), true);
  }
  if (view.phase != ExercisePhase::kRating) return {};
  (pain ? pain_rated_ : fatigue_rated_) = true;
  if (pain_rated_ && fatigue_rated_) end_rating();
  return {};
}

std::string ExerciseRun::Impl::answer(double value) {
  if (view.phase == ExercisePhase::kTrial && stimuli_ && stimuli_->object() && contact_s_ < kLeastContact)
    return fmt::format("feel the object first, for at least {} s", shortest_text(kLeastContact));
  if (view.choices.empty()) return "no answer is asked for now";
  if (!is_whole(value, 1.0, static_cast<double>(view.choices.size())))
    return fmt::format("answer {}: answer a number from 1 to {}", shortest_text(value), view.choices.size());
  ExerciseTrial trial = stimuli_->answer(static_cast<int>(value));
  part_ = 0;
  view.note = trial.invalid;
  add_trial(std::move(trial));
  return {};
}

std::string ExerciseRun::Impl::override_difficulty(double value) {
  if (!exercise.difficulty) return "an assessment has fixed conditions; its difficulty cannot be changed";
  if (!exercise_ranges::kDifficulty.contains(value))
    return fmt::format("difficulty {}: it must be {}", shortest_text(value),
                       exercise_ranges::kDifficulty.text());
  difficulty_ = value;
  return {};
}

std::string ExerciseRun::Impl::instruction() const {
  switch (view.phase) {
    case ExercisePhase::kReady:
      return "Begin when you are ready.";
    case ExercisePhase::kWarmUp:
      return "Warm up: move your fingers freely.";
    case ExercisePhase::kRating:
      return !pain_rated_ ? "How strong is your pain now, from 0 (none) to 10? Answer with: pain N"
                          : "How tired are you now, from 0 (not at all) to 10? Answer with: fatigue N";
    case ExercisePhase::kRest:
      return part_ > 0 ? "Let go. The second one comes." : "Rest. The next trial comes.";
    case ExercisePhase::kTrial:
      break;
    case ExercisePhase::kAnswer:
      return exercise.measure == ExerciseMeasure::kFeelAndFind ? "Which one was softer?"
                                                               : "What was in your hand?";
    case ExercisePhase::kPaused:
      return "Paused.";
    case ExercisePhase::kDone:
      return "Done.";
  }
  const std::string digit = plan_.digit >= 0 ? std::string(digit_name(plan_.digit)) : std::string();
  const bool one = exercise.measure == ExerciseMeasure::kIndependence;
  switch (view.target.kind) {
    case ExerciseTarget::Kind::kOpen:
      if (exercise.measure == ExerciseMeasure::kSqueezeRelease) return "Let go now.";
      return one ? fmt::format("Straighten only the {} finger.", digit)
                 : std::string("Open your hand as far as you can.");
    case ExerciseTarget::Kind::kClose:
      return one ? fmt::format("Bend only the {} finger.", digit)
                 : std::string("Close your hand as far as you can.");
    case ExerciseTarget::Kind::kExplore:
      return reached_ ? std::string("Stop, and hold it.") : exercise.instruction;
    default:
      return digit.empty() ? exercise.instruction : fmt::format("{} ({})", exercise.instruction, digit);
  }
}

void ExerciseRun::Impl::show_target(double t) {
  view.target = {};
  view.target.force.fill(std::numeric_limits<double>::quiet_NaN());
  view.target.angle.fill(std::numeric_limits<double>::quiet_NaN());
  if (view.phase == ExercisePhase::kTrial) {
    view.target = trial_target(exercise, person, plan_, t);
    if (stimuli_ && stimuli_->parts() > 1) {
      view.target.depth = stimuli_->depth(part_);
      view.target.sponge = part_;
    }
  } else if (view.phase == ExercisePhase::kAnswer) {
    view.target.kind = ExerciseTarget::Kind::kChoose;
  }
}

void ExerciseRun::Impl::show(const Observation* observation) {
  const double t =
      view.phase == ExercisePhase::kTrial && !steps_.empty() ? time_ - steps_.front().time : phase_s_;
  show_target(t);
  view.instruction = instruction();
  view.trials = planned_;
  const bool begun = view.phase != ExercisePhase::kReady;
  view.trial = begun ? std::min(stimuli_ ? stimuli_->number() : next_ + 1, planned_) : 0;
  double length = 0.0;
  if (view.phase == ExercisePhase::kWarmUp) length = exercise.warm_up_s;
  if (view.phase == ExercisePhase::kRest) length = exercise.rest_s;
  if (view.phase == ExercisePhase::kTrial) length = exercise.trial_s;
  if (view.phase == ExercisePhase::kRating) length = kRatingWait;
  view.remaining_s = std::max(0.0, length - t);
  view.progress = length > 0.0 ? std::clamp(t / length, 0.0, 1.0) : 0.0;
  if (view.phase == ExercisePhase::kDone) view.progress = 1.0;
  view.hides_scene = stimuli_.has_value() && active();
  view.choices.clear();
  view.asks.reset();
  if (view.phase == ExercisePhase::kRating)
    view.asks = pain_rated_ ? ExerciseInput::Kind::kFatigue : ExerciseInput::Kind::kPain;
  const bool early = view.phase == ExercisePhase::kTrial && stimuli_ && stimuli_->object().has_value() &&
                     contact_s_ >= kLeastContact;
  if (view.phase == ExercisePhase::kAnswer || early) view.choices = stimuli_->choices();
  view.successes = successes_;
  view.counted = counted_;

  const bool force =
      view.target.kind == ExerciseTarget::Kind::kForce || view.target.kind == ExerciseTarget::Kind::kSqueeze;
  const bool angle = view.target.kind == ExerciseTarget::Kind::kAngle;
  if (!force && !angle) {
    view.value.reset();
    view.value_unit.clear();
    return;
  }
  view.value_unit = force ? "N" : "deg";
  if (observation == nullptr) return;
  double sum = 0.0;
  for (int digit = 0; digit < kDigits; ++digit) {
    if (!view.target.digits[idx(digit)]) continue;
    if (force) sum += digit_force(*observation, digit);
    if (angle)
      for (const int joint : flexion_joints(digit)) sum += observation->angle[idx(joint)] * kRadToDeg;
  }
  view.value = std::isfinite(sum) ? std::optional(sum) : std::nullopt;
}

ExerciseResult ExerciseRun::Impl::result() const {
  ExerciseResult result;
  result.name = exercise.name;
  result.kind = exercise.kind;
  result.measure = exercise.measure;
  result.trials = trials_;
  result.scores = stimuli_ ? stimuli_->scores() : mean_scores(trials_);
  for (Score& score : scores_of_followers(exercise, person)) result.scores.push_back(std::move(score));
  result.interrupted = interrupted_;
  result.ended = ended_;
  result.seconds = active_s_;
  result.repetitions = repetitions_;
  result.successes = successes_;
  result.counted = counted_;
  if (exercise.difficulty) result.difficulty = difficulty_;
  result.ratings = ratings_;
  if (exercise.measure == ExerciseMeasure::kEntryCheck)
    result.entry = entry_verdict(exercise, person, result.scores);
  return result;
}

}  // namespace phalanx
