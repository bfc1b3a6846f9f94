// SPDX-License-Identifier: Apache-2.0
#include "phalanx/clinic/exercise_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <string_view>
#include <utility>

#include "phalanx/core/error_text.h"
#include "phalanx/scene/exercise_file.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {
namespace {

constexpr double kDemoResumes = 1.0;  // after which a simulated participant resumes what it did not pause [s]

/// Makes the value of `objects` with one object of the exercise. Keys of the object before it would not fit another kind.
/// @param place  keys that every object gets
std::string only_object(const ExerciseDescription& exercise, int object, const std::string& place) {
  constexpr std::string_view kFirst = "objects.0.";
  std::string keys = place;
  for (const auto& [key, value] : object_overrides(exercise, object))
    keys.append(fmt::format("{}{} = {}", keys.empty() ? "" : ", ", key.substr(kFirst.size()), value));
  return fmt::format("[{{ {} }}]", keys);
}

/// @returns what the scene states of its first object's place and friction
std::string place_of_first(const Overrides& values) {
  std::string keys;
  for (const char* key : {"position_mm", "rotation_deg", "friction"})
    for (const auto& [name, value] : values)
      if (name == fmt::format("objects.0.{}", key))
        keys.append(fmt::format("{}{} = {}", keys.empty() ? "" : ", ", key, value));
  return keys;
}

}  // namespace

ExerciseControl::ExerciseControl(Session& session, LiveExercise& live, const ExercisePlan& plan, Words words,
                                 bool pauses_at_stop, std::optional<std::uint64_t> known_stops)
    : session_(session),
      live_(live),
      words_(std::move(words)),
      pauses_at_stop_(pauses_at_stop),
      stops_(known_stops.value_or(session.stops())),
      newest_stop_(stops_),
      stepped_at_(session.now()),
      scene_stiffness_(live.start().person.stiffness_cap),
      paused_since_(stepped_at_) {
  const auto info = session.info();
  object_place_ = place_of_first(info->values);
  if (plan.skill)
    participant_.emplace(info->geometry->model->hand, live.start().exercise, *plan.skill, live.start().seed,
                         grasp_posture(info->values));
}

void ExerciseControl::count_stop() {
  ++stops_;
  torque_allowed_ = false;
}

void ExerciseControl::look(std::uint64_t stops) {
  if (stops == stops_) return;
  stops_ = stops;
  newest_stop_ = stops;
  if (!pauses_at_stop_) return;
  torque_allowed_ = false;
  give_pause();
}

void ExerciseControl::tick() {
  if (!change_->refused.empty()) {
    words_.complain(
        "the scene cannot be changed: " + std::exchange(change_->refused, {}) + "; the exercise ends", true);
    give({.kind = ExerciseInput::Kind::kAbort});
  }
  watch_fault();
  watch_steps();
  serve_demand();
  if (participant_) take_part();
  forces_off_ = !torque_allowed_ || stalled_;
}

/// Stops, and counts it: a stop of another person or page in the same moment is then still noticed.
void ExerciseControl::stop() {
  session_.stop();
  ++stops_;
}

bool ExerciseControl::stops_forces(const ExerciseInput& input, const RatingLimits& limits) noexcept {
  const bool pain = input.kind == ExerciseInput::Kind::kPain && input.value >= limits.pain;
  const bool fatigue = input.kind == ExerciseInput::Kind::kFatigue && input.value >= limits.fatigue;
  return pain || fatigue || input.kind == ExerciseInput::Kind::kAbort;
}

void ExerciseControl::give(const ExerciseInput& input) {
  if (stops_forces(input, live_.start().exercise.ratings)) forbid_torque();
  live_.input(input);
}

void ExerciseControl::pause() {
  forbid_torque();
  if (pauses_at_stop_)
    give_pause();
  else
    live_.input({.kind = ExerciseInput::Kind::kPause});
}

/// Pauses once, however many stops come before the exercise has taken it.
void ExerciseControl::give_pause() {
  const ExercisePhase phase = live_.view().phase;
  if (phase == ExercisePhase::kReady || phase == ExercisePhase::kPaused || phase == ExercisePhase::kDone)
    return;
  if (pause_waits()) return;
  pausing_ = live_.steps();
  live_.input({.kind = ExerciseInput::Kind::kPause});
}

/// @returns true if a pause was given that the exercise has perhaps not taken: the step that was evaluated meanwhile may
/// have begun before it
bool ExerciseControl::pause_waits() const { return pausing_ && live_.steps() < *pausing_ + 2; }

