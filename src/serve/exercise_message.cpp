// SPDX-License-Identifier: Apache-2.0
#include "serve/exercise_message.h"

#include <algorithm>

#include "phalanx/core/index.h"
#include "record/plain_text.h"

namespace phalanx {
namespace {

wire::Exercise::Stage wire_stage(ExerciseStatus::Stage stage) noexcept {
  switch (stage) {
    case ExerciseStatus::Stage::kOpening:
      return wire::Exercise::STAGE_OPENING;
    case ExerciseStatus::Stage::kRunning:
      return wire::Exercise::STAGE_RUNNING;
    case ExerciseStatus::Stage::kClosing:
      return wire::Exercise::STAGE_CLOSING;
    case ExerciseStatus::Stage::kEnded:
      return wire::Exercise::STAGE_ENDED;
    case ExerciseStatus::Stage::kNone:
      break;
  }
  return wire::Exercise::STAGE_NONE;
}

wire::Exercise::Phase wire_phase(ExercisePhase phase) noexcept {
  switch (phase) {
    case ExercisePhase::kWarmUp:
      return wire::Exercise::PHASE_WARM_UP;
    case ExercisePhase::kRating:
      return wire::Exercise::PHASE_RATING;
    case ExercisePhase::kRest:
      return wire::Exercise::PHASE_REST;
    case ExercisePhase::kTrial:
      return wire::Exercise::PHASE_TRIAL;
    case ExercisePhase::kAnswer:
      return wire::Exercise::PHASE_ANSWER;
    case ExercisePhase::kPaused:
      return wire::Exercise::PHASE_PAUSED;
    case ExercisePhase::kDone:
      return wire::Exercise::PHASE_DONE;
    case ExercisePhase::kReady:
      break;
  }
  return wire::Exercise::PHASE_READY;
}

wire::Exercise::Target::Kind wire_target(ExerciseTarget::Kind kind) noexcept {
  using Kind = ExerciseTarget::Kind;
  switch (kind) {
    case Kind::kForce:
      return wire::Exercise::Target::FORCE;
    case Kind::kAngle:
      return wire::Exercise::Target::ANGLE;
    case Kind::kOpen:
      return wire::Exercise::Target::OPEN;
    case Kind::kClose:
      return wire::Exercise::Target::CLOSE;
    case Kind::kSqueeze:
      return wire::Exercise::Target::SQUEEZE;
    case Kind::kTouch:
      return wire::Exercise::Target::TOUCH;
    case Kind::kExplore:
      return wire::Exercise::Target::EXPLORE;
    case Kind::kChoose:
      return wire::Exercise::Target::CHOOSE;
    case Kind::kNone:
      break;
  }
  return wire::Exercise::Target::NONE;
}

void put_target(const ExerciseStatus& status, wire::Exercise::Target& out) {
  const ExerciseTarget& target = status.view.target;
  out.set_kind(wire_target(target.kind));
  out.set_sponge(target.sponge);
  for (std::uint32_t d = 0; d < kDigits; ++d)
    if (target.digits[d]) out.add_digit(d);
  if (target.kind == ExerciseTarget::Kind::kForce) {
    for (const double force : target.force) out.add_force(static_cast<float>(force));
    out.set_low(static_cast<float>(target.low));
    out.set_high(static_cast<float>(target.high));
  }
  if (target.kind == ExerciseTarget::Kind::kExplore) out.set_depth(static_cast<float>(target.depth));
  if (target.kind == ExerciseTarget::Kind::kAngle)
    for (const double share : status.target_flexion) out.add_flexion(static_cast<float>(share));
}

/// Writes hand, contacts and forces.
void put_hand_of(const ExerciseStatus& status, wire::Exercise& out) {
  for (const double share : status.flexion) out.add_flexion(static_cast<float>(share));
  if (!status.newest) return;
  const Observation& newest = *status.newest;
  for (const double force : newest.force) out.add_force(static_cast<float>(force));
  for (const bool touches : newest.touching) out.add_touching(touches);
  for (std::size_t d = 1; d < newest.pad.size(); ++d)
    out.add_pad_distance(static_cast<float>((newest.pad[d] - newest.pad[0]).norm()));
}

void put_view(const ExerciseView& view, wire::Exercise& out) {
  out.set_phase(wire_phase(view.phase));
  out.set_instruction(as_utf8(view.instruction));
  out.set_note(as_utf8(view.note));
  out.set_trial(static_cast<std::uint32_t>(view.trial));
  out.set_trials(static_cast<std::uint32_t>(view.trials));
  out.set_progress(static_cast<float>(view.progress));
  out.set_remaining(static_cast<float>(view.remaining_s));
  if (view.value) out.set_value(static_cast<float>(*view.value));
  out.set_value_unit(view.value_unit);
  for (const std::string& choice : view.choices) *out.add_choice() = as_utf8(choice);
  if (view.asks)
    out.set_asks(*view.asks == ExerciseInput::Kind::kFatigue ? wire::Feel::TIRED : wire::Feel::PAIN);
  out.set_hides_scene(view.hides_scene);
  out.set_successes(static_cast<std::uint32_t>(view.successes));
  out.set_counted(static_cast<std::uint32_t>(view.counted));
}

}  // namespace

void write_exercise(const ExerciseStatus& status, wire::Exercise& out) {
  out.Clear();
  if (status.number == 0) return;
  out.set_number(status.number);
  out.set_name(status.exercise.name);
  out.set_title(as_utf8(status.exercise.title));
  out.set_measure(std::string(exercise_measure_name(status.exercise.measure)));
  out.set_training(status.exercise.kind == ExerciseKind::kTraining);
  out.set_symbol(as_utf8(status.symbol));
  out.set_side(status.side);
  out.set_simulated(status.simulated);
  out.set_stage(wire_stage(status.stage));
  out.set_forces_off(status.forces_off);
  out.set_trouble(as_utf8(status.trouble_without_code));
  out.set_last_success(status.last_success);
  put_view(status.view, out);
  put_target(status, *out.mutable_target());
  if (!status.view.hides_scene) put_hand_of(status, out);
}

bool exercise_runs(const ExerciseStatus& status) noexcept {
  return status.stage != ExerciseStatus::Stage::kNone && status.stage != ExerciseStatus::Stage::kEnded;
}

void hide_scene(wire::State& state) {
  for (auto* settings : {state.mutable_value(), state.mutable_changed()}) {
    const auto hidden = [](const wire::Setting& setting) {
      return setting.key().starts_with("force.") || setting.key().starts_with("objects");
    };
    settings->erase(std::remove_if(settings->begin(), settings->end(), hidden), settings->end());
  }
}

void write_patient_state(const wire::State& state, wire::State& out) {
  out.Clear();
  out.set_time(state.time());
  out.set_operator_page(state.operator_page());
  out.set_pages(state.pages());
  out.set_safety(state.safety());
  out.set_held_stopped(state.held_stopped());
  out.set_stops(state.stops());
  if (state.has_fault()) {
    *out.mutable_fault() = state.fault();
    out.mutable_fault()->clear_report();
  }
  out.set_degraded(state.degraded());
  out.set_station_gone(state.station_gone());
  out.set_device_simulated(state.device_simulated());
  out.set_renders_torque(state.renders_torque());
  out.set_device_state(state.device_state());
  out.set_estop(state.estop());
}

}  // namespace phalanx
