// SPDX-License-Identifier: Apache-2.0
#include "station/station_changer.h"

#include <algorithm>
#include <future>
#include <stdexcept>
#include <utility>

#include "phalanx/core/give_way.h"
#include "phalanx/scene/scene_values.h"

namespace phalanx {
namespace {

HandSource source_of(const std::string& device) {
  if (device == "simulated") return HandSource::kPatient;
  return device == "sliders" ? HandSource::kSliders : HandSource::kDevice;
}

bool moves_object(const Overrides& changes) {
  return std::any_of(changes.begin(), changes.end(),
                     [](const auto& change) { return change.first.starts_with("objects"); });
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

/// What computes for seconds gives way to the loop that runs meanwhile. On a thread of its own: a loop or a
/// link that the worker starts inherits its priority, and could not raise it again.
template <class Work>
auto giving_way(const Work& work) {
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
  StationBuild build = built(plan_);
  take_over(build);
}

StationBuild StationChanger::built(const StationPlan& plan) const {
  return giving_way([&] { return build_station(plan, settings_.clinician); });
}

// ---- changes ----

std::vector<ChangeAnswer> StationChanger::set(std::vector<SetPart> parts) {
  if (parts.size() > 1) {
    try {
      lay_over(all_of(parts));
      return answer_to_all(std::move(parts), "");
    } catch (const DeviceError& error) {  // not worth another try of each
      return answer_to_all(std::move(parts), error.what());
    } catch (const std::exception&) {  // who is to blame shows below
    }
  }
  std::vector<ChangeAnswer> answers;
  for (SetPart& part : parts) {
    std::string refused;
    try {
      lay_over(part.changes);
    } catch (const std::exception& error) {
      refused = error.what();
    }
    answers.push_back(answer_to(std::move(part), std::move(refused)));
  }
  return answers;
}

void StationChanger::lay_over(const Overrides& changes) {
  refuse_while_calibrating();
  StationPlan next = plan_;
  next.overrides = laid_over(std::move(next.overrides), changes);
  const ChangeKind needs = needed(changes);
  const auto now = shared_.current();
  if (needs == ChangeKind::kNewStation || now == nullptr) {
    switch_to(next);
  } else if (needs == ChangeKind::kAtZeroTorque) {
    exchange(*now->station, std::move(next), moves_object(changes));
  } else {
    blend(*now->station, std::move(next));
  }
}

ChangeKind StationChanger::needed(const Overrides& changes) const {
  ChangeKind needs = ChangeKind::kInContact;
  for (const auto& [key, value] : changes) needs = std::max(needs, change_kind(key, plan_.source));
  return needs;
}

void StationChanger::blend(Station& station, StationPlan next) {
  const SceneDescription scene = phalanx::load_scene(next.scene, next.overrides);
  Overrides values = scene_values(next.scene, next.overrides);
  station.blend_to(blended_of(scene));
  plan_ = std::move(next);
  shared_.change_state([&](HostState& s) {
    s.overrides = plan_.overrides;
    s.values = std::move(values);
  });
}

void StationChanger::exchange(Station& station, StationPlan next, bool moves_object) {
  StationBuild build = built(next);
  const std::shared_ptr<HostGeometry> geometry = build.geometry;
  station.replace(giving_way([&] { return std::make_unique<LiveModel>(std::move(build.made.model)); }));
  // An earlier blend that still waits for its turn must not have the last word on the new model.
  station.blend_to(blended_of(build.scene));
  plan_ = std::move(next);
  shared_.change_state([&](HostState& s) {
    s.overrides = plan_.overrides;
    s.values = std::move(build.values);
    s.description = build.scene.description;
    if (!moves_object) return;
    geometry->revision = s.geometry->revision + 1;
    s.geometry = geometry;
  });
}

void StationChanger::load_scene(const std::string& scene) {
  refuse_while_calibrating();
  StationPlan next = plan_;
  next.scene = scene;
  next.overrides.clear();
  switch_to(next);
}

void StationChanger::set_source(HandSource source) {
  refuse_while_calibrating();
  if (plan_.source == source) return;
  if (source == HandSource::kDevice || plan_.source == HandSource::kDevice)
    throw std::invalid_argument(
        "a device on a wire moves the hand; start the station without --device for this");
  StationPlan next = plan_;
  next.source = source;
  switch_to(next);
}

void StationChanger::try_again() {
  refuse_while_calibrating();
  if (shared_.current() != nullptr) return;
  try {
    switch_to(plan_);
  } catch (const std::exception& error) {
    shared_.lose(error.what());
  }
}

// ---- from one station to the next ----

void StationChanger::switch_to(const StationPlan& next) {
  StationBuild build = built(next);
  shared_.retire();
  try {
    take_over(build);
    plan_ = next;
  } catch (const std::exception& error) {
    if (next == plan_)
      shared_.lose(error.what());
    else
      go_back();
    throw;
  }
}

/// What the device refuses with the new plan, it may still grant with the old one.
void StationChanger::go_back() {
  try {
    StationBuild build = built(plan_);
    take_over(build);
  } catch (const std::exception& error) {
    shared_.lose(error.what());
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
    build.geometry->revision = s.geometry ? s.geometry->revision + 1 : 1;
    s.geometry = build.geometry;
  });
  shared_.begin(std::make_shared<RunningStation>(make_station(build, settings_, clock_)));
}

// ---- calibration ----

void StationChanger::refuse_while_calibrating() const {
  if (wizard_.on()) throw std::invalid_argument("a calibration is on; finish or abandon it first");
}

void StationChanger::begin_wizard() {
  refuse_while_calibrating();
  if (plan_.source != HandSource::kDevice)
    throw std::invalid_argument("the simulated device needs no calibration; start with --device to have one");
  StationBuild build = built(plan_);
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

/// Written first: if that fails, what was measured is still there.
void StationChanger::write_wizard() {
  const Calibration& found = wizard_.found();
  if (!settings_.write_calibration)
    throw std::invalid_argument("this program writes no calibrations; use `phalanx device calibrate`");
  StationPlan next = plan_;
  next.calibration = settings_.write_calibration(found);
  leave_wizard(next);
}

/// No station runs meanwhile, so that whatever is refused, its scene for one, leaves none.
void StationChanger::leave_wizard(const StationPlan& next) {
  wizard_.end();
  hide_wizard();
  try {
    switch_to(next);
  } catch (const std::exception& error) {
    if (shared_.current() == nullptr) shared_.lose(error.what());
    throw;
  }
}

void StationChanger::serve_wizard() {
  if (!wizard_.on()) return;
  wizard_.go_on(clock_.now());
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
