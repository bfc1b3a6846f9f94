// SPDX-License-Identifier: Apache-2.0
#include "station/session_worker.h"

#include <pthread.h>

#include <chrono>
#include <future>
#include <new>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "phalanx/core/error_text.h"
#include "phalanx/core/give_way.h"
#include "phalanx/scene/calibration_file.h"
#include "phalanx/scene/range_file.h"

namespace phalanx {
namespace {

/// Interval of the updates of a calibration, and of further tries to publish that no change is being made.
constexpr std::chrono::milliseconds kUpdate{20};

HandSource source_of(const std::string& device) {
  if (device == "simulated") return HandSource::kPatient;
  return device == "sliders" ? HandSource::kSliders : HandSource::kDevice;
}

/// @returns the stops that the scene's device states.
std::vector<JointStops> stops_of(const Exoskeleton& exoskeleton) {
  std::vector<JointStops> stops;
  for (const ExoJoint& joint : exoskeleton.joints)
    if (joint.stop_min && joint.stop_max)
      stops.push_back({.joint = joint.joint, .min = *joint.stop_min, .max = *joint.stop_max});
  return stops;
}

/// Runs a computation of seconds on a thread of its own with low priority, so that it does not slow the loop.
/// The worker keeps its priority: threads that it starts inherit it and cannot raise their own.
template <class Work>
auto run_at_low_priority(const Work& work) {
  return std::async(std::launch::async,
                    [&work] {
                      give_way("phalanx-build");
                      return work();
                    })
      .get();
}

/// Notes why a request is refused. Without memory the text is short enough to need none.
void refuse(Request& request, const std::exception& error) noexcept {
  try {
    request.refused = error_text(error);
    if (request.refused.empty()) request.refused = "refused without a reason";
  } catch (const std::bad_alloc&) {
    request.refused = "out of memory";
  }
}

}  // namespace

SessionWorker::SessionWorker(const SessionSettings& settings, const Clock& clock, SessionState& state,
                             CommandQueue& queue, ImportCache& imports)
    : settings_(settings),
      clock_(clock),
      state_(state),
      queue_(queue),
      imports_(imports),
      plan_{.scene = settings.scene,
            .overrides = laid_over({}, settings.overrides),
            .source = source_of(settings.device),
            .calibration = settings.calibration,
            .range = settings.range} {
  state_.change_info([&](SessionInfo& info) { info.device_spec = settings_.device; });
  StationBuild first = built(plan_, SceneFile(plan_.scene));
  take_over(first);
  thread_ = std::thread([this] { run(); });
}

SessionWorker::~SessionWorker() { end(); }

void SessionWorker::end() noexcept {
  queue_.end();
  if (thread_.joinable()) thread_.join();
  wizard_.end();
}

// ---- the thread ----

void SessionWorker::run() noexcept {
  ::pthread_setname_np(::pthread_self(), "phalanx-worker");
  bool idle = true;  // and published as such
  while (!queue_.ended()) {
    std::list<Command> taken = queue_.take(wizard_.on() || !idle ? std::optional(kUpdate) : std::nullopt);
    if (!taken.empty()) {
      static_cast<void>(publish_busy(&taken.front()));
      make(taken.front());
      idle = false;
    }
    if (!idle) idle = publish_busy(nullptr);
    queue_.answer(std::move(taken));
    update_wizard();
  }
}

bool SessionWorker::publish_busy(const Command* command) noexcept {
  try {
    std::string text = command != nullptr ? text_of(*command) : std::string();
    state_.change_info([&](SessionInfo& info) { info.busy = std::move(text); });
    return true;
  } catch (const std::bad_alloc&) {
    return false;
  }
}

/// Makes a command. Every exception becomes the refusal of its request.
void SessionWorker::make(Command& command) noexcept {
  if (command.requests.size() > 1 && make_together(command)) return;
  for (Request& request : command.requests) {
    try {
      std::visit([this](const auto& action) { apply(action); }, request.action);
    } catch (const std::exception& error) {
      refuse(request, error);
    } catch (...) {
      request.refused = "unknown error";  // short: needs no memory
    }
  }
}

/// Makes all sets at once.
/// @returns false if that is refused: trying each of them shows which one is refused
bool SessionWorker::make_together(Command& command) noexcept {
  try {
    apply(SetValues{changes_of(command)});
  } catch (const DeviceError& error) {  // not worth another try of each
    for (Request& request : command.requests) refuse(request, error);
  } catch (...) {
    return false;
  }
  return true;
}

// ---- changes ----

void SessionWorker::apply(const SetValues& set) {
  refuse_while_calibrating();
  StationPlan next = plan_;
  next.overrides = laid_over(std::move(next.overrides), set.changes);
  const auto now = state_.current();
  if (now == nullptr) return switch_to(built(next, SceneFile(next.scene)));
  SceneWithValues read = file_->with_values(next.overrides);
  const ChangeKind kind = change_kind(set.changes, plan_.source, scene_, read.scene);
  if (kind == ChangeKind::kNewStation) return switch_to(built(next, *file_, std::move(read)));
  if (kind == ChangeKind::kOtherObject)
    return exchange_object(*now->station, built(next, *file_, std::move(read)));
  // The parameters of the same model, without opening a file. What needs memory comes before the change.
  const auto info = std::make_shared<SessionInfo>(*state_.info());
  info->overrides = next.overrides;
  info->values = with_planned(std::move(read.values), planned_);
  info->description = read.scene.description;
  info->margin = read.scene.parameters.contact.margin;
  const std::uint64_t change = keep_change(info->scene, info->values, nullptr);
  if (kind == ChangeKind::kInContact)
    now->station->change_to(read.scene.parameters, change);
  else
    run_at_low_priority([&] { now->station->replace(model_, read.scene.parameters, change); });
  plan_ = std::move(next);
  scene_ = std::move(read.scene);
  state_.publish(info);
}

void SessionWorker::exchange_object(Station& station, StationBuild build) {
  // What needs memory comes before the change.
  const auto info = std::make_shared<SessionInfo>(*state_.info());
  // The gate and the channels know the hand of the start: a hand file that has changed needs a new station.
  const bool same_hand = build.made.model->hand.parameters() == model_->hand.parameters() &&
                         build.geometry->handedness == info->geometry->handedness;
  if (!same_hand) return switch_to(std::move(build));
  info->overrides = build.plan.overrides;
  info->values = std::move(build.values);
  info->description = build.scene.description;
  info->margin = build.made.parameters.contact.margin;
  build.geometry->revision = info->geometry->revision + 1;
  info->geometry = build.geometry;
  const std::uint64_t change = keep_change(info->scene, info->values, info->geometry);
  run_at_low_priority([&] { station.replace(build.made.model, build.made.parameters, change); });
  plan_ = std::move(build.plan);
  planned_ = std::move(build.planned);
  scene_ = std::move(build.scene);
  model_ = build.made.model;
  model_change_ = change;
  state_.publish(info);
}

void SessionWorker::apply(const LoadScene& load) {
  refuse_while_calibrating();
  StationPlan next = plan_;
  next.scene = load.scene;
  next.overrides.clear();
  switch_to(built(next, SceneFile(next.scene)));
}

void SessionWorker::apply(const SelectSource& select) {
  refuse_while_calibrating();
  if (plan_.source == select.source) return;
  refuse_source(select.source);
  StationPlan next = plan_;
  next.source = select.source;
  switch_to(built(next, file_of_plan()));
}

void SessionWorker::apply(const StationOrder& order) {
  refuse_while_calibrating();
  const StationPlan next{.scene = order.scene,
                         .overrides = laid_over({}, order.overrides),
                         .source = order.source.value_or(plan_.source),
                         .calibration = order.calibration,
                         .range = order.range};
  if (next.source != plan_.source) refuse_source(next.source);
  if (!order.always && order.recording == 0 && next == plan_ && state_.current() != nullptr) {
    if (order.stopped) state_.stop();
    return;
  }
  // What can be refused is refused while the last station still runs.
  std::string calibrated;
  if (!next.calibration.empty()) calibrated = load_calibration(next.calibration).date;
  if (!next.range.empty()) {
    const MeasuredRange range = load_range(next.range);
    const auto info = state_.info();
    if (info->running && next.source == plan_.source) check_range(range, info->device, calibrated);
  }
  StationBuild build = built(next, SceneFile(next.scene));
  if (order.stopped) state_.stop();
  switch_to(std::move(build), order.recording);
}

/// Refuses another source of the hand's motion if a device on a wire moves it, or should.
void SessionWorker::refuse_source(HandSource source) const {
  if (source == HandSource::kDevice || plan_.source == HandSource::kDevice)
    throw std::invalid_argument(
        "a device on a wire moves the hand; start the station without --device for this");
}

void SessionWorker::apply(const MakeStation&) {
  refuse_while_calibrating();
  if (state_.current() != nullptr) return;
  try {
    switch_to(built(plan_, SceneFile(plan_.scene)));
  } catch (const std::exception& error) {
    state_.set_unavailable(error_text(error));
  }
}

// ---- from one station to the next ----

StationBuild SessionWorker::built(const StationPlan& plan, SceneFile file) const {
  SceneWithValues read = file.with_values(plan.overrides);
  return built(plan, std::move(file), std::move(read));
}

StationBuild SessionWorker::built(const StationPlan& plan, SceneFile file, SceneWithValues read) const {
  StationBuild build = run_at_low_priority([&] {
    return build_station(plan, std::move(file), std::move(read), settings_.clinician, planned_, imports_);
  });
  if (build.made.safety.patient.empty()) build.made.safety.patient = patient_;
  // The device stays the same: refuse what it cannot do while the last station still runs.
  const auto info = state_.info();
  if (info->running) check_watchdog(build.made.safety, info->device);
  return build;
}

SceneFile SessionWorker::file_of_plan() const { return file_ ? *file_ : SceneFile(plan_.scene); }

void SessionWorker::switch_to(StationBuild build, std::uint64_t recording) {
  state_.retire();
  try {
    take_over(build, recording);
  } catch (const std::exception& error) {
    if (build.plan == plan_)
      state_.set_unavailable(error_text(error));
    else
      go_back();
    throw;
  }
}

/// Makes the station of the old plan again: the device may refuse only the new plan.
void SessionWorker::go_back() {
  try {
    StationBuild build = built(plan_, file_of_plan());
    take_over(build);
  } catch (const std::exception& error) {
    state_.set_unavailable(error_text(error));
  }
}

void SessionWorker::take_over(StationBuild& build, std::uint64_t recording) {
  // Nothing is published before the device is open.
  auto next = std::make_shared<RunningStation>(make_station(build, settings_, clock_, ++stations_));
  state_.change_info([&](SessionInfo& info) {
    info.scene = build.plan.scene;
    info.description = build.scene.description;
    info.overrides = build.plan.overrides;
    info.values = build.values;
    info.source = build.plan.source;
    info.calibration = build.plan.calibration;
    info.range = build.plan.range;
    info.fingertip_force = build.made.safety.fingertip_force;
    info.margin = build.made.parameters.contact.margin;
    info.patient = build.made.safety.patient;
    build.geometry->revision = info.geometry ? info.geometry->revision + 1 : 1;
    info.geometry = build.geometry;
  });
  const StationView last = state_.view();
  if (settings_.keep_changes)
    state_.keep_change({.station = stations_,
                        .number = 0,
                        .model_of = 0,
                        .last_station = last.station,
                        .last_tick = last.tick,
                        .scene = build.plan.scene,
                        .values = build.values,
                        .geometry = build.geometry,
                        .setup = next->setup,
                        .recording = recording});
  state_.begin(std::move(next));
  // The station runs. Nothing below throws: an exception would bring back the old station beside it.
  static_assert(std::is_nothrow_move_assignable_v<StationPlan> &&
                std::is_nothrow_move_assignable_v<std::optional<SceneFile>> &&
                std::is_nothrow_move_assignable_v<SceneDescription>);
  plan_ = std::move(build.plan);
  file_ = std::move(build.file);
  planned_ = std::move(build.planned);
  scene_ = std::move(build.scene);
  model_ = build.made.model;
  model_change_ = 0;
  patient_ = std::move(build.made.safety.patient);
}

std::uint64_t SessionWorker::keep_change(const std::string& scene, const Overrides& values,
                                         std::shared_ptr<const SessionGeometry> geometry) {
  const std::uint64_t number = ++changes_;
  if (settings_.keep_changes)
    state_.keep_change({.station = stations_,
                        .number = number,
                        .model_of = geometry ? number : model_change_,
                        .last_station = 0,
                        .last_tick = 0,
                        .scene = scene,
                        .values = values,
                        .geometry = std::move(geometry),
                        .setup = std::nullopt});
  return number;
}

// ---- calibration ----

void SessionWorker::refuse_while_calibrating() const {
  if (wizard_.on()) throw std::invalid_argument("a calibration is on; finish or abandon it first");
}

void SessionWorker::apply(const WizardStep& step) {
  using Kind = WizardStep::Kind;
  switch (step.kind) {
    case Kind::kBegin:
    case Kind::kBeginRange:
      return begin_wizard(step);
    case Kind::kAbandon:
      wizard_.refuse_unless_on();
      return leave_wizard();
    case Kind::kWrite:
      return write_wizard();
    case Kind::kDropRange:
      return drop_range();
    default:
      wizard_.step(step, clock_.now());
      publish_wizard();
  }
}

void SessionWorker::begin_wizard(const WizardStep& step) {
  refuse_while_calibrating();
  if (plan_.source != HandSource::kDevice)
    throw std::invalid_argument("the simulated device needs no calibration; start with --device to have one");
  const StationBuild build = built(plan_, file_of_plan());
  const bool of_range = step.kind == WizardStep::Kind::kBeginRange;
  if (of_range) refuse_range_here();
  std::optional<Calibration> earlier;
  if (!plan_.calibration.empty()) earlier = load_calibration(plan_.calibration);
  state_.retire();
  try {
    const HandParameters& hand = build.made.model->hand.parameters();
    if (of_range) {
      wizard_.begin_range(settings_.device, hand, clock_, *earlier, step.patient);
    } else {
      CalibrationPlan plan = step.plan;
      plan.stops = stops_of(build.exoskeleton);
      wizard_.begin(settings_.device, hand, clock_, plan, std::move(earlier));
    }
    publish_wizard();
  } catch (const std::exception&) {
    wizard_.end();
    go_back();
    throw;
  }
}

/// Refuses to measure a range on a device that is not calibrated, or that no patient may wear.
void SessionWorker::refuse_range_here() const {
  if (plan_.calibration.empty())
    throw std::invalid_argument(
        "the device is not calibrated, so that its angles are estimates; calibrate it first, then measure "
        "the range");
  SafetySettings of_patient;
  of_patient.patient = "the patient's own range";
  check_watchdog(of_patient, state_.info()->device);
}

/// Writes the result before it ends the wizard: if writing fails, what was measured is still there.
void SessionWorker::write_wizard() {
  if (wizard_.measures_range()) {
    const MeasuredRange found = wizard_.found_range();
    if (!settings_.write_range)
      throw std::invalid_argument("this program writes no ranges; use `phalanx device range`");
    plan_.range = settings_.write_range(found);
    return leave_wizard();
  }
  const Calibration& found = wizard_.found();
  if (!settings_.write_calibration)
    throw std::invalid_argument("this program writes no calibrations; use `phalanx device calibrate`");
  plan_.calibration = settings_.write_calibration(found);  // it is written, also if no station can be made
  plan_.range.clear();                                     // it was measured with another calibration
  leave_wizard();
}

/// Starts a station without the patient's range. It begins stopped: its torque may push further than before.
void SessionWorker::drop_range() {
  refuse_while_calibrating();
  if (plan_.range.empty()) throw std::invalid_argument("no range of a patient is in force");
  StationPlan next = plan_;
  next.range.clear();
  StationBuild build = built(next, file_of_plan());
  state_.stop();
  switch_to(std::move(build));
}

/// Ends the wizard and starts a station, which is stopped until people resume it: after a jig, or without a hand in the
/// device, motors must not begin by themselves. No station runs meanwhile: if anything is refused, its scene for example,
/// there is none.
void SessionWorker::leave_wizard() {
  // First, because it may fail without memory: the wizard is then still on, and shown.
  state_.change_info([](SessionInfo& info) {
    info.wizard = nullptr;
    info.range_wizard = nullptr;
  });
  wizard_.end();
  state_.stop();
  try {
    switch_to(built(plan_, SceneFile(plan_.scene)));
  } catch (const std::exception& error) {
    if (state_.current() == nullptr) state_.set_unavailable(error_text(error));
    throw;
  }
}

void SessionWorker::update_wizard() noexcept {
  if (!wizard_.on()) return;
  try {
    wizard_.update(clock_.now());
    publish_wizard();
  } catch (const std::bad_alloc&) {  // the next update tries again
  }
}

void SessionWorker::publish_wizard() {
  std::shared_ptr<const CalibrationSession::View> view;
  std::shared_ptr<const RangeSession::View> range;
  if (wizard_.measures_range())
    range = std::make_shared<const RangeSession::View>(wizard_.range_view());
  else
    view = std::make_shared<const CalibrationSession::View>(wizard_.view());
  state_.change_info([&](SessionInfo& info) {
    info.wizard = std::move(view);
    info.range_wizard = std::move(range);
    info.trouble = wizard_.trouble();
  });
}

}  // namespace phalanx
