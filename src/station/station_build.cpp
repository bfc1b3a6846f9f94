// SPDX-License-Identifier: Apache-2.0
#include "station/station_build.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "phalanx/device/posed_device.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/hand_meshes.h"
#include "phalanx/scene/scene_values.h"
#include "phalanx/station/station_device.h"

namespace phalanx {
namespace {

bool is_below(const std::string& key, const std::string& parent) {
  return key.size() > parent.size() && key.starts_with(parent) && key[parent.size()] == '.';
}

std::shared_ptr<HostGeometry> geometry_of(const SceneDescription& scene, const HapticModel& model) {
  auto geometry = std::make_shared<HostGeometry>();
  geometry->handedness = model.hand.handedness();
  geometry->hand = model.hand.parameters();
  geometry->X_WH = model.hand.palm_pose();
  geometry->segment = model.hand.meshes();
  geometry->display = load_display_meshes(scene.hand, geometry->segment);
  geometry->skin = load_hand_skin(scene.hand);
  geometry->object = model.object.mesh();
  geometry->rate_hz = model.rate_hz;
  return geometry;
}

OpenDevice open_for(const StationBuild& build, const StationHostSettings& settings, const Clock& clock) {
  OpenDevice out;
  switch (build.plan.source) {
    case HandSource::kPatient:
      out.device = make_simulated_device(*build.patient);
      break;
    case HandSource::kSliders:
      out.device = std::make_unique<PosedDevice>(
          PosedDeviceSettings{.hand = build.made.model->hand.parameters(),
                              .start = build.made.model->hand.parameters().open_angle,
                              .host_rate_hz = build.made.model->rate_hz});
      break;
    case HandSource::kDevice:
      return open_wired_device({.spec = settings.device,
                                .calibration = build.plan.calibration,
                                .ask_for_realtime = settings.ask_for_realtime},
                               build.made.safety, build.made.model->hand.parameters(), clock);
  }
  out.device->open();
  out.channels = out.device->info().channels;
  return out;
}

/// A patient who does not meet the object is no fault of the object's.
SimulatedDeviceSettings patient_of(const StationBuild& build) {
  try {
    return simulated_settings(build.scene, *build.made.model);
  } catch (const std::invalid_argument& refused) {
    const bool left_alone = build.scene.hand.handedness == Handedness::kLeft && !build.scene.mirror;
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
    std::erase_if(
        before, [&key](const auto& earlier) { return earlier.first == key || is_below(earlier.first, key); });
    if (!value.empty()) before.emplace_back(key, value);
  }
  return before;
}

ChangeKind change_kind(const std::string& key, HandSource source) {
  const bool moves_object = key == "objects" || key.starts_with("objects.");
  return moves_object && source == HandSource::kPatient ? ChangeKind::kNewStation : change_kind(key);
}

StationBuild build_station(const StationPlan& plan, const std::string& clinician) {
  StationBuild build;
  build.plan = plan;
  build.scene = load_scene(plan.scene, plan.overrides);
  build.values = scene_values(plan.scene, plan.overrides);
  build.made = make_station_model(build.scene, clinician);
  // What a station would refuse is better refused now, while the last one still runs.
  static_cast<void>(HapticState(*build.made.model));
  build.geometry = geometry_of(build.scene, *build.made.model);
  if (plan.source == HandSource::kPatient) build.patient = patient_of(build);
  return build;
}

RunningStation make_station(StationBuild& build, const StationHostSettings& settings, const Clock& clock) {
  OpenDevice opened = open_for(build, settings, clock);
  StationOptions options;
  options.realtime = settings.realtime;
  options.ask_for_realtime = settings.ask_for_realtime;
  options.safety = build.made.safety;
  if (build.plan.source != HandSource::kSliders)
    options.witnesses = make_witnesses(build.scene, opened.channels, build.made.safety);
  ChannelMap map = make_channel_map(build.scene, opened.channels, build.made.model->hand.parameters());
  RunningStation running;
  running.device = std::move(opened.device);
  running.station = std::make_unique<Station>(std::move(build.made.model), *running.device, std::move(map),
                                              std::move(options), clock);
  return running;
}

}  // namespace phalanx
