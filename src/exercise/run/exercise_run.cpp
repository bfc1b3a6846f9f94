// SPDX-License-Identifier: Apache-2.0
#include "phalanx/exercise/exercise_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "exercise/run/exercise_machine.h"
#include "phalanx/core/index.h"
#include "phalanx/exercise/reasons.h"
#include "phalanx/exercise/scored_steps.h"

namespace phalanx {
namespace {

std::string fault_words(ObservationFault fault) {
  switch (fault) {
    case ObservationFault::kNone:
      return {};
    case ObservationFault::kNoSample:
      return reason_text<Reason::kNoSample>();
    case ObservationFault::kFault:
      return reason_text<Reason::kStationFault>();
    case ObservationFault::kGap:
      return reason_text<Reason::kStepsMissing>();
    case ObservationFault::kNotFinite:
      return reason_text<Reason::kValueNotFinite>();
  }
  return reason_text<Reason::kUnknownFault>();
}

bool slipped(const std::vector<Observation>& steps, const std::array<bool, kDigits>& digits) {
  return std::any_of(steps.begin(), steps.end(), [&](const Observation& step) {
    for (int digit = 0; digit < kDigits; ++digit)
      if (digits[idx(digit)] && step.slips[idx(digit)]) return true;
    return false;
  });
}

}  // namespace

ExerciseRun::Impl::Impl(ExerciseDescription of, PersonLimits limits, std::uint64_t seed)
    : exercise(std::move(of)), person(std::move(limits)) {
  check_exercise(exercise);
  check_person(exercise, person);
  if (has_answers(exercise.measure)) stimuli_.emplace(exercise, person, seed);
  planned_ = stimuli_ ? stimuli_->planned() : planned_trials(exercise, person);
  if (exercise.difficulty) difficulty_ = person.difficulty.value_or(exercise.difficulty->start);
  show(nullptr);
}

bool ExerciseRun::Impl::active() const noexcept {
  return view.phase == ExercisePhase::kWarmUp || view.phase == ExercisePhase::kRest ||
         view.phase == ExercisePhase::kTrial || view.phase == ExercisePhase::kAnswer;
}

double ExerciseRun::Impl::advance(Observation& observation) {
  const bool rises = std::isfinite(observation.time) && (!any_step_ || observation.time - time_ > 0.0);
  if (!rises && observation.fault == ObservationFault::kNone)
    observation.fault =
        std::isfinite(observation.time) ? ObservationFault::kGap : ObservationFault::kNotFinite;
  double passed = 0.0;
  if (rises) {
    passed = any_step_ ? observation.time - time_ : 0.0;
    if (passed > kLongestStep && observation.fault == ObservationFault::kNone)
      observation.fault = ObservationFault::kGap;
    time_ = observation.time;
    any_step_ = true;
  }
  return std::min(passed, kLongestStep);
}

void ExerciseRun::Impl::step(Observation observation) {
  if (view.phase == ExercisePhase::kDone) return;
  const double passed = advance(observation);
  if (active()) active_s_ += passed;
  if (active() || view.phase == ExercisePhase::kRating) {
    phase_s_ += passed;
    if (!watch_torque(observation) && !watch_dose()) step_phase(observation);
  }
  show(&observation);
}

/// @returns true if the torque was lost, and the run was paused
bool ExerciseRun::Impl::watch_torque(const Observation& observation) {
  if (!demand.torque) return false;
  if (observation.torque_on) {
    torque_seen_ = true;
    return false;
  }
  if (!torque_seen_) return false;
  pause("the torque was switched off; resume when it may be on again");
  return true;
}

/// @returns true if the day's minutes are over, and the run has ended
bool ExerciseRun::Impl::watch_dose() {
  if (closing_ || person.minutes_today + minutes() < exercise.dose.minutes) return false;
  close(reason_text<Reason::kDoseOfMinutesDone>(shortest_text(exercise.dose.minutes)));
  return true;
}

void ExerciseRun::Impl::step_phase(const Observation& observation) {
  switch (view.phase) {
    case ExercisePhase::kWarmUp:
      if (phase_s_ >= exercise.warm_up_s) enter(ExercisePhase::kRating);
      break;
    case ExercisePhase::kRating:
      step_rating();
      break;
    case ExercisePhase::kRest:
      step_rest(observation);
      break;
    case ExercisePhase::kTrial:
      step_trial(observation);
      break;
    default:
      break;
  }
}

void ExerciseRun::Impl::step_rating() {
  if (phase_s_ >= kRatingWait) end_rating();
}

void ExerciseRun::Impl::end_rating() {
  if (closing_)
    finish(*closing_, false);
  else
    enter(ExercisePhase::kRest);
}

void ExerciseRun::Impl::step_rest(const Observation& observation) {
  if (stimuli_) arm(observation);
  if (phase_s_ < exercise.rest_s) return;
  const std::string reason = why_waiting(observation);
  if (reason.empty())
    begin_trial(observation);
  else
    view.note = fmt::format("it waits: {}", reason);
}

std::optional<int> ExerciseRun::Impl::touching(const Observation& observation) {
  for (int digit = 0; digit < kDigits; ++digit)
    if (observation.touching[idx(digit)]) return digit;
  return std::nullopt;
}

void ExerciseRun::Impl::arm(const Observation& observation) {
  const bool touches = demand.stiffness && touching(observation);
  if (!armed_) {
    const bool off = !observation.torque_on || observation.factor <= 0.0;
    const bool set = !demand.stiffness || std::abs(observation.stiffness - *demand.stiffness) <=
                                              kStiffnessReached * *demand.stiffness;
    armed_ = off && set && !touches && observation.fault == ObservationFault::kNone &&
             phase_s_ >= 0.5 * exercise.rest_s;
  } else if (touches) {
    armed_ = false;
    torque_seen_ = false;
  }
  demand.torque = armed_;
}

std::string ExerciseRun::Impl::why_waiting(const Observation& observation) const {
  if (observation.fault != ObservationFault::kNone) return fault_words(observation.fault);
  if (stimuli_) {
    if (demand.stiffness)
      if (const std::optional<int> digit = touching(observation))
        return fmt::format("the {} touches; let go", digit_name(*digit));
    // Equal words for all reasons: they must not say how far the next stimulus is from this one.
    if (!armed_ || !observation.torque_on || !(observation.factor >= 1.0)) return "the next one is not ready";
    if (demand.stiffness &&
        !(std::abs(observation.stiffness - *demand.stiffness) <= kStiffnessReached * *demand.stiffness))
      return "the next one is not ready";
    return {};
  }
  if (!needs_torque(exercise.measure)) return {};
  if (!observation.torque_on || !(observation.factor >= 1.0)) return "the torque is not fully on";
  return {};
}

bool ExerciseRun::Impl::torque_wanted() const noexcept {
  if (!active() || !needs_torque(exercise.measure)) return false;
  return !stimuli_ || view.phase == ExercisePhase::kTrial || (view.phase == ExercisePhase::kRest && armed_);
}

void ExerciseRun::Impl::enter(ExercisePhase phase) {
  view.phase = phase;
  phase_s_ = 0.0;
  if (phase != ExercisePhase::kTrial) armed_ = false;
  demand.torque = torque_wanted();
  if (!demand.torque) torque_seen_ = false;
  if (phase == ExercisePhase::kRating) {
    pain_rated_ = fatigue_rated_ = false;
    rated_at_ = repetitions_;
  }
  if (phase != ExercisePhase::kRest || !stimuli_) return;
  demand.stiffness = stimuli_->stiffness(part_);
  demand.object = stimuli_->object();
}

void ExerciseRun::Impl::begin_trial(const Observation& observation) {
  enter(ExercisePhase::kTrial);
  view.note.clear();
  steps_.clear();
  if (part_ == 0) trial_begin_ = observation.time;
  if (stimuli_) {
    plan_ = {.number = stimuli_->number(), .difficulty = {}, .success = {}};
    stimuli_->begin(part_);
    reached_.reset();
    contact_s_ = 0.0;
  } else {
    plan_ = plan_trial(exercise, person, next_, difficulty_);
  }
  step_trial(observation);
}

void ExerciseRun::Impl::step_trial(const Observation& observation) {
  if (stimuli_ && !steps_.empty() && touching(observation))
    contact_s_ += std::max(0.0, observation.time - steps_.back().time);
  steps_.push_back(observation);
  if (observation.fault != ObservationFault::kNone) {
    end_trial(fault_words(observation.fault), true);
    return;
  }
  if (needs_torque(exercise.measure) && !(observation.factor >= 1.0)) {
    end_trial(reason_text<Reason::kTorqueNotFullyOn>(), true);
    return;
  }
  const bool over = observation.time - steps_.front().time >= exercise.trial_s;
  if (!stimuli_) {
    if (over) end_trial({}, false);
    return;
  }
  if (stimuli_->add(observation) && !reached_) reached_ = observation.time;
  const bool held = reached_ && observation.time - *reached_ >= kHoldAtEnd;
  if (over && stimuli_->object() && contact_s_ < kLeastContact) {
    end_trial(reason_text<Reason::kTouchedTooShortly>(shortest_text(kLeastContact)), true);
  } else if (over && !stimuli_->object() && !reached_) {
    end_trial(reason_text<Reason::kEndPositionNotReached>(shortest_text(exercise.trial_s)), true);
  } else if (over || held) {
    end_part();
  }
}

void ExerciseRun::Impl::end_part() {
  if (part_ + 1 < stimuli_->parts()) {
    ++part_;
    enter(ExercisePhase::kRest);
  } else {
    enter(ExercisePhase::kAnswer);
  }
}

void ExerciseRun::Impl::judge(ExerciseTrial& trial) const {
  if (trial.invalid.empty() && !trial.scores.empty() &&
      std::none_of(trial.scores.begin(), trial.scores.end(),
                   [](const Score& score) { return score.valid(); }))
    trial.invalid = trial.scores.front().invalid;
  if (!plan_.success) return;
  const Score* score = scored_by(*plan_.success, plan_, trial.scores);
  if (score == nullptr) return;
  if (!score->valid()) {
    if (trial.invalid.empty()) trial.invalid = score->invalid;
    return;
  }
  if (!trial.invalid.empty()) return;
  trial.success =
      plan_.success->at_most ? score->value <= plan_.success->bound : score->value >= plan_.success->bound;
}

void ExerciseRun::Impl::end_trial(const std::string& invalid, bool repeat) {
  if (stimuli_) {
    ExerciseTrial trial = stimuli_->skip(invalid);
    part_ = 0;
    view.note = fmt::format("it does not count: {}", invalid);
    add_trial(std::move(trial));
    return;
  }
  ExerciseTrial trial;
  trial.number = plan_.number;
  state_conditions(exercise, person, plan_, trial);
  trial.scores = trial_scores(exercise, person, plan_, steps_);
  trial.invalid = invalid;
  if (!invalid.empty())
    for (Score& score : trial.scores)
      if (score.valid()) {
        score.value = 0.0;
        score.invalid = invalid;
      }
  judge(trial);
  const bool scored_badly = !trial.invalid.empty() && invalid.empty();
  repeat = repeat || (scored_badly &&
                      (slipped(steps_, trial_digits(exercise, plan_)) || !why_not_scored(steps_).empty()));
  repeat = repeat && repeated_ < planned_;
  if (repeat) {
    ++repeated_;
    view.note = fmt::format("trial {} is repeated: {}", trial.number, trial.invalid);
  } else {
    ++next_;
    view.note = trial.invalid.empty()
                    ? std::string()
                    : fmt::format("trial {} does not count: {}", trial.number, trial.invalid);
  }
  add_trial(std::move(trial));
}

void ExerciseRun::Impl::add_trial(ExerciseTrial trial) {
  trial.begin = trial_begin_;
  trial.end = time_;
  ++repetitions_;
  if (trial.success) {
    ++counted_;
    if (*trial.success) ++successes_;
  }
  trials_.push_back(std::move(trial));
  steps_.clear();
  if (view.phase == ExercisePhase::kDone) return;
  view.phase = ExercisePhase::kRest;  // the trial is over
  go_on();
}

/// Goes on to the next trial, or to the end of the run.
void ExerciseRun::Impl::go_on() {
  if (closing_)
    enter(ExercisePhase::kRating);
  else if (stimuli_ ? stimuli_->finished() : next_ >= planned_)
    close(reason_text<Reason::kAllTrialsDone>());
  else if (person.repetitions_today + repetitions_ >= exercise.dose.repetitions)
    close(reason_text<Reason::kDoseOfRepetitionsDone>(exercise.dose.repetitions));
  else if (repetitions_ - rated_at_ >= kTrialsBetweenRatings)
    enter(ExercisePhase::kRating);
  else
    enter(ExercisePhase::kRest);
}

bool ExerciseRun::Impl::in_trial() const noexcept {
  return view.phase == ExercisePhase::kTrial || view.phase == ExercisePhase::kAnswer || part_ > 0;
}

void ExerciseRun::Impl::pause(std::string note) {
  if (in_trial()) end_trial(reason_text<Reason::kTrialPaused>(), true);
  if (view.phase == ExercisePhase::kDone) return;
  enter(ExercisePhase::kPaused);
  view.note = std::move(note);
}

void ExerciseRun::Impl::close(std::string reason) {
  closing_ = std::move(reason);
  if (in_trial())
    end_trial(*closing_, false);  // goes on to the ratings
  else
    enter(ExercisePhase::kRating);
}

bool ExerciseRun::Impl::complete() const {
  if (stimuli_) return stimuli_->finished();
  std::vector<bool> valid(static_cast<std::size_t>(planned_), false);
  for (const ExerciseTrial& trial : trials_)
    if (trial.invalid.empty() && trial.number >= 1 && trial.number <= planned_)
      valid[idx(trial.number - 1)] = true;
  return std::all_of(valid.begin(), valid.end(), [](bool each) { return each; });
}

void ExerciseRun::Impl::finish(std::string reason, bool interrupted) {
  const bool cut = in_trial();
  ended_ = std::move(reason);
  enter(ExercisePhase::kDone);
  demand.stiffness.reset();
  if (cut) end_trial(ended_, false);
  interrupted_ = interrupted || (exercise.kind == ExerciseKind::kAssessment && !complete());
  view.note = ended_;
}

ExerciseRun::ExerciseRun(ExerciseDescription exercise, PersonLimits person, std::uint64_t seed)
    : impl_(std::make_unique<Impl>(std::move(exercise), std::move(person), seed)) {}
ExerciseRun::~ExerciseRun() = default;
ExerciseRun::ExerciseRun(ExerciseRun&&) noexcept = default;
ExerciseRun& ExerciseRun::operator=(ExerciseRun&&) noexcept = default;

void ExerciseRun::step(const Observation& observation) { impl_->step(observation); }
std::string ExerciseRun::input(const ExerciseInput& input) { return impl_->input(input); }
const ExerciseView& ExerciseRun::view() const noexcept { return impl_->view; }
const ExerciseDemand& ExerciseRun::demand() const noexcept { return impl_->demand; }
bool ExerciseRun::done() const noexcept { return impl_->view.phase == ExercisePhase::kDone; }
ExerciseResult ExerciseRun::result() const { return impl_->result(); }

}  // namespace phalanx
