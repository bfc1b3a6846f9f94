// SPDX-License-Identifier: Apache-2.0
// Making everything that a station consists of, beside the station that runs.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "phalanx/scene/scene_file.h"
#include "phalanx/scene/scene_keys.h"
#include "phalanx/simulation/simulated_device.h"
#include "phalanx/station/session.h"
#include "phalanx/station/station_model.h"

namespace phalanx {

class ImportCache;
class PosedDevice;

/// Inputs of a station.
struct StationPlan {
  std::string scene;
  Overrides overrides;
  HandSource source = HandSource::kPatient;
  std::string calibration;
  std::string range = {};

  [[nodiscard]] bool operator==(const StationPlan&) const = default;
};

/// Parts of a station that are made without touching a device.
struct StationBuild {
  StationPlan plan;
  SceneFile file;  ///< the scene's file, as it was read for this build
  SceneDescription scene = {};
  Overrides values = {};
  Exoskeleton exoskeleton = {};
  Overrides planned = {};  ///< ResolvedScene::planned
  StationModel made = {};
  std::shared_ptr<SessionGeometry> geometry = nullptr;
  std::optional<SimulatedDeviceSettings> patient = {};  ///< for HandSource::kPatient
};

/// Merges overrides; the newest value of each key counts. A new value of a key removes the older values of
/// the keys below it; an empty value removes the key itself too.
/// @throws std::invalid_argument for an empty value that removes nothing because its table ("objects.0") was
/// replaced as a whole, unless the changes replace or remove the table, too
[[nodiscard]] Overrides laid_over(Overrides before, const Overrides& changes);

/// @returns the common requirement of the changes: the largest of those in the table (scene_keys()), with two
/// exceptions. The stabiliser's method may change in contact among `none`, `smoothing` and `rise_only`. If a
/// simulated patient moves the hand, another object needs a new station: the press is planned for the object.
/// With a planned grasp it needs one too, since the wrist has another place.
/// @param in_force, wanted  scene before and after the changes
[[nodiscard]] ChangeKind change_kind(const Overrides& changes, HandSource source,
                                     const SceneDescription& in_force, const SceneDescription& wanted);

/// @returns values of a scene, with those of the grasp that was planned for it
[[nodiscard]] Overrides with_planned(Overrides values, const Overrides& planned);

/// Reads the files that the scene names, each once, and makes the parts.
/// @param file  of the plan's scene
/// @param read  its scene with the plan's overrides
/// @param planned  of the last build: taken where it fits
/// @param imports  cache of imported meshes
/// @throws SceneError or std::invalid_argument: the scene, a limit that a station does not allow, an open
/// hand that touches the object, a patient who meets nothing. Set-up only.
[[nodiscard]] StationBuild build_station(const StationPlan& plan, SceneFile file, SceneWithValues read,
                                         const std::string& clinician, const Overrides& planned,
                                         ImportCache& imports);

/// A station and its open device.
struct RunningStation {
  std::unique_ptr<Device> device;
  PosedDevice* sliders = nullptr;  ///< the same device if sliders move the hand, else nullptr
  StationSetup setup;
  std::unique_ptr<Station> station;  ///< declared after the device, so that it ends before it
};

/// Opens the device, gives it the limits and the calibration, and makes the station, which shares the build's
/// model; the caller starts it.
/// @param clock   the process's clock; outlives the station
/// @param number  StationOptions::number
/// @throws DeviceError, CalibrationError, SceneError or std::invalid_argument; each names the remedy. Set-up
/// only.
[[nodiscard]] RunningStation make_station(const StationBuild& build, const SessionSettings& settings,
                                          const Clock& clock, std::uint64_t number);

}  // namespace phalanx
