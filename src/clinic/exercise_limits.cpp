// SPDX-License-Identifier: Apache-2.0
#include "phalanx/clinic/exercise_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "phalanx/core/index.h"
#include "phalanx/registry/patient.h"
#include "phalanx/scene/calibration_file.h"
#include "phalanx/scene/exercise_file.h"
#include "phalanx/step/rendering_version.h"

namespace phalanx {
namespace {

constexpr double kMeasuredStable =
    800.0;  // docs/stability.md, "Effect of the device": beihang, 20 seeds [N/m]

/// Writes a value in the unit of its key, so that it is not above the limit when it is read back.
/// @param unit  of the key in SI units
std::string not_above(double limit, double unit) {
  double value = limit / unit;
  while (value * unit > limit) value = std::nextafter(value, 0.0);
  return fmt::format("{:.17g}", value);
}

/// @returns the value of a scene's key without the quotes of a TOML string
std::string stated_value(const Overrides& values, const std::string& key, const std::string& otherwise) {
  for (const auto& [name, value] : values) {
    if (name != key) continue;
    const bool quoted = value.size() >= 2 && value.front() == '"' && value.back() == '"';
    return quoted ? value.substr(1, value.size() - 2) : value;
  }
  return otherwise;
}

}  // namespace

Overrides lowered_limits(const std::string& scene, const Overrides& overrides,
                         const ExerciseDescription& exercise, const PersonLimits& person) {
  const SceneDescription before = load_scene(scene, overrides);
  SceneDescription after = before;
  static_cast<void>(apply_exercise(after, exercise, person));
  Overrides lowered;
  const HapticParameters& was = before.parameters;
  const HapticParameters& is = after.parameters;
  if (is.force.stiffness < was.force.stiffness)
    lowered.emplace_back("force.stiffness_n_per_mm", not_above(is.force.stiffness, 1e3));
  if (is.limits.fingertip_force < was.limits.fingertip_force || !was.limits.fingertip_force_enabled)
    lowered.emplace_back("limits.fingertip_force_n", not_above(is.limits.fingertip_force, 1.0));
  if (is.limits.joint_torque < was.limits.joint_torque || !was.limits.joint_torque_enabled)
    lowered.emplace_back("limits.joint_torque_nm", not_above(is.limits.joint_torque, 1.0));
  return lowered;
}

std::optional<double> stable_stiffness(const KnownStability& known, const SceneDescription& scene) {
  if (known.stated) return known.stated;
  if (known.sliders) return scene.parameters.force.stiffness;
  const bool measured = scene.device.file == "beihang" && scene.device.overlay.empty();
  if (known.simulated && measured) return kMeasuredStable;
  return std::nullopt;
}

PersonLimits within_scene(const PersonLimits& person, SceneDescription scene,
                          const ExerciseDescription& exercise) {
  PersonLimits lowered = apply_exercise(scene, exercise, person);
  if (lowered.stable_stiffness)
    lowered.stable_stiffness = std::min(*lowered.stable_stiffness, scene.parameters.force.stiffness);
  return lowered;
}

std::array<bool, kDigits> felt_digits(const SessionInfo& info) {
  std::array<bool, kDigits> felt{};
  for (const int joint : info.sensed_joints) felt[idx(digit_of_joint(joint))] = true;
  return felt;
}

std::string methods_of_calibration(const std::string& file) {
  if (file.empty()) return "none";
  std::vector<std::string> methods;
  for (const auto& channel : load_calibration(file).channels)
    methods.emplace_back(calibration_method_name(channel.method));
  std::sort(methods.begin(), methods.end());
  methods.erase(std::unique(methods.begin(), methods.end()), methods.end());
  return fmt::format("{}", fmt::join(methods, "+"));
}

std::map<std::string, std::string> conditions_of(const SessionInfo& info, const std::string& methods) {
  return {{"device", info.device.name},
          {"serial", info.device.serial},
          {"calibration", methods},
          {"contact_mode", stated_value(info.values, "contact.mode", "static")},
          {"stabiliser", stated_value(info.values, "stabiliser.method", "rise_only")},
          {"rendering", fmt::format("{}", kRenderingVersion)},
          {"side", std::string(side_name(info.geometry->handedness))},
          {"scene", info.scene}};
}

}  // namespace phalanx
