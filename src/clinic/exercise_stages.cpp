// SPDX-License-Identifier: Apache-2.0
// StationExercises on the owner's thread: opening and running. exercise_closing.cpp has the rest.
#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <exception>
#include <utility>

#include "clinic/station_exercises_impl.h"
#include "phalanx/clinic/exercise_patient.h"
#include "phalanx/core/error_text.h"
#include "phalanx/core/nice_thread.h"

namespace phalanx {
namespace {

constexpr double kAfterDone = 0.5;     // for the ramp to zero after the exercise's end [s]
constexpr double kShowsRefusal = 5.0;  // for which a refused input is shown [s]

}  // namespace

ChangeReports reports_of(StationChange& change) {
  const std::lock_guard lock(change.mutex);
  return {.file = change.file,
          .entered = change.entered,
          .opened = change.opened,
          .begun = change.begun,
          .refused = change.refused,
          .unopened = change.unopened};
}

NextRecording reporting(const std::shared_ptr<StationChange>& change, RecorderSettings settings) {
  NextRecording next;
  next.settings = std::move(settings);
  next.on_ready = [change](const std::filesystem::path& file) {
    const std::lock_guard lock(change->mutex);
    change->file = file;
  };
  next.on_refused = [change](const std::string& why) {
    const std::lock_guard lock(change->mutex);
    change->refused = why;
  };
  return next;
}

ExerciseStatus::Stage StationExercises::Impl::stage_now() const {
  const std::lock_guard lock(mutex_);
  return stage_;
}

RecorderSettings StationExercises::Impl::encrypted() const {
  RecorderSettings settings = settings_.recording;
  settings.encryption = prepared_->key;
  return settings;
}

std::shared_ptr<const KeyUse> StationExercises::Impl::use_of_key() const {
  const std::lock_guard lock(mutex_);
  return use_;
}

/// Keeps that the present recording is encrypted with the exercise's key.
void StationExercises::Impl::set_recorded() {
  const std::lock_guard lock(mutex_);
  recorded_ = prepared_->known.patient.record;
  exercised_ = prepared_->station(std::nullopt, 0);
}

void StationExercises::Impl::tick() {
  say_words();
  bool reset = false;
  {
    const std::lock_guard lock(mutex_);
    reset = std::exchange(reset_asked_, false);
  }
  if (reset) session_.reset();  // forces stay off until kResume
  switch (stage_now()) {
    case Stage::kOpening:
      return tick_opening();
    case Stage::kRunning:
      return tick_running();
    case Stage::kClosing:
      return tick_closing();
    case Stage::kNone:
    case Stage::kEnded:
      return tick_free();
  }
}

void StationExercises::Impl::say_words() {
  std::vector<Words> words;
  {
    const std::lock_guard lock(mutex_);
    words.swap(words_);
  }
  if (!settings_.say) return;
  for (const Words& each : words) settings_.say(each.text, each.warning);
}

// ---- opening

void StationExercises::Impl::tick_opening() {
  if (opening_ == nullptr) return ask_opening();
  const ChangeReports reports = reports_of(*opening_);
  if (opening_->ordered) return tick_ordered(reports);
  if (entry_.joinable()) {
    if (!reports.entered) return;
    entry_.join();
  }
  if (!reports.refused.empty() || abort_waits()) {
    static_cast<void>(recorder_.cancel_recording(opening_->recording));
    return conclude(std::nullopt, reports.refused.empty()
                                      ? "it was ended before it began"
                                      : fmt::format("the exercise cannot begin: {}", reports.refused));
  }
  if (reports.entered) {
    {
      const std::lock_guard lock(mutex_);
      is_own_ = false;
    }
    return order_station(opening_, prepared_->station(source_of_hand(), opening_->recording));
  }
  if (!reports.file.empty()) enter_recording(reports.file);
}

/// Waits for the station that was ordered. From the order on the patient's station may run at any time, so that its
/// recording must begin with it: an abort waits until the exercise has it.
void StationExercises::Impl::tick_ordered(const ChangeReports& reports) {
  if (reports.begun) set_recorded();
  if (!reports.unopened.empty()) {
    static_cast<void>(recorder_.cancel_recording(opening_->recording));
    return conclude(std::nullopt, fmt::format("the exercise cannot begin: {}", reports.unopened));
  }
  if (!reports.opened) return;
  if (!reports.refused.empty()) return leave_station(reports.refused);
  if (reports.begun) start();
}

/// Leaves the station of an exercise whose recording was refused when it ran already: its steps go into the recording
/// before it. An encrypted one follows at once.
void StationExercises::Impl::leave_station(const std::string& why) {
  unrecorded_ = fmt::format("the exercise cannot begin: {}", why);
  const std::lock_guard lock(mutex_);
  stage_ = Stage::kClosing;
  trouble_ = unrecorded_;
  inputs_.clear();
}

bool StationExercises::Impl::abort_waits() const {
  const std::lock_guard lock(mutex_);
  return std::any_of(inputs_.begin(), inputs_.end(),
                     [](const Given& given) { return given.input.kind == ExerciseInput::Kind::kAbort; });
}

/// Enters the recording for its patient, on a thread of its own: the registry may wait for its lock.
void StationExercises::Impl::enter_recording(const std::filesystem::path& file) {
  const auto work = [change = opening_, registry = registry_, prepared = prepared_,
                     name = file.filename().string()] {
    std::string refused;
    try {
      registry->add_recording(prepared->actor, prepared->known.patient.record, name);
    } catch (const std::exception& error) {
      refused = error_text(error);
    }
    const std::lock_guard lock(change->mutex);
    change->entered = true;
    if (!refused.empty()) change->refused = refused;
  };
  try {
    entry_ = start_nice_thread("phalanx-entry", work);
  } catch (const std::exception&) {  // no thread is left: the next tick tries again
  }
}

void StationExercises::Impl::ask_opening() {
  session_.stop();  // first: forces wait for the exercise
  unrecorded_.clear();
  control_.reset();
  live_.reset();
  closing_.reset();
  kept_.reset();
  done_at_ = 0.0;
  next_close_ = 0.0;
  counted_ = 0;
  successes_ = 0;
  opening_ = std::make_shared<StationChange>();
  NextRecording next = reporting(opening_, encrypted());
  next.watch = [change = opening_, carried = carried_,
                use = use_of_key()](const std::filesystem::path& file) {
    {
      const std::lock_guard lock(carried->mutex);
      carried->file = file;
    }
    {
      const std::lock_guard lock(change->mutex);
      change->begun = true;
    }
    RecordingWatch watch;
    watch.on_step = [carried](const StepRecord& record) { carried->step(record); };
    watch.on_last = [carried] { carried->finish(); };
    watch.on_ended = [carried, use](const std::filesystem::path& ended, bool whole) {
      const std::lock_guard lock(carried->mutex);
      carried->ended = EndedRecording{.file = ended.empty() ? carried->file : ended, .whole = whole};
    };
    return watch;
  };
  try {
    opening_->recording = recorder_.next_recording(std::move(next));
  } catch (const std::exception& error) {
    conclude(std::nullopt, fmt::format("the exercise cannot begin: {}", error_text(error)));
  }
}

/// @returns what moves the hand of the exercise; none: the device on a wire, or sliders as before
std::optional<HandSource> StationExercises::Impl::source_of_hand() const {
  if (prepared_->plan.skill) return HandSource::kSliders;
  if (session_.info()->device_spec == "simulated") return HandSource::kPatient;
  return std::nullopt;
}

/// Asks for the station of a change.
void StationExercises::Impl::order_station(const std::shared_ptr<StationChange>& change,
                                           const StationOrder& order) {
  change->ordered = true;
  try {
    session_.replace(order, [change](const ChangeOutcome& outcome) {
      const std::lock_guard lock(change->mutex);
      if (outcome.refused.empty())
        change->opened = true;
      else
        change->unopened = outcome.refused;
    });
  } catch (const std::exception& error) {
    const std::lock_guard lock(change->mutex);
    change->unopened = error_text(error);
  }
}

/// @returns Session::stops() if no person and no fault has stopped the station since the exercise was ordered:
/// ask_opening() stops once, and StationOrder::stopped once. Stops of the inputs that wait are counted with them.
std::uint64_t StationExercises::Impl::stops_of_opening() const {
  const std::lock_guard lock(mutex_);
  return stops_ + 2;
}

/// Begins the exercise on its station, which runs at zero torque.
void StationExercises::Impl::start() {
  try {
    const auto info = session_.info();
    refuse_on_station(prepared_->known, prepared_->plan, *info);
    live_ = std::make_shared<LiveExercise>(
        start_on(prepared_->plan, *info), 1,
        [&recorder = recorder_](const std::string& code, const std::string& text) {
          recorder.event(code, "", text);
        });
    ExerciseControl::Words words;
    words.say = [this](const std::string& text) { say(text, false); };
    words.complain = [this](const std::string& text, bool) { say(text, true); };
    words.to_reset = "reset when the cause is gone, then resume";
    control_.emplace(session_, *live_, prepared_->plan, std::move(words), true, stops_of_opening());
  } catch (const std::exception& error) {
    live_.reset();
    return conclude(std::nullopt, fmt::format("the exercise cannot begin: {}", refusal_on_page(error)));
  }
  began_utc_ = settings_.utc();
  {
    const std::lock_guard lock(carried_->mutex);
    carried_->live = live_;
  }
  say(fmt::format("the exercise {} waits for its begin; it is recorded, encrypted, in {}",
                  live_->start().exercise.name, carried_->file.filename().string()),
      false);
  const std::lock_guard lock(mutex_);
  stage_ = Stage::kRunning;
}

// ---- running

void StationExercises::Impl::tick_running() {
  handle_inputs();
  control_->tick();
  const double now = session_.now();
  watch_success(live_->view());
  for (const std::string& refusal : live_->take_refusals()) {
    say(refusal, true);
    refused_at_ = now;
    const std::lock_guard lock(mutex_);
    refusal_ = refusal;
  }
  {
    const std::lock_guard lock(mutex_);
    forces_off_ = control_->forces_off();
    if (!refusal_.empty() && now - refused_at_ > kShowsRefusal) refusal_.clear();
  }
  if (control_->fault_lasts()) {
    control_->give({.kind = ExerciseInput::Kind::kAbort});
    return begin_closing();
  }
  if (!live_->done()) return;
  if (done_at_ == 0.0) done_at_ = now;
  if (session_.view().at_rest || now - done_at_ >= kAfterDone) begin_closing();
}

void StationExercises::Impl::handle_inputs() {
  std::deque<Given> given;
  std::uint64_t stops = 0;
  {
    const std::lock_guard lock(mutex_);
    given.swap(inputs_);
    stops = session_.stops();  // under the lock: each stop of an input is counted below
  }
  for (const Given& each : given)
    if (each.stopped) control_->count_stop();
  control_->look(stops);
  for (const Given& each : given) {
    const std::string by = each.account.empty() ? "" : fmt::format(" by {}", each.account);
    if (each.input.kind == ExerciseInput::Kind::kPause) {
      control_->pause();
    } else if (each.input.kind != ExerciseInput::Kind::kResume) {
      control_->give(each.input);
      if (each.input.kind == ExerciseInput::Kind::kBegin)
        say(fmt::format("the exercise was begun{}", by), false);
    } else if (control_->resume(each.stops)) {
      say(fmt::format("the exercise was resumed{}", by), false);
    } else {
      const std::string why =
          "not resumed: another stop has come since, or a fault is not reset yet; look at the patient, then "
          "resume again";
      say(why, true);
      refused_at_ = session_.now();
      const std::lock_guard lock(mutex_);
      refusal_ = why;
    }
  }
}

void StationExercises::Impl::watch_success(const ExerciseView& view) {
  if (view.counted == counted_) return;
  const std::lock_guard lock(mutex_);
  last_success_ = view.successes > successes_;
  counted_ = view.counted;
  successes_ = view.successes;
}

}  // namespace phalanx
