// SPDX-License-Identifier: Apache-2.0
// A station of a simple hand that meets nothing: made in milliseconds.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "phalanx/device/posed_device.h"
#include "phalanx/mesh/primitives.h"
#include "station/station_build.h"
#include "support/simple_hand.h"

namespace phalanx::test {

/// Open; a hand that rests, of the numbers of simple_hand().
inline std::unique_ptr<Device> resting_device() {
  PosedDeviceSettings settings;
  settings.hand = simple_parameters();
  auto device = std::make_unique<PosedDevice>(settings);
  device->open();
  return device;
}

/// Of 200 Hz. However late its steps are, that is no fault.
/// @param patient  SafetySettings::patient
inline RunningStation small_station(std::unique_ptr<Device> device, const Clock& clock,
                                    const std::string& patient = {}) {
  const TriangleMesh far_away = moved(make_box(Vec3(0.1, 0.1, 0.1), 12), at(0.0, -1.0, 0.0));
  auto model = std::make_shared<const HapticModel>(simple_hand(), ObjectModel(far_away));
  StationOptions options;
  options.ask_for_realtime = false;
  options.safety.overruns = 1'000'000;
  options.safety.patient = patient;
  ChannelMap map(device->info().channels, {}, model->hand.parameters());
  RunningStation running;
  running.device = std::move(device);
  running.station = std::make_unique<Station>(std::move(model), HapticParameters{}, *running.device,
                                              std::move(map), options, clock);
  return running;
}

}  // namespace phalanx::test
