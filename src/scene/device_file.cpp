// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/device_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "phalanx/core/constants.h"
#include "phalanx/core/nearest_name.h"
#include "scene/joint_key.h"
#include "scene/toml/layered_file.h"

namespace phalanx {
namespace {

/// Far beyond any hand exoskeleton: a value outside has a wrong decimal point or unit.
constexpr NumberRange kArmMm = {.min = -100.0, .max = 100.0};
constexpr NumberRange kBarMm = {.min = 0.0, .max = 1e3, .min_open = true};
constexpr NumberRange kCoefficientMm = {.min = -1e4, .max = 1e4};
constexpr NumberRange kStopDeg = {.min = -180.0, .max = 180.0};
constexpr NumberRange kRate = {.min = 1.0, .max = 100e3};
constexpr NumberRange kScale = {.min = 0.0, .max = 1e3};
constexpr NumberRange kScaleAbove0 = {.min = 0.0, .max = 1e3, .min_open = true};

/// A table whose missing keys are read from a table of defaults.
class Defaulted {
 public:
  Defaulted(TomlTable own, TomlTable* defaults) : own_(std::move(own)), defaults_(defaults) {}

  double number(std::string_view key, const NumberRange& range, std::optional<double> fallback = {}) {
    if (defaults_ != nullptr && defaults_->has(key)) fallback = defaults_->number(key, range);
    if (own_.has(key) || !fallback) return own_.number(key, range);  // reports a missing key
    return *fallback;
  }
  bool flag(std::string_view key, bool fallback) {
    if (defaults_ != nullptr && defaults_->has(key)) fallback = defaults_->flag(key);
    return own_.has(key) ? own_.flag(key) : fallback;
  }
  TomlTable& own() noexcept { return own_; }

