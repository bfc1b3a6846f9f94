// SPDX-License-Identifier: Apache-2.0
#include "exercise/exercise_station.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <stdexcept>
#include <utility>

#include "exercise/exercise_text.h"
#include "phalanx/core/index.h"
#include "phalanx/scene/exercise_file.h"
#include "phalanx/step/haptic_step.h"
#include "run/terminate.h"
#include "terminal/end_signals.h"
#include "terminal/error_line.h"

namespace phalanx {
namespace {

constexpr double kBetweenLooks = 0.02;       // of this thread [s]
constexpr double kBetweenMovements = 0.005;  // of a simulated participant [s]
constexpr double kDemoResumes = 1.0;  // after which a simulated participant resumes what it did not pause [s]
constexpr double kAfterEnd = 0.5;     // for the ramp to zero after the exercise's end [s]
constexpr const char* kFaultReports = "out/faults";
constexpr const char* kKnownLines =
    "pause, resume, skip, pain N, fatigue N, answer N, difficulty N, reset, stop or quit";

/// What is assumed of a person who has no measured force and range: those of the simulated participant.
PersonLimits assumed_person(PersonLimits person, const HandParameters& hand, const ParticipantSkill& skill) {
  for (int d = 0; d < kDigits; ++d)
    if (!person.own_force[idx(d)]) person.own_force[idx(d)] = std::min(skill.strength, person.force_cap);
  for (std::size_t j = 0; j < kJoints; ++j) {
    const double closed = hand.closed_angle[j].value_or(hand.max_angle[j]);
    const double range = closed - hand.open_angle[j];
    if (!person.own_range[j] && range > 0.0)
      person.own_range[j] = OwnRange{.min = hand.open_angle[j] + skill.extension_deficit * range,
                                     .max = closed - skill.flexion_deficit * range};
  }
  return person;
}

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

ExerciseStation::ExerciseStation(ExercisePlan plan, const Clock& clock, RunConsole& console)
    : plan_(std::move(plan)), clock_(clock), console_(console), recorder_("", kFaultReports) {}

bool ExerciseStation::go() {
  check_recordings_folder(plan_.recording);
  session_ = std::make_unique<Session>(plan_.session, clock_);
  std::exception_ptr failure;
  {
    const LetsGoAtTerminate lets_go(*session_, clock_);
    try {
      serve();
    } catch (...) {
      failure = std::current_exception();
    }
    session_->shut_down();
  }
  while (auto report = session_->take_fault_report()) write_report(std::move(*report));
  recorder_.finish(failure == nullptr, [this](const RecordingStatus& recording) {
    console_.complain(
        fmt::format("the recording cannot be ended: the disk refuses the data ({}). Make room now: it is "
                    "tried again for {} s",
                    recording.trouble, RunRecorder::kPatience));
  });
  while (const auto note = recorder_.next_note())
    if (!note->complaint.empty()) console_.complain(note->complaint);
  typed_.reset();
  if (failure) std::rethrow_exception(failure);
  return !recorder_.lost();
}

void ExerciseStation::serve() {
  session_->stop();  // first: forces wait for the exercise
  typed_.emplace(*session_);
  begin();
  introduce();
  watch();
}

void ExerciseStation::begin() {
  const auto info = session_->info();
  if (plan_.on_open) plan_.on_open(*info);
  ExerciseStart start = plan_.start;
  start.person.felt = felt_digits(*info);
  // A simulated device's own values are exact; those of a real one are nominal.
  start.person.calibration_independent = info->device.simulated || !plan_.session.calibration.empty();
  start.simulated = start.simulated || info->device.simulated;
  start.conditions = conditions_of(*info, plan_.session.calibration, PHALANX_VERSION);
  const HandModel& hand = info->geometry->model->hand;
  if (plan_.assume_person && plan_.skill)
    start.person = assumed_person(start.person, hand.parameters(), *plan_.skill);
  if (std::string protocol = assessment_protocol(start.exercise, start.person, info->values);
      !protocol.empty())
    start.conditions["protocol"] = std::move(protocol);
  scene_stiffness_ = start.person.stiffness_cap;
  object_place_ = place_of_first(info->values);
  if (plan_.skill) participant_.emplace(hand, start.exercise, *plan_.skill, start.seed);
  live_ = std::make_unique<LiveExercise>(
      std::move(start), 1,
      [this](const std::string& code, const std::string& text) { recorder_.event(code, "", text); });
  recorder_.begin(*session_, clock_, plan_.recording,
                  {.on_step = [this](const StepRecord& record) { live_->step(record); },
                   .on_last = [this] { live_->finish(); }});
  if (const auto recording = recorder_.recording()) file_ = recording->file;
  if (plan_.on_recording) plan_.on_recording(file_);
}

void ExerciseStation::introduce() {
  const auto info = session_->info();
  const ExerciseDescription& exercise = live_->start().exercise;
  console_.say(fmt::format("{} ({}), scene {}, device {} (serial {}), at most {} N a digit", exercise.title,
                           exercise_kind_name(exercise.kind), info->scene, info->device.name,
                           info->device.serial, info->fingertip_force));
  console_.say(fmt::format("recording: {}", file_.string()));
  console_.say(fmt::format("Not a medical device. Ctrl-C ramps to zero and ends; type {}.", kKnownLines));
  live_->input({.kind = ExerciseInput::Kind::kBegin});
}

void ExerciseStation::watch() {
  const double begin = clock_.now();
  const double between = participant_ ? kBetweenMovements : kBetweenLooks;
  double ended = 0.0;
  while (asked_to_end == 0 && !quit_) {
    clock_.sleep_until(clock_.now() + between);
    const double now = clock_.now();
    if (plan_.seconds && now - begin >= *plan_.seconds) break;
    session_->poll();
    drain();
    stops_ = session_->stops();  // serve_torque() ends no stop that comes from here on
    handle_typed();
    watch_fault();
    watch_steps();
    serve_demand();
    if (participant_) take_part();
    show();
    if (!live_->done()) continue;
    if (ended == 0.0) ended = now;
    if (session_->view().at_rest || now - ended >= kAfterEnd) break;
  }
}

/// Reports what the loop, the recorder and the exercise have stored.
void ExerciseStation::drain() {
  if (auto report = session_->take_fault_report()) {
    const FaultEvent& event = report->event;
    console_.say(fmt::format("FAULT {}: {} {}", fault_name(event.fault), fault_meaning(event.fault),
                             fault_remedy(event.fault)),
                 Emphasis::kError);
    recorder_.event("fault", "", std::string(fault_name(event.fault)));
    write_report(std::move(*report));
  }
  while (const auto note = recorder_.next_note())
    if (!note->complaint.empty()) console_.complain(note->complaint);
  if (const auto recording = recorder_.recording())
    for (const std::string& text : disk_messages_.next(*recording, clock_.now()))
      console_.say(text, Emphasis::kWarning);
  for (const std::string& refusal : live_->take_refusals()) console_.complain(refusal);
}

/// A report holds the steps before the fault in plain text; those of an encrypted recording stay in it alone.
void ExerciseStation::write_report(FaultReport report) {
  if (!plan_.recording.encryption) recorder_.write_report(std::move(report));
}

void ExerciseStation::handle_typed() {
  while (asked_to_end == 0 && !quit_) {
    const auto line = typed_->next();
    if (!line) break;
    try {
      handle(line->text);
    } catch (const std::exception& error) {  // a refusal ends nothing
      console_.complain(reason(error));
    }
  }
  if (typed_->take_left_out() == 0) return;
  session_->stop();  // what was left out may have been `stop`
  torque_allowed_ = false;
  console_.complain("some typed lines were left out; forces are off until resume", Emphasis::kWarning);
}

void ExerciseStation::handle(const std::string& line) {
  if (line.empty()) return;
  if (line == "quit") {
    quit_ = true;
  } else if (line == "stop" || line == "pause") {  // TypedLines has stopped at `stop` already
    session_->stop();
    torque_allowed_ = false;
    live_->input({.kind = ExerciseInput::Kind::kPause});
  } else if (line == "resume") {
    torque_allowed_ = true;
    live_->input({.kind = ExerciseInput::Kind::kResume});
  } else if (line == "reset") {
    torque_allowed_ = true;
    session_->reset();
  } else {
    ExerciseInput input;
    try {
      input = parse_exercise_input(line);
    } catch (const ExerciseError& error) {
      throw std::invalid_argument(fmt::format("{}; type {}", error.what(), kKnownLines));
    }
    give(input);
  }
}

/// Hands an input to the exercise. One that ends it stops forces here: the exercise itself takes it only at its next step,
/// which may wait for the disk.
void ExerciseStation::give(const ExerciseInput& input) {
  const RatingLimits& limits = live_->start().exercise.ratings;
  const bool pain = input.kind == ExerciseInput::Kind::kPain && input.value >= limits.pain;
  const bool fatigue = input.kind == ExerciseInput::Kind::kFatigue && input.value >= limits.fatigue;
  // A refused rating, too: a person who types "pain 12" does not want forces.
  if (pain || fatigue || input.kind == ExerciseInput::Kind::kAbort) {
    session_->stop();
    torque_allowed_ = false;
  }
  live_->input(input);
}

void ExerciseStation::serve_demand() {
  const ExerciseDemand demand = live_->demand();
  serve_scene(demand);
  serve_torque(demand.torque && torque_allowed_ && !stalled_ && !live_->done());
}

/// The exercise stops forces at once. It brings them back only if neither a person nor a fault has stopped
/// them, up to stops_ or since.
void ExerciseStation::serve_torque(bool wanted) {
  const bool held = session_->held_stopped();
  if (!wanted && !held) session_->stop();
  // Ctrl-C sets asked_to_end before it stops the session.
  if (wanted && held && !setting_ && asked_to_end == 0) static_cast<void>(session_->resume(stops_));
}

void ExerciseStation::serve_scene(const ExerciseDemand& demand) {
  if (setting_) return;
  Overrides changes;
  if (demand.object && demand.object != object_)
    changes.emplace_back("objects", only_object(live_->start().exercise, *demand.object, object_place_));
  // Above the scene's stiffness nothing is presented, whatever an exercise asks for.
  std::optional<double> stiffness;
  if (demand.stiffness) stiffness = std::min(*demand.stiffness, scene_stiffness_);
  if (stiffness != stiffness_)
    changes.emplace_back("force.stiffness_n_per_mm",
                         fmt::format("{:.17g}", 1e-3 * stiffness.value_or(scene_stiffness_)));
  if (changes.empty()) return;
  object_ = demand.object;
  stiffness_ = stiffness;
  setting_ = true;
  session_->set(std::move(changes), [this](const ChangeOutcome& outcome) {
    setting_ = false;
    if (outcome.refused.empty()) return;
    console_.complain("the scene cannot be changed: " + outcome.refused + "; the exercise ends");
    give({.kind = ExerciseInput::Kind::kAbort});
  });
}

void ExerciseStation::take_part() {
  const ExerciseView view = live_->view();
  const ExerciseParticipant::Act act =
      participant_->act(clock_.now(), view, live_->newest(), live_->demand().object);
  static_cast<void>(session_->set_sliders(act.angle));
  if (act.input) give(*act.input);
  const bool waits = view.phase == ExercisePhase::kPaused && torque_allowed_;
  if (!waits) paused_since_ = clock_.now();
  if (clock_.now() - paused_since_ < kDemoResumes) return;
  paused_since_ = clock_.now();
  live_->input({.kind = ExerciseInput::Kind::kResume});
}

/// A fault, or a device that is gone, keeps forces off until a person resets it; after kFaultPatience the exercise ends.
void ExerciseStation::watch_fault() {
  const bool trouble = session_->view().state == SafetyState::kFault || !session_->info()->running;
  if (!trouble || setting_) {
    fault_since_ = 0.0;
    return;
  }
  const double now = clock_.now();
  if (fault_since_ == 0.0) {
    fault_since_ = now;
    torque_allowed_ = false;
    console_.complain("forces are off; type reset when the cause is gone, or quit", Emphasis::kWarning);
  }
  if (now - fault_since_ < kFaultPatience) return;
  console_.complain(fmt::format("the fault has lasted {} s; the exercise ends", kFaultPatience));
  quit_ = true;
}

/// Without evaluated steps the exercise can stop nothing: its trials do not end, and no limit of it acts.
void ExerciseStation::watch_steps() {
  const double now = clock_.now();
  const std::uint64_t steps = live_->steps();
  if (steps != steps_ || steps == 0 || setting_) {
    steps_ = steps;
    stepped_at_ = now;
    if (stalled_) console_.say("steps are evaluated again");
    stalled_ = false;
    return;
  }
  if (stalled_ || now - stepped_at_ < kLongestStall) return;
  stalled_ = true;
  if (!session_->held_stopped())
    console_.complain(
        "no step is evaluated: the disk does not take them, or the station begins again; forces are off "
        "until steps are evaluated",
        Emphasis::kWarning);
}

void ExerciseStation::show() {
  const ExerciseView view = live_->view();
  if (!view.note.empty() && view.note != noted_) {
    noted_ = view.note;
    console_.say(view.note);
  }
  if (!view.instruction.empty() && view.instruction != said_) {
    said_ = view.instruction;
    console_.say(view.instruction, Emphasis::kStrong);
    for (std::size_t i = 0; i < view.choices.size(); ++i)
      console_.say(fmt::format("  answer {}: {}", i + 1, view.choices[i]));
  }
  if (clock_.now() < next_line_) return;
  next_line_ = clock_.now() + 1.0;
  static_cast<void>(console_.status(exercise_status(view, console_.width())));
}

}  // namespace phalanx
