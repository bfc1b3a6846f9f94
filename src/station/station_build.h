// SPDX-License-Identifier: Apache-2.0
// Everything that a station is made of, made beside the one that runs.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "phalanx/station/station_host.h"

namespace phalanx {

/// What a station is made from.
struct StationPlan {
  std::string scene;
  Overrides overrides;
  HandSource source = HandSource::kPatient;
  std::string calibration;

  [[nodiscard]] bool operator==(const StationPlan&) const = default;
};

/// What is made of it without touching a device.
struct StationBuild {
  StationPlan plan;
  SceneDescription scene;
  Overrides values;
  StationModel made;
  std::shared_ptr<HostGeometry> geometry;
  std::optional<SimulatedDeviceSettings> patient;  ///< for HandSource::kPatient
};

/// The last word of each key; a key that is set takes what was set below it away, an empty value the key too.
[[nodiscard]] Overrides laid_over(Overrides before, const Overrides& changes);

/// What changing this key needs while the hand is moved by `source`: as change_kind(), but that a simulated
/// patient has to be told where another object is.
[[nodiscard]] ChangeKind change_kind(const std::string& key, HandSource source);

/// @throws SceneError or std::invalid_argument: the scene, a limit that a station does not allow, an open
/// hand that touches the object, a patient who meets nothing. Set-up only.
[[nodiscard]] StationBuild build_station(const StationPlan& plan, const std::string& clinician);

/// A station and its device, open.
struct RunningStation {
  std::unique_ptr<Device> device;
  std::unique_ptr<Station> station;  ///< declared after the device, so that it ends before it
};

/// Opens the device and makes the station; whoever gets it starts it. Takes the build's model.
/// @throws as open_wired_device(). Set-up only.
[[nodiscard]] RunningStation make_station(StationBuild& build, const StationHostSettings& settings,
                                          const Clock& clock);

}  // namespace phalanx
