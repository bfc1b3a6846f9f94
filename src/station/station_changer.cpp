// SPDX-License-Identifier: Apache-2.0
#include "station/station_changer.h"

#include <future>
#include <stdexcept>
#include <utility>

#include "phalanx/core/error_text.h"
#include "phalanx/core/give_way.h"

namespace phalanx {
namespace {

HandSource source_of(const std::string& device) {
  if (device == "simulated") return HandSource::kPatient;
  return device == "sliders" ? HandSource::kSliders : HandSource::kDevice;
}

Overrides all_of(const std::vector<SetPart>& parts) {
  Overrides all;
  for (const SetPart& part : parts) all.insert(all.end(), part.changes.begin(), part.changes.end());
  return all;
}

std::vector<ChangeAnswer> answer_to_all(std::vector<SetPart> parts, const std::string& refused) {
  std::vector<ChangeAnswer> answers;
  for (SetPart& part : parts) answers.push_back(answer_to(std::move(part), refused));
  return answers;
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

}  // namespace

StationChanger::StationChanger(const StationHostSettings& settings, const Clock& clock, SharedStation& shared)
    : settings_(settings),
      clock_(clock),
      shared_(shared),
      plan_{.scene = settings.scene,
            .overrides = laid_over({}, settings.overrides),
            .source = source_of(settings.device),
            .calibration = settings.calibration} {
  shared_.change_state([&](HostState& s) { s.device_spec = settings_.device; });
}

void StationChanger::first_station() {
  StationBuild build = built(plan_, SceneFile(plan_.scene));
  take_over(build);
}

StationBuild StationChanger::built(const StationPlan& plan, SceneFile file) const {
  StationBuild build =
      run_at_low_priority([&] { return build_station(plan, std::move(file), settings_.clinician); });
  if (build.made.safety.patient.empty()) build.made.safety.patient = patient_;
  // The device stays the same: refuse what it cannot do while the last station still runs.
  const auto state = shared_.state();
  if (state->running) check_watchdog(build.made.safety, state->device);
  return build;
}

SceneFile StationChanger::file_of_plan() const { return file_ ? *file_ : SceneFile(plan_.scene); }

// ---- changes ----

std::vector<ChangeAnswer> StationChanger::set(std::vector<SetPart> parts) {
  if (parts.size() > 1) {
    try {
      lay_over(all_of(parts));
      return answer_to_all(std::move(parts), "");
    } catch (const DeviceError& error) {  // not worth another try of each
      return answer_to_all(std::move(parts), error.what());
    } catch (const std::exception&) {  // the tries of each below show which part is refused
    }
  }
  std::vector<ChangeAnswer> answers;
  for (SetPart& part : parts) {
    std::string refused;
    try {
      lay_over(part.changes);
    } catch (const std::exception& error) {
      refused = error_text(error);
    }
    answers.push_back(answer_to(std::move(part), std::move(refused)));
  }
  return answers;
}

void StationChanger::lay_over(const Overrides& changes) {
  refuse_while_calibrating();
  StationPlan next = plan_;
  next.overrides = laid_over(std::move(next.overrides), changes);
  const auto now = shared_.current();
  if (now == nullptr) return switch_to(next, SceneFile(next.scene));
  SceneDescription scene = file_->scene(next.overrides);
  const ChangeKind kind = change_kind(changes, plan_.source, scene_.parameters, scene.parameters);
  switch (kind) {
    case ChangeKind::kInContact:
    case ChangeKind::kAtZeroTorque:
      return set_parameters(*now->station, kind, std::move(next), std::move(scene));
    case ChangeKind::kOtherObject:
      return exchange_object(*now->station, next);
    case ChangeKind::kNewStation:
      return switch_to(next, *file_);
  }
}

/// Sets other parameters of the running station. It opens no file.
void StationChanger::set_parameters(Station& station, ChangeKind kind, StationPlan next,
                                    SceneDescription scene) {
  Overrides values = file_->values(next.overrides);
  if (kind == ChangeKind::kInContact)
    station.change_to(scene.parameters);
  else
    run_at_low_priority([&] { station.replace(model_, scene.parameters); });
  plan_ = std::move(next);
  scene_ = std::move(scene);
  shared_.change_state([&](HostState& s) {
    s.overrides = plan_.overrides;
    s.values = std::move(values);
    s.description = scene_.description;
  });
}

void StationChanger::exchange_object(Station& station, const StationPlan& next) {
  StationBuild build = built(next, *file_);
  // The gate and the channels know the hand of the start. A hand file that has changed since needs a new station.
  const bool same_hand = build.made.model->hand.parameters() == model_->hand.parameters() &&
                         build.geometry->handedness == shared_.state()->geometry->handedness;
  if (!same_hand) return switch_to(next, *file_);
  run_at_low_priority([&] { station.replace(build.made.model, build.made.parameters); });
  plan_ = next;
  scene_ = std::move(build.scene);
  model_ = build.made.model;
  shared_.change_state([&](HostState& s) {
    s.overrides = plan_.overrides;
    s.values = std::move(build.values);
    s.description = scene_.description;
    build.geometry->revision = s.geometry->revision + 1;
    s.geometry = build.geometry;
  });
}

void StationChanger::load_scene(const std::string& scene) {
  refuse_while_calibrating();
  StationPlan next = plan_;
  next.scene = scene;
  next.overrides.clear();
  switch_to(next, SceneFile(scene));
}

void StationChanger::set_source(HandSource source) {
  refuse_while_calibrating();
  if (plan_.source == source) return;
  if (source == HandSource::kDevice || plan_.source == HandSource::kDevice)
    throw std::invalid_argument(
        "a device on a wire moves the hand; start the station without --device for this");
  StationPlan next = plan_;
  next.source = source;
  switch_to(next, file_of_plan());
}

void StationChanger::try_again() {
  refuse_while_calibrating();
  if (shared_.current() != nullptr) return;
  try {
    switch_to(plan_, SceneFile(plan_.scene));
  } catch (const std::exception& error) {
    shared_.set_unavailable(error_text(error));
  }
}

// ---- from one station to the next ----

void StationChanger::switch_to(const StationPlan& next, SceneFile file) {
  StationBuild build = built(next, std::move(file));
  shared_.retire();
  try {
    take_over(build);
    plan_ = next;
  } catch (const std::exception& error) {
    if (next == plan_)
      shared_.set_unavailable(error_text(error));
    else
      go_back();
    throw;
  }
}

/// Makes the station of the old plan again: the device may refuse only the new plan.
void StationChanger::go_back() {
  try {
    StationBuild build = built(plan_, file_of_plan());
    take_over(build);
  } catch (const std::exception& error) {
    shared_.set_unavailable(error_text(error));
  }
}

void StationChanger::take_over(StationBuild& build) {
  shared_.change_state([&](HostState& s) {
    s.scene = build.plan.scene;
    s.description = build.scene.description;
    s.overrides = build.plan.overrides;
    s.values = build.values;
    s.source = build.plan.source;
    s.calibration = build.plan.calibration;
    s.fingertip_force = build.made.safety.fingertip_force;
    s.patient = build.made.safety.patient;
    build.geometry->revision = s.geometry ? s.geometry->revision + 1 : 1;
    s.geometry = build.geometry;
  });
  shared_.begin(std::make_shared<RunningStation>(make_station(build, settings_, clock_)));
  file_ = std::move(build.file);
  scene_ = std::move(build.scene);
  model_ = build.made.model;
  patient_ = build.made.safety.patient;
}

// ---- calibration ----

void StationChanger::refuse_while_calibrating() const {
  if (wizard_.on()) throw std::invalid_argument("a calibration is on; finish or abandon it first");
}

void StationChanger::begin_wizard() {
  refuse_while_calibrating();
  if (plan_.source != HandSource::kDevice)
    throw std::invalid_argument("the simulated device needs no calibration; start with --device to have one");
  const StationBuild build = built(plan_, file_of_plan());
  const HandParameters hand = build.made.model->hand.parameters();
  shared_.retire();
  try {
    wizard_.begin(settings_.device, hand, clock_);
  } catch (const std::exception&) {
    go_back();
    throw;
  }
  show_wizard();
}

void StationChanger::step_wizard(CalibrationSession::Step step, std::size_t pose) {
  wizard_.step(step, pose, clock_.now());
  show_wizard();
}

void StationChanger::abandon_wizard() {
  wizard_.refuse_unless_on();
  leave_wizard(plan_);
}

/// Writes the calibration before it ends the wizard: if writing fails, the measured poses are still there.
void StationChanger::write_wizard() {
  const Calibration& found = wizard_.found();
  if (!settings_.write_calibration)
    throw std::invalid_argument("this program writes no calibrations; use `phalanx device calibrate`");
  StationPlan next = plan_;
  next.calibration = settings_.write_calibration(found);
  leave_wizard(next);
}

/// Ends the wizard and starts a station. No station runs meanwhile: if anything is refused, its scene for
/// example, there is none.
void StationChanger::leave_wizard(const StationPlan& next) {
  wizard_.end();
  hide_wizard();
  try {
    switch_to(next, SceneFile(next.scene));
  } catch (const std::exception& error) {
    if (shared_.current() == nullptr) shared_.set_unavailable(error_text(error));
    throw;
  }
}

void StationChanger::serve_wizard() {
  if (!wizard_.on()) return;
  wizard_.update(clock_.now());
  show_wizard();
}

void StationChanger::show_wizard() {
  auto view = std::make_shared<const CalibrationSession::View>(wizard_.view());
  shared_.change_state([&](HostState& s) {
    s.wizard = std::move(view);
    s.trouble = wizard_.trouble();
  });
}

void StationChanger::hide_wizard() {
  shared_.change_state([](HostState& s) { s.wizard = nullptr; });
}

}  // namespace phalanx
