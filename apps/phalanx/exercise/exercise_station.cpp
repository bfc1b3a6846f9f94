// SPDX-License-Identifier: Apache-2.0
#include "exercise/exercise_station.h"

#include <fmt/format.h>

#include <exception>
#include <stdexcept>
#include <utility>

#include "exercise/exercise_run_command.h"
#include "run/terminate.h"
#include "terminal/end_signals.h"
#include "terminal/error_line.h"

namespace phalanx {
namespace {

constexpr double kAfterEnd = 0.5;  // for the ramp to zero after the exercise's end [s]
constexpr const char* kFaultReports = "out/faults";
constexpr const char* kKnownLines =
    "pause, resume, skip, pain N, fatigue N, answer N, difficulty N, reset, stop or quit";

}  // namespace

ExerciseStation::ExerciseStation(ExerciseStationPlan plan, const Clock& clock, RunConsole& console)
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
  live_ = std::make_unique<LiveExercise>(
      start_on(plan_.exercise, *info), 1,
      [this](const std::string& code, const std::string& text) { recorder_.event(code, "", text); });
  recorder_.begin(*session_, clock_, plan_.recording,
                  {.on_step = [this](const StepRecord& record) { live_->step(record); },
                   .on_last = [this] { live_->finish(); }});
  if (const auto recording = recorder_.recording()) file_ = recording->file;
  if (plan_.on_recording) plan_.on_recording(file_);
  ExerciseControl::Words words;
  words.say = [this](const std::string& text) { console_.say(text); };
  words.complain = [this](const std::string& text, bool error) {
    console_.complain(text, error ? Emphasis::kError : Emphasis::kWarning);
  };
  words.ends = [] { return asked_to_end != 0; };  // Ctrl-C sets it before it stops the session
  control_.emplace(*session_, *live_, plan_.exercise, std::move(words), false);
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
  const double between = control_->between_ticks();
  double ended = 0.0;
  while (asked_to_end == 0 && !quit_) {
    clock_.sleep_until(clock_.now() + between);
    const double now = clock_.now();
    if (plan_.seconds && now - begin >= *plan_.seconds) break;
    session_->poll();
    drain();
    control_->look();
    handle_typed();
    control_->tick();
    show();
    if (control_->fault_lasts()) break;
    if (!live_->done()) continue;
    if (ended == 0.0) ended = now;
    if (session_->view().at_rest || now - ended >= kAfterEnd) break;
  }
}

/// Reports what the loop, the recorder and the exercise have stored.
void ExerciseStation::drain() {
  if (auto report = session_->take_fault_report()) {
    const FaultEvent& event = report->event;
    console_.say(fmt::format("FAULT {}: {} {}", fault_name(event.fault), fault_words(event),
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
  control_->forbid_torque();  // what was left out may have been `stop`
  console_.complain("some typed lines were left out; forces are off until resume", Emphasis::kWarning);
}

void ExerciseStation::handle(const std::string& line) {
  if (line.empty()) return;
  if (line == "quit") {
    quit_ = true;
  } else if (line == "stop" || line == "pause") {  // TypedLines has stopped at `stop` already
    control_->pause();
  } else if (line == "resume") {
    control_->resume();
  } else if (line == "reset") {
    control_->allow_torque();
    control_->reset();
  } else {
    ExerciseInput input;
    try {
      input = parse_exercise_input(line);
    } catch (const ExerciseError& error) {
      throw std::invalid_argument(fmt::format("{}; type {}", error.what(), kKnownLines));
    }
    control_->give(input);
  }
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