 private:
  TomlTable own_;
  TomlTable* defaults_;
};

void read_stops(TomlTable& table, ExoJoint& exo) {
  if (!table.has("stop_min_deg") && !table.has("stop_max_deg")) return;
  exo.stop_min = table.number("stop_min_deg", kStopDeg) * kDeg;
  exo.stop_max = table.number("stop_max_deg", kStopDeg) * kDeg;
  if (*exo.stop_min >= *exo.stop_max) table.fail("stop_max_deg", "must be above stop_min_deg; swap the two");
}

ExoJoint read_joint(TomlTable own, TomlTable* defaults, int joint) {
  Defaulted table(std::move(own), defaults);
  ExoJoint exo;
  exo.joint = joint;
  exo.inertia = table.number("inertia_kg_m2", above(0.0, 1.0));
  exo.damping = table.number("damping_nms_per_rad", between(0.0, 100.0), 0.0);
  exo.friction.coulomb = table.number("friction_nm", between(0.0, 10.0), 0.0);
  exo.friction.static_ratio = table.number("static_ratio", {.min = 1.0, .max = 10.0}, 1.0);
  exo.friction.stribeck_speed = table.number("stribeck_rad_per_s", above(0.0, 1e3), 1.0);
  exo.sensor_lsb = table.number("sensor_lsb_rad", between(0.0, 1.0), 0.0);
  exo.sensor_noise = table.number("sensor_noise_rad", between(0.0, 1.0), 0.0);
  exo.torque_sensor = table.flag("torque_sensor", false);
  read_stops(table.own(), exo);
  table.own().finish();
  return exo;
}

CoupledJoint read_coupled(TomlTable table, int joint) {
  CoupledJoint coupled;
  coupled.joint = joint;
  coupled.of = read_joint_name(table, "of");
  coupled.ratio = table.number("ratio", {.min = -10.0, .max = 10.0});
  coupled.offset = table.number_or("offset_deg", {.min = -180.0, .max = 180.0}, 0.0) * kDeg;
  table.finish();
  return coupled;
}

std::array<double, kJoints> read_arms(TomlTable table) {
  std::array<double, kJoints> arm{};
  for (int joint = 0; joint < kJoints; ++joint)
    arm[static_cast<std::size_t>(joint)] = table.number_or(joint_name(joint), kArmMm, 0.0) * kMilli;
  table.finish();
  return arm;
}

FourBar read_four_bar(TomlTable table) {
  FourBar bar;
  bar.ground = table.number("ground_mm", kBarMm) * kMilli;
  bar.crank = table.number("crank_mm", kBarMm) * kMilli;
  bar.coupler = table.number("coupler_mm", kBarMm) * kMilli;
  bar.rocker = table.number("rocker_mm", kBarMm) * kMilli;
  bar.rocker_angle = table.number("rocker_deg", {.min = -360.0, .max = 360.0}) * kDeg;
  bar.crossed = table.has("crossed") && table.flag("crossed");
  bar.drum = table.number("drum_mm", {.min = -1e3, .max = 1e3}) * kMilli;
  table.finish();
  return bar;
}

/// Reads the range of a linkage; without one, the joint's stops.
void read_range(TomlTable& table, const std::vector<ExoJoint>& joints, JointLinkage& linkage) {
  if (table.has("range_deg")) {
    const auto [least, most] = table.pair("range_deg", kStopDeg);
    linkage.min_angle = least * kDeg;
    linkage.max_angle = most * kDeg;
    return;
  }
  const auto joint = std::ranges::find(joints, linkage.joint, &ExoJoint::joint);
  if (joint == joints.end() || !joint->stop_min || !joint->stop_max)
    table.fail("range_deg",
               "is missing, and the joint has no stops; write the angles between which the linkage moves");
  linkage.min_angle = *joint->stop_min;
  linkage.max_angle = *joint->stop_max;
}

JointLinkage read_linkage(TomlTable table, const std::vector<ExoJoint>& joints, int joint) {
  JointLinkage linkage;
  linkage.joint = joint;
  read_range(table, joints, linkage);
  if (table.has("arm_polynomial_mm"))
    for (const double c : table.list("arm_polynomial_mm", kCoefficientMm))
      linkage.polynomial.push_back(c * kMilli);
  if (table.has("arm_table_deg_mm"))
    for (const auto& [angle, arm] : table.pairs("arm_table_deg_mm", kStopDeg, kArmMm))
      linkage.table.push_back({.angle = angle * kDeg, .arm = arm * kMilli});
  if (table.has("four_bar")) linkage.four_bar = read_four_bar(table.table("four_bar"));
  const std::string place = table.place();
  table.finish();
  try {
    check_linkage(linkage, place);
  } catch (const std::invalid_argument& error) {
    throw SceneError(error.what());
  }
  return linkage;
}

/// Reads the moment arms: constant ones, and linkages.
void read_transmission(TomlTable& table, const std::vector<ExoJoint>& joints, ExoMotor& motor) {
  const bool has_linkages = table.has("linkages");
  if (table.has("arms_mm") || !has_linkages) motor.arm = read_arms(table.table("arms_mm"));
  if (!has_linkages) return;
  TomlTable linkages = table.table("linkages");
  for (int joint = 0; joint < kJoints; ++joint) {
    if (!linkages.has(joint_name(joint))) continue;
    if (motor.arm[static_cast<std::size_t>(joint)] != 0.0)
      linkages.fail(joint_name(joint), "has a constant moment arm in arms_mm, too; set that to 0");
    add_linkage(motor, read_linkage(linkages.table(joint_name(joint)), joints, joint));
  }
  linkages.finish();
}

ExoMotor read_motor(TomlTable own, TomlTable* defaults, const std::string& name,
                    const std::vector<ExoJoint>& joints) {
  Defaulted table(std::move(own), defaults);
  ExoMotor motor;
  motor.name = name;
  read_transmission(table.own(), joints, motor);
  motor.lag = table.number("lag_ms", between(0.0, 1e3), 0.0) * kMilli;
  motor.force_limit = table.number("force_limit_n", above(0.0, 10e3));
  motor.pull_only = table.flag("pull_only", false);
  motor.bias = table.number("bias_n", between(0.0, 10e3), 0.0);
  motor.force_constant = table.number("force_constant_n_per_a", above(0.0, 1e6), 1.0);
  motor.mass = table.number("mass_kg", above(0.0, 1e3));
  motor.damping = table.number("damping_ns_per_m", between(0.0, 1e5), 0.0);
  motor.tendon_stiffness = table.number("tendon_stiffness_n_per_mm", above(0.0, 1e5)) / kMilli;
  motor.tendon_damping = table.number("tendon_damping_ns_per_m", between(0.0, 1e6), 0.0);
  motor.backlash = table.number("backlash_mm", between(0.0, 100.0), 0.0) * kMilli;
  motor.sheath.coulomb = table.number("friction_n", between(0.0, 10e3), 0.0);
  motor.sheath.static_ratio = table.number("static_ratio", {.min = 1.0, .max = 10.0}, 1.0);
  motor.sheath.stribeck_speed = table.number("stribeck_mm_per_s", above(0.0, 1e6), 1.0) * kMilli;
  motor.sheath.capstan = table.number("capstan", between(0.0, 10.0), 0.0);
  table.own().finish();
  return motor;
}

ExoController read_controller(TomlTable table) {
  ExoController controller;
  controller.rate_hz = table.number_or("rate_hz", kRate, controller.rate_hz);
  controller.compute_delay = table.number_or("compute_delay_ms", between(0.0, 1e3), 0.0) * kMilli;
  controller.return_delay = table.number_or("return_delay_ms", between(0.0, 1e3), 0.0) * kMilli;
  table.finish();
  return controller;
}

/// Reads the digit that is copied; -1: "none", which cancels the base's.
int read_copied(TomlTable& entry, const std::vector<std::string_view>& names) {
  const std::string of = entry.text("of");
  if (of == "none") return -1;
  const auto found = std::find(names.begin(), names.end(), of);
  if (found == names.end())
    entry.fail("of", fmt::format("is neither a digit nor \"none\"; the nearest digit is \"{}\"",
                                 nearest_name(of, names)));
  return static_cast<int>(found - names.begin());
}

std::array<bool, kDigits> sensed_digits(const Exoskeleton& exo) {
  std::array<bool, kDigits> sensed{};
  for (const ExoJoint& joint : exo.joints)
    sensed[static_cast<std::size_t>(digit_of_joint(joint.joint))] = true;
  return sensed;
}

/// Refuses a copy that the device's joints contradict, where it is stated. The message gives the options
/// for all digits with joints of their own. check_exoskeleton() has the same rules for devices of a
/// program.
/// @param origin  device file
void check_copies(TomlTable& table, const std::array<DigitCopy, kDigits>& copies,
                  const std::array<bool, kDigits>& sensed, const std::string& origin) {
  std::string options;
  int conflict = -1;
  for (int digit = kDigits - 1; digit >= 0; --digit) {
    const auto d = static_cast<std::size_t>(digit);
    if (copies[d].of < 0 || !sensed[d]) continue;
    conflict = digit;
    options.insert(0, fmt::format(" --set device.copy.{}.of=none", digit_name(digit)));
  }
  if (conflict >= 0)
    table.table(digit_name(conflict))
        .fail("of",
              fmt::format("{} has joints of this digit, so that it needs no copy; write \"none\", or type{}",
                          origin, options));
  for (int digit = 0; digit < kDigits; ++digit) {
    const int of = copies[static_cast<std::size_t>(digit)].of;
    if (of >= 0 && !sensed[static_cast<std::size_t>(of)])
      table.table(digit_name(digit))
          .fail("of", fmt::format("{} has no joint of the {}; name a digit that it senses, or \"none\"",
                                  origin, digit_name(of)));
  }
}

std::array<DigitCopy, kDigits> read_copies(TomlTable table, const std::array<bool, kDigits>& sensed,
                                           const std::string& origin) {
  std::vector<std::string_view> names;
  for (int digit = 0; digit < kDigits; ++digit) names.push_back(digit_name(digit));
  std::array<DigitCopy, kDigits> copies;
  for (std::size_t digit = 0; digit < kDigits; ++digit) {
    if (!table.has(names[digit])) continue;
    TomlTable entry = table.table(names[digit]);
    copies[digit].of = read_copied(entry, names);
    copies[digit].gain = entry.number_or("gain", between(0.0, 10.0), 1.0);
    entry.finish();
  }
  table.finish();
  check_copies(table, copies, sensed, origin);
  return copies;
}

void apply_scale(TomlTable table, Exoskeleton& exo) {
  const auto scale = [&table](std::string_view key) { return table.number_or(key, kScale, 1.0); };
  const auto scale_above_0 = [&table](std::string_view key) {
    return table.number_or(key, kScaleAbove0, 1.0);
  };
  const double inertia = scale_above_0("inertia");
  const double damping = scale("damping");
  const double joint_friction = scale("joint_friction");
  const double sheath_friction = scale("sheath_friction");
  const double tendon_stiffness = scale_above_0("tendon_stiffness");
  const double tendon_damping = scale("tendon_damping");
  const double backlash = scale("backlash");
  const double lag = scale("lag");
  const double sensor_lsb = scale("sensor_lsb");
  const double sensor_noise = scale("sensor_noise");
  exo.controller.compute_delay *= scale("compute_delay");
  exo.controller.return_delay *= scale("return_delay");
  table.finish();
  for (ExoJoint& joint : exo.joints) {
    joint.inertia *= inertia;
    joint.damping *= damping;
    joint.friction.coulomb *= joint_friction;
    joint.sensor_lsb *= sensor_lsb;
    joint.sensor_noise *= sensor_noise;
  }
  for (ExoMotor& motor : exo.motors) {
    motor.mass *= inertia;
    motor.damping *= damping;
    motor.sheath.coulomb *= sheath_friction;
    motor.sheath.capstan *= sheath_friction;
    motor.tendon_stiffness *= tendon_stiffness;
    motor.tendon_damping *= tendon_damping;
    motor.backlash *= backlash;
    motor.lag *= lag;
  }
}

/// Reads joints, coupled joints and motors, with the tables of defaults.
void read_mechanics(TomlTable& root, Exoskeleton& exo) {
  std::optional<TomlTable> defaults, of_joint, of_motor;
  if (root.has("defaults")) {
    defaults.emplace(root.table("defaults"));
    if (defaults->has("joint")) of_joint.emplace(defaults->table("joint"));
    if (defaults->has("motor")) of_motor.emplace(defaults->table("motor"));
    defaults->finish();
  }
  TomlTable joints = root.table("joints");
  for (int j = 0; j < kJoints; ++j) {
    if (!joints.has(joint_name(j))) continue;
    exo.joints.push_back(read_joint(joints.table(joint_name(j)), of_joint ? &*of_joint : nullptr, j));
  }
  joints.finish();
  if (exo.joints.empty()) root.fail("joints", "the device has no joint; add a table [joints.NAME] for each");
  if (root.has("coupled")) {
    TomlTable coupled = root.table("coupled");
    for (int j = 0; j < kJoints; ++j)
      if (coupled.has(joint_name(j))) exo.coupled.push_back(read_coupled(coupled.table(joint_name(j)), j));
    coupled.finish();
  }
  if (root.has("motors")) {
    TomlTable motors = root.table("motors");
    for (const std::string& name : motors.keys())
      exo.motors.push_back(read_motor(motors.table(name), of_motor ? &*of_motor : nullptr, name, exo.joints));
  }
  if (of_joint) of_joint->finish();
  if (of_motor && !exo.motors.empty()) of_motor->finish();
}

Exoskeleton read_device(const LayeredFile& file) {
  TomlTable root = file.root();
  Exoskeleton exo;
  exo.name = std::filesystem::path(file.origin()).stem().string();
  if (root.has("description")) exo.description = root.text("description");
  read_mechanics(root, exo);
  if (root.has("controller")) exo.controller = read_controller(root.table("controller"));
  if (root.has("copy"))
    exo.controller.copy = read_copies(root.table("copy"), sensed_digits(exo), file.origin());
  static_cast<void>(root.has("base"));  // known, although already handled, like the scales
  static_cast<void>(root.has("scale"));
  root.finish();
  for (const TomlTable& scale : file.scales()) apply_scale(scale, exo);
  try {
    check_exoskeleton(exo);
  } catch (const std::invalid_argument& error) {
    throw SceneError(fmt::format("{}: {}", file.in_words(), error.what()));
  }
  return exo;
}

}  // namespace

Exoskeleton load_device(const SceneDescription& scene) {
  LayeredFile file("device");
  file.add_file(scene.device.file, ".", scene.device.stated_at);
  file.add_overlay(scene.device.overlay);
  return read_device(file);
}

std::vector<std::filesystem::path> device_files(const SceneDescription& scene) {
  LayeredFile file("device");
  file.add_file(scene.device.file, ".", scene.device.stated_at);
  return file.files();
}

Exoskeleton load_device_file(const std::string& name_or_path, const std::filesystem::path& folder) {
  LayeredFile file("device");
  file.add_file(name_or_path, folder);
  return read_device(file);
}

Exoskeleton parse_device(const std::string& text, const std::string& origin,
                         const std::filesystem::path& folder) {
  LayeredFile file("device");
  file.add_text(text, origin, folder);
  return read_device(file);
}

}  // namespace phalanx