void ExerciseControl::resume() {
  torque_allowed_ = true;
  const bool paused = pause_waits() || live_.view().phase == ExercisePhase::kPaused;
  pausing_.reset();
  // After a stop before the begin there are no forces, and nothing is paused.
  if (paused || !pauses_at_stop_) live_.input({.kind = ExerciseInput::Kind::kResume});
}

bool ExerciseControl::resume(std::uint64_t stops) {
  if (stops < newest_stop_ || fault_since_ != 0.0) return false;
  resume();
  return true;
}

void ExerciseControl::reset() { session_.reset(); }

void ExerciseControl::forbid_torque() {
  stop();
  torque_allowed_ = false;
}

void ExerciseControl::allow_torque() { torque_allowed_ = true; }

void ExerciseControl::serve_demand() {
  const ExerciseDemand demand = live_.demand();
  serve_scene(demand);
  serve_torque(demand.torque && torque_allowed_ && !stalled_ && !live_.done());
}

/// Brings forces back only up to stops_, so that no stop since then is ended.
void ExerciseControl::serve_torque(bool wanted) {
  const bool held = session_.held_stopped();
  if (!wanted && !held) stop();
  const bool ends = words_.ends && words_.ends();
  if (wanted && held && !change_->waits && !ends) static_cast<void>(session_.resume(stops_));
}

void ExerciseControl::serve_scene(const ExerciseDemand& demand) {
  if (change_->waits) return;
  Overrides changes;
  if (demand.object && demand.object != object_)
    changes.emplace_back("objects", only_object(live_.start().exercise, *demand.object, object_place_));
  // Above the scene's stiffness nothing is presented, whatever an exercise asks for.
  std::optional<double> stiffness;
  if (demand.stiffness) stiffness = std::min(*demand.stiffness, scene_stiffness_);
  if (stiffness != stiffness_)
    changes.emplace_back("force.stiffness_n_per_mm",
                         fmt::format("{:.17g}", 1e-3 * stiffness.value_or(scene_stiffness_)));
  if (changes.empty()) return;
  object_ = demand.object;
  stiffness_ = stiffness;
  change_->waits = true;
  try {
    session_.set(std::move(changes), [change = change_](const ChangeOutcome& outcome) {
      change->waits = false;
      change->refused = outcome.refused;
    });
  } catch (const std::exception& error) {  // too many changes wait
    change_->waits = false;
    change_->refused = error_text(error);
  }
}

void ExerciseControl::take_part() {
  const ExerciseView view = live_.view();
  const double now = session_.now();
  const ExerciseParticipant::Act act = participant_->act(now, view, live_.newest(), live_.demand().object);
  static_cast<void>(session_.set_sliders(act.angle));
  if (act.input) give(*act.input);
  const bool waits = view.phase == ExercisePhase::kPaused && torque_allowed_;
  if (!waits) paused_since_ = now;
  if (now - paused_since_ < kDemoResumes) return;
  paused_since_ = now;
  live_.input({.kind = ExerciseInput::Kind::kResume});
}

/// A fault, or a device that is gone, keeps forces off until a person resets it.
void ExerciseControl::watch_fault() {
  const bool trouble = session_.view().state == SafetyState::kFault || !session_.info()->running;
  if (!trouble || change_->waits) {
    fault_since_ = 0.0;
    return;
  }
  const double now = session_.now();
  if (fault_since_ == 0.0) {
    fault_since_ = now;
    torque_allowed_ = false;
    if (pauses_at_stop_) give_pause();
    words_.complain(fmt::format("forces are off; {}", words_.to_reset), false);
  }
  if (fault_lasts_ || now - fault_since_ < kFaultPatience) return;
  words_.complain(fmt::format("the fault has lasted {} s; the exercise ends", kFaultPatience), true);
  fault_lasts_ = true;
}

void ExerciseControl::watch_steps() {
  const double now = session_.now();
  const std::uint64_t steps = live_.steps();
  if (steps != steps_ || steps == 0 || change_->waits) {
    steps_ = steps;
    stepped_at_ = now;
    if (stalled_) words_.say("steps are evaluated again");
    stalled_ = false;
    return;
  }
  if (stalled_ || now - stepped_at_ < kLongestStall) return;
  stalled_ = true;
  if (!session_.held_stopped())
    words_.complain(
        "no step is evaluated: the disk does not take them, or the station begins again; forces are off "
        "until steps are evaluated",
        false);
}

}  // namespace phalanx
