// SPDX-License-Identifier: Apache-2.0
#include "station/station_build.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "phalanx/device/calibration.h"
#include "phalanx/device/link/link_device.h"
#include "phalanx/device/opengloves/opengloves_device.h"
#include "phalanx/device/posed_device.h"
#include "phalanx/scene/calibration_file.h"
#include "phalanx/scene/range_file.h"
#include "phalanx/station/open_device.h"
#include "phalanx/station/realtime.h"
#include "phalanx/station/resolved_station.h"
#include "station/parameter_ramp.h"
#include "station/sensor_watch.h"

namespace phalanx {
namespace {

bool is_below(const std::string& key, const std::string& parent) {
  return key.size() > parent.size() && key.starts_with(parent) && key[parent.size()] == '.';
}

std::shared_ptr<SessionGeometry> geometry_of(ResolvedScene scene) {
  auto geometry = std::make_shared<SessionGeometry>();
  geometry->handedness = scene.hand.handedness;
  geometry->hand = std::move(scene.hand.parameters);
  geometry->X_WH = scene.X_WH;
  geometry->segment = std::move(scene.hand.meshes.collision);
  geometry->display = std::move(scene.hand.meshes.display);
  geometry->skin = std::move(scene.hand.skin);
  geometry->object = std::move(scene.world);
  geometry->friction = std::move(scene.friction);
  geometry->rate_hz = scene.description.parameters.rate_hz;
  return geometry;
}

/// Reads the calibration of the plan; none if it states none.
std::optional<Calibration> calibration_of(const StationPlan& plan) {
  if (plan.calibration.empty()) return std::nullopt;
  return load_calibration(plan.calibration);
}

/// Opens the device on a wire as `device`, with the limits and the calibration. @returns its channels
std::vector<DeviceChannel> open_wired(const StationBuild& build, const SessionSettings& settings,
                                      const Clock& clock, std::unique_ptr<Device>& device) {
  LinkSettings link_settings;
  link_settings.torque_limit = build.made.safety.joint_torque;
  link_settings.torque_rate = build.made.safety.torque_rate;
  if (settings.ask_for_realtime)
    link_settings.on_thread_start = [] {
      static_cast<void>(make_realtime({.priority = 79, .cpu = -1, .lock_memory = true}));
    };
  device = open_device(settings.device, clock, link_settings);
  auto* link = dynamic_cast<LinkDevice*>(device.get());
  auto* glove = dynamic_cast<OpenGlovesDevice*>(device.get());
  const std::optional<Calibration> calibration = calibration_of(build.plan);
  if (glove != nullptr) {
    glove->set_hand(build.made.model->hand.parameters());
    glove->set_watchdog(settings.watchdog);
    glove->set_force_feedback(settings.force_feedback);
  }
  device->open();
  if (!calibration) return device->info().channels;
  std::vector<DeviceChannel> channels = apply_calibration(*calibration, device->info());
  if (glove != nullptr) glove->set_calibration(channels);
  if (link != nullptr) {  // a controller gets the gains when its session begins
    link->close();
    link->set_calibration(channels);
    link->open();
  }
  return channels;
}

/// Opens the device of the plan as `running.device`. @returns its channels
std::vector<DeviceChannel> open_for(const StationBuild& build, const SessionSettings& settings,
                                    const Clock& clock, RunningStation& running) {
  switch (build.plan.source) {
    case HandSource::kPatient:
      running.device = make_simulated_device(*build.patient);
      break;
    case HandSource::kSliders: {
      const HandParameters& hand = build.made.model->hand.parameters();
      auto posed = std::make_unique<PosedDevice>(PosedDeviceSettings{
          .hand = hand, .start = hand.open_angle, .host_rate_hz = build.made.parameters.rate_hz});
      running.sliders = posed.get();
      running.device = std::move(posed);
      break;
    }
    case HandSource::kDevice:
      return open_wired(build, settings, clock, running.device);
  }
  running.device->open();
  return running.device->info().channels;
}

/// Reads the patient's own range of motion of the plan, if it states one.
/// @throws SceneError or CalibrationError: the file, another device or another calibration
JointRanges range_of(const StationPlan& plan, const DeviceInfo& device, const JointFollowers& followers) {
  if (plan.range.empty()) return {};
  const MeasuredRange range = load_range(plan.range);
  const std::optional<Calibration> calibration = calibration_of(plan);
  check_range(range, device, calibration ? calibration->date : "");
  return with_followers(range.joint, followers.coupled);
}

/// Makes the patient's settings. The message names the patient, because the object is not at fault.
SimulatedDeviceSettings patient_of(const ResolvedScene& scene, const HapticModel& model) {
  try {
    return simulated_settings(scene, model);
  } catch (const std::invalid_argument& refused) {
    const bool left_alone =
        scene.description.hand.handedness == Handedness::kLeft && !scene.description.mirror;
    throw std::invalid_argument(fmt::format(
        "the simulated patient cannot press here: {}. {}Or take the sliders instead of the patient, "
        "or another size or place of the object",
        refused.what(),
        left_alone ? "For the left hand in a scene made for the right one set mirror=true in place of "
                     "hand.side=left: it moves the objects, too. "
                   : ""));
  }
}

}  // namespace

Overrides laid_over(Overrides before, const Overrides& changes) {
  for (const auto& [key, value] : changes) {
    const auto holds_key = [&key](const auto& other) { return is_below(key, other.first); };
    const std::size_t removed = std::erase_if(
        before, [&key](const auto& earlier) { return earlier.first == key || is_below(earlier.first, key); });
    if (!value.empty()) {
      before.emplace_back(key, value);
      continue;
    }
    const auto whole = std::ranges::find_if(before, holds_key);
    if (removed == 0 && whole != before.end() && std::ranges::none_of(changes, holds_key))
      throw std::invalid_argument(fmt::format(
          "{}: cannot be reset alone, since {} was replaced as a whole; reset {}, or give a value", key,
          whole->first, whole->first));
  }
  return before;
}

Overrides with_planned(Overrides values, const Overrides& planned) {
  for (const auto& [key, value] : planned) {
    std::erase_if(values, [&key](const auto& stated) { return stated.first == key; });
    values.emplace_back(key, value);
  }
  return values;
}

ChangeKind change_kind(const Overrides& changes, HandSource source, const SceneDescription& in_force,
                       const SceneDescription& wanted) {
  ChangeKind needs = ChangeKind::kInContact;
  for (const auto& [key, value] : changes) {
    ChangeKind kind = change_kind(key);
    if (key == "stabiliser.method" &&
        goes_over_in_contact(in_force.parameters.stabiliser.method, wanted.parameters.stabiliser.method))
      kind = ChangeKind::kInContact;
    // The patient's press and the wrist of a planned grasp depend on the object.
    if (kind == ChangeKind::kOtherObject && (source == HandSource::kPatient || wanted.grasp.type))
      kind = ChangeKind::kNewStation;
    needs = std::max(needs, kind);
  }
  return needs;
}

StationBuild build_station(const StationPlan& plan, SceneFile file, SceneWithValues read,
                           const std::string& clinician, const Overrides& planned, ImportCache& imports) {
  StationBuild build{.plan = plan,
                     .file = std::move(file),
                     .scene = std::move(read.scene),
                     .values = std::move(read.values)};
  const bool presses = plan.source == HandSource::kPatient;
  ResolvedScene scene = resolve(build.scene, {.hand = HandDetail::kAll,
                                              .device = true,
                                              .motion = presses,
                                              .planned = &planned,
                                              .imports = &imports});
  build.scene = scene.description;
  build.values = with_planned(std::move(build.values), scene.planned);
  build.planned = scene.planned;
  build.exoskeleton = scene.exoskeleton.value();
  build.made = make_station_model(scene, clinician);
  // Finds what a station would refuse now, while the last one still runs.
  static_cast<void>(HapticState(*build.made.model, build.made.parameters));
  if (presses) build.patient = patient_of(scene, *build.made.model);
  build.geometry = geometry_of(std::move(scene));
  build.geometry->model = build.made.model;
  return build;
}

RunningStation make_station(const StationBuild& build, const SessionSettings& settings, const Clock& clock,
                            std::uint64_t number) {
  RunningStation running;
  const std::vector<DeviceChannel> channels = open_for(build, settings, clock, running);
  StationOptions options;
  options.number = number;
  options.realtime = settings.realtime;
  options.ask_for_realtime = settings.ask_for_realtime;
  options.safety = build.made.safety;
  if (build.plan.source != HandSource::kSliders)
    options.witnesses = motor_witnesses(build.exoskeleton, channels, build.made.safety.joint_torque);
  const JointFollowers followers = followers_of(build.exoskeleton);
  options.safety.range = range_of(build.plan, running.device->info(), followers);
  running.setup = {.source = build.plan.source,
                   .device = running.device->info(),
                   .channels = channels,
                   .followers = followers,
                   .witnesses = options.witnesses,
                   .calibration = build.plan.calibration,
                   .range = build.plan.range,
                   .clinician = settings.clinician,
                   .patient = build.made.safety.patient};
  ChannelMap map(channels, followers, build.made.model->hand.parameters());
  running.station = std::make_unique<Station>(build.made.model, build.made.parameters, *running.device,
                                              std::move(map), std::move(options), clock);
  return running;
}

}  // namespace phalanx
