// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/device_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "phalanx/core/index.h"
#include "phalanx/core/random.h"
#include "phalanx/scene/patient_file.h"
#include "record/temporary_folder.h"
#include "scene/expect_error.h"

namespace phalanx {
namespace {

const std::string kJoint = "[joints.index_mcp_flexion]\ninertia_kg_m2 = 1e-3\n";
const std::string kMotor =
    "[motors.mcp]\narms_mm = { index_mcp_flexion = -12 }\nforce_limit_n = 60\nmass_kg = 22\n"
    "tendon_stiffness_n_per_mm = 1000\n";

Exoskeleton parse_text(const std::string& text) { return parse_device(text, "d.toml"); }

void expect_refused(const std::string& text, const std::vector<std::string>& words) {
  SCOPED_TRACE(text);
  expect_scene_error([&] { static_cast<void>(parse_text(text)); }, words);
}

const std::string kLinkage =
    "[motors.mcp]\nforce_limit_n = 60\nmass_kg = 22\ntendon_stiffness_n_per_mm = 1000\n"
    "[motors.mcp.linkages.index_mcp_flexion]\n";

TEST(DeviceFile, StatesLinkagesInItsUnits) {
  const Exoskeleton line =
      parse_text(kJoint + kLinkage + "range_deg = [-30, 90]\narm_polynomial_mm = [-12, 2.5]\n");
  ASSERT_EQ(line.motors[0].linkages.size(), 1U);
  const JointLinkage& linkage = line.motors[0].linkages[0];
  EXPECT_EQ(linkage.joint, 4);
  EXPECT_DOUBLE_EQ(linkage.max_angle, std::numbers::pi / 2.0);
  EXPECT_DOUBLE_EQ(linkage.polynomial[1], 0.0025);
  EXPECT_NEAR(line.motors[0].arm[4], -0.012 - 0.0025 * std::numbers::pi / 6.0, 1e-12) << "the largest";
  const Exoskeleton table =
      parse_text(kJoint + kLinkage + "range_deg = [0, 90]\narm_table_deg_mm = [[0, 10], [90, 6]]\n");
  EXPECT_DOUBLE_EQ(table.motors[0].linkages[0].table[1].arm, 0.006);
  const Exoskeleton bar =
      parse_text(kJoint + "stop_min_deg = -5\nstop_max_deg = 105\n" + kLinkage +
                 "four_bar = { ground_mm = 28, crank_mm = 18, coupler_mm = 32, rocker_mm = 14, "
                 "rocker_deg = 40, drum_mm = -14, crossed = false }\n");
  EXPECT_DOUBLE_EQ(bar.motors[0].linkages[0].four_bar->coupler, 0.032);
  EXPECT_NEAR(bar.motors[0].linkages[0].min_angle, -5.0 * std::numbers::pi / 180.0, 1e-15)
      << "the joint's stops";
}

TEST(DeviceFile, RefusesALinkageWithPlaceValueAndRemedy) {
  const std::string range = "range_deg = [0, 90]\n";
  expect_refused(kJoint + kLinkage + "arm_polynomial_mm = [10]\n", {"range_deg", "is missing", "no stops"});
  expect_refused(kJoint + kLinkage + range, {"index_mcp_flexion", "0 of polynomial", "state exactly one"});
  expect_refused(kJoint + kLinkage + range + "arm_polynomial_mm = [10, -10]\n",
                 {"d.toml", "index_mcp_flexion", "at 56.", "moment arm is 0.", "narrow the range"});
  expect_refused(kJoint + kLinkage + range + "arm_table_deg_mm = [[0, 10], [45]]\n",
                 {"d.toml:9", "no pair of numbers"});
  expect_refused(kJoint + kLinkage + range + "arm_table_deg_mm = [[0, 10], [90, 1000]]\n",
                 {"element 1, second"});
  expect_refused(kJoint + kLinkage + range + "arm_polynomial_mm = []\n",
                 {"write numbers in square brackets"});
  expect_refused(
      kJoint + kLinkage + range +
          "four_bar = { ground_mm = 28, crank_mm = 5, coupler_mm = 10, rocker_mm = 14, rocker_deg = 40, "
          "drum_mm = 10 }\n",
      {"the rocker's end is", "5.00 to 15.00 mm", "Change a length"});
  expect_refused(
      kJoint + kMotor + "[motors.mcp.linkages.index_mcp_flexion]\n" + range + "arm_polynomial_mm = [10]\n",
      {"arms_mm", "set that to 0"});
  expect_refused(kJoint + kLinkage + range +
                     "arm_polynomial_mm = [10]\n[motors.mcp.linkages.index_pip_flexion]\n" + range +
                     "arm_polynomial_mm = [10]\n",
                 {"index_pip_flexion", "the device has no such joint"});
}

TEST(DeviceFile, StatesJointsMotorsAndControllerInItsUnits) {
  const Exoskeleton exo = parse_text(R"(description = "all of it"
[controller]
rate_hz = 2000
compute_delay_ms = 4.5
return_delay_ms = 1
[joints.index_pip_flexion]
inertia_kg_m2 = 2e-4
damping_nms_per_rad = 3e-3
friction_nm = 0.004
static_ratio = 1.05
stribeck_rad_per_s = 0.02
sensor_lsb_rad = 1e-4
sensor_noise_rad = 2e-5
torque_sensor = true
[coupled.index_dip_flexion]
of = "index_pip_flexion"
ratio = 0.7
offset_deg = 90
[motors.pip]
arms_mm = { index_pip_flexion = -12 }
lag_ms = 4
force_limit_n = 30
pull_only = true
bias_n = 2
force_constant_n_per_a = 20
mass_kg = 6
damping_ns_per_m = 7
tendon_stiffness_n_per_mm = 10
tendon_damping_ns_per_m = 5
backlash_mm = 0.1
friction_n = 0.34
static_ratio = 1.1
stribeck_mm_per_s = 2
capstan = 0.2
[copy]
middle = { of = "index", gain = 0.9 }
)");
  EXPECT_EQ(exo.name, "d");
  EXPECT_EQ(exo.description, "all of it");
  EXPECT_EQ(exo.controller.rate_hz, 2000.0);
  EXPECT_DOUBLE_EQ(exo.controller.compute_delay, 0.0045);
  EXPECT_DOUBLE_EQ(exo.controller.return_delay, 0.001);
  ASSERT_EQ(exo.joints.size(), 1U);
  const ExoJoint& joint = exo.joints[0];
  EXPECT_EQ(joint.joint, 6);
  EXPECT_EQ(joint.inertia, 2e-4);
  EXPECT_EQ(joint.damping, 3e-3);
  EXPECT_EQ(joint.friction.coulomb, 0.004);
  EXPECT_EQ(joint.friction.static_ratio, 1.05);
  EXPECT_EQ(joint.friction.stribeck_speed, 0.02);
  EXPECT_EQ(joint.sensor_lsb, 1e-4);
  EXPECT_EQ(joint.sensor_noise, 2e-5);
  EXPECT_TRUE(joint.torque_sensor);
  ASSERT_EQ(exo.coupled.size(), 1U);
  EXPECT_EQ(exo.coupled[0].joint, 7);
  EXPECT_EQ(exo.coupled[0].of, 6);
  EXPECT_EQ(exo.coupled[0].ratio, 0.7);
  EXPECT_DOUBLE_EQ(exo.coupled[0].offset, 0.5 * std::numbers::pi);
  ASSERT_EQ(exo.motors.size(), 1U);
  const ExoMotor& motor = exo.motors[0];
  EXPECT_EQ(motor.name, "pip");
  EXPECT_DOUBLE_EQ(motor.arm[6], -0.012);
  EXPECT_EQ(motor.arm[4], 0.0);
  EXPECT_DOUBLE_EQ(motor.lag, 0.004);
  EXPECT_EQ(motor.force_limit, 30.0);
  EXPECT_TRUE(motor.pull_only);
  EXPECT_EQ(motor.bias, 2.0);
  EXPECT_EQ(motor.force_constant, 20.0);
  EXPECT_EQ(motor.mass, 6.0);
  EXPECT_EQ(motor.damping, 7.0);
  EXPECT_DOUBLE_EQ(motor.tendon_stiffness, 1e4);
  EXPECT_EQ(motor.tendon_damping, 5.0);
  EXPECT_DOUBLE_EQ(motor.backlash, 1e-4);
  EXPECT_EQ(motor.sheath.coulomb, 0.34);
  EXPECT_EQ(motor.sheath.static_ratio, 1.1);
  EXPECT_DOUBLE_EQ(motor.sheath.stribeck_speed, 2e-3);
  EXPECT_EQ(motor.sheath.capstan, 0.2);
  EXPECT_EQ(exo.controller.copy[2].of, 1);
  EXPECT_EQ(exo.controller.copy[2].gain, 0.9);
  EXPECT_EQ(exo.controller.copy[3].of, -1);
}

TEST(DeviceFile, MayStateTheStopsOfAJointBothOrNeither) {
  const ExoJoint none = parse_text(kJoint).joints[0];
  EXPECT_FALSE(none.stop_min || none.stop_max);
  const ExoJoint joint = parse_text(kJoint + "stop_min_deg = -10\nstop_max_deg = 95\n").joints[0];
  EXPECT_DOUBLE_EQ(joint.stop_min.value(), -10.0 * std::numbers::pi / 180.0);
  EXPECT_DOUBLE_EQ(joint.stop_max.value(), 95.0 * std::numbers::pi / 180.0);
  expect_refused(kJoint + "stop_max_deg = 95\n", {"stop_min_deg", "is missing"});
  expect_refused(kJoint + "stop_min_deg = 95\nstop_max_deg = 95\n", {"stop_max_deg", "must be above"});
}

TEST(DeviceFile, TakesFromTheDefaultsWhatAJointOrAMotorDoesNotSay) {
  const Exoskeleton exo = parse_text(
      "[defaults.joint]\ninertia_kg_m2 = 5e-4\nsensor_lsb_rad = 1e-4\n[defaults.motor]\nlag_ms = "
      "4\npull_only = true\n"
      "[joints]\nindex_pip_flexion = {}\n" +
      kJoint + kMotor);
  EXPECT_EQ(exo.joints[0].inertia, 1e-3);
  EXPECT_EQ(exo.joints[1].inertia, 5e-4);
  EXPECT_EQ(exo.joints[0].sensor_lsb, 1e-4);
  EXPECT_DOUBLE_EQ(exo.motors[0].lag, 0.004);
  EXPECT_TRUE(exo.motors[0].pull_only);
}

// Each scale doubles, and only doubles, what it names.
TEST(DeviceFile, ScalesEveryJointAndMotor) {
  const std::string text =
      kJoint + "damping_nms_per_rad = 1\nfriction_nm = 1\nsensor_lsb_rad = 0.1\nsensor_noise_rad = 0.1\n" +
      kMotor +
      "damping_ns_per_m = 1\nfriction_n = 1\ncapstan = 1\ntendon_damping_ns_per_m = 1\n"
      "backlash_mm = 1\nlag_ms = 1\n[controller]\ncompute_delay_ms = 1\nreturn_delay_ms = 1\n";
  const Exoskeleton plain = parse_text(text);
  struct Scaled {
    const char* key;
    std::vector<double> (*values)(const Exoskeleton&);
  };
  const std::vector<Scaled> scales = {
      {"inertia", [](const Exoskeleton& e) { return std::vector{e.joints[0].inertia, e.motors[0].mass}; }},
      {"damping", [](const Exoskeleton& e) { return std::vector{e.joints[0].damping, e.motors[0].damping}; }},
      {"sheath_friction",
       [](const Exoskeleton& e) {
         return std::vector{e.motors[0].sheath.coulomb, e.motors[0].sheath.capstan};
       }},
      {"joint_friction", [](const Exoskeleton& e) { return std::vector{e.joints[0].friction.coulomb}; }},
      {"tendon_stiffness", [](const Exoskeleton& e) { return std::vector{e.motors[0].tendon_stiffness}; }},
      {"tendon_damping", [](const Exoskeleton& e) { return std::vector{e.motors[0].tendon_damping}; }},
      {"backlash", [](const Exoskeleton& e) { return std::vector{e.motors[0].backlash}; }},
      {"lag", [](const Exoskeleton& e) { return std::vector{e.motors[0].lag}; }},
      {"compute_delay", [](const Exoskeleton& e) { return std::vector{e.controller.compute_delay}; }},
      {"return_delay", [](const Exoskeleton& e) { return std::vector{e.controller.return_delay}; }},
      {"sensor_lsb", [](const Exoskeleton& e) { return std::vector{e.joints[0].sensor_lsb}; }},
      {"sensor_noise", [](const Exoskeleton& e) { return std::vector{e.joints[0].sensor_noise}; }},
  };
  for (const Scaled& scale : scales) {
    SCOPED_TRACE(scale.key);
    const Exoskeleton doubled = parse_text(text + "[scale]\n" + scale.key + " = 2\n");
    for (const Scaled& other : scales) {
      const auto before = other.values(plain);
      const auto after = other.values(doubled);
      for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_EQ(after[i], before[i] * (other.key == scale.key ? 2.0 : 1.0)) << other.key;
    }
  }
}

TEST(DeviceFile, RefusesWhatItCannotUseWithLineKeyValueAndRemedy) {
  expect_refused("", {"d.toml", "joints", "is missing"});
  expect_refused("[joints]\n", {"d.toml:1", "has no joint", "[joints.NAME]"});
  expect_refused(kJoint + "dampign_nms_per_rad = 1\n",
                 {"d.toml:3: joints.index_mcp_flexion.dampign_nms_per_rad = 1", "nearest known one is",
                  "joints.index_mcp_flexion.damping_nms_per_rad"});
  expect_refused("[joints.index_mcp_flexoin]\ninertia_kg_m2 = 1\n",
                 {"d.toml:1: joints.index_mcp_flexoin", "nearest known one is joints.index_mcp_flexion"});
  expect_refused("[joints.index_mcp_flexion]\ndamping_nms_per_rad = 1\n",
                 {"d.toml:1: joints.index_mcp_flexion.inertia_kg_m2: is missing"});
  expect_refused("[joints.index_mcp_flexion]\ninertia_kg_m2 = -1\n",
                 {"d.toml:2: joints.index_mcp_flexion.inertia_kg_m2 = -1", "must be > 0"});
  expect_refused(kJoint + "torque_sensor = 1\n", {"d.toml:3", "write true or false"});
  expect_refused(kJoint + "[controler]\nrate_hz = 1\n",
                 {"d.toml:3: controler", "nearest known one is controller"});
  expect_refused(kJoint + "[scale]\ninertai = 2\n", {"d.toml:4: scale.inertai = 2", "scale.inertia"});
  expect_refused(kJoint + "[scale]\ninertia = 0\n", {"d.toml:4: scale.inertia = 0", "must be > 0"});
  expect_refused("scale = 3\n" + kJoint, {"d.toml:1: scale = 3", "write a table"});
  expect_refused(kJoint + "[defaults.motor]\nmass = 2\n" + kMotor,
                 {"d.toml:4: defaults.motor.mass", "mass_kg"});
  expect_refused(kJoint + "[copy]\nmiddle = { of = \"indx\" }\n", {"d.toml:4: copy.middle.of", "\"index\""});
  expect_refused(kJoint + "[copy]\nmiddle = { of = \"nine\" }\n",
                 {"d.toml:4: copy.middle.of = 'nine'", "neither a digit nor \"none\""});
  expect_refused(kJoint + "[copy]\nmiddel = { of = \"index\" }\n", {"d.toml:4: copy.middel", "copy.middle"});
  expect_refused(kJoint + "[coupled.index_dip_flexion]\nof = \"index_pip\"\nratio = 1\n",
                 {"d.toml:4: coupled.index_dip_flexion.of", "nearest one is \"index_pip_flexion\""});
  expect_refused(kJoint + "[coupled.index_dip_flexoin]\nof = \"index_mcp_flexion\"\nratio = 1\n",
                 {"d.toml:3: coupled.index_dip_flexoin", "nearest known one is coupled.index_dip_flexion"});
  expect_refused(
      kJoint + "[coupled.index_dip_flexion]\nof = \"index_mcp_flexion\"\nratio = 1\nofset_deg = 2\n",
      {"d.toml:6: coupled.index_dip_flexion.ofset_deg = 2", "coupled.index_dip_flexion.offset_deg"});
  expect_refused(kJoint + "[defaults.joints]\nsensor_lsb_rad = 1\n",
                 {"d.toml:3: defaults.joints", "nearest known one is defaults.joint"});
  expect_refused(kJoint + "[motors.mcp]\nmass_kg = 1\n", {"d.toml:3: motors.mcp.arms_mm: is missing"});
  expect_refused(kJoint + "[motors.mcp]\narms_mm = { index_mcp = -12 }\n",
                 {"d.toml:4: motors.mcp.arms_mm.index_mcp = -12", "motors.mcp.arms_mm.index_mcp_flexion"});
  expect_refused(kJoint +
                     "[motors.mcp]\narms_mm = { index_mcp_flexion = 0 }\nforce_limit_n = 60\nmass_kg = 22\n"
                     "tendon_stiffness_n_per_mm = 1000\n",
                 {"d.toml: motor mcp: moves no joint"});
  expect_refused(kJoint + "[motors.mcp]\nmass_kg = = 1\n", {"d.toml:4", "not valid TOML"});
}

// The number in question stands in the first line. The others leave room for it: a tendon that only pulls,
// with the largest force limit, may have the largest bias.
TEST(DeviceFile, TakesEachNumberUpToItsBoundAndNoFurther) {
  const std::string joint = "joints.index_mcp_flexion.";
  const std::string coupled = "coupled.index_pip_flexion.";
  const std::string motor = "motors.mcp.";
  const KeyValues others = {{joint + "inertia_kg_m2", "1e-3"},  {coupled + "of", "\"index_mcp_flexion\""},
                            {coupled + "ratio", "1"},           {motor + "arms_mm.index_mcp_flexion", "-12"},
                            {motor + "force_limit_n", "10000"}, {motor + "pull_only", "true"},
                            {motor + "mass_kg", "22"},          {motor + "tendon_stiffness_n_per_mm", "1000"},
                            {"copy.middle.of", "\"index\""}};
  std::vector<KeyBounds> all = {{joint + "inertia_kg_m2", "0", "1e-9", "1", "1.001"},
                                {joint + "damping_nms_per_rad", "-1e-9", "0", "100", "100.1"},
                                {joint + "friction_nm", "-1e-9", "0", "10", "10.01"},
                                {joint + "static_ratio", "0.999", "1", "10", "10.01"},
                                {joint + "stribeck_rad_per_s", "0", "1e-9", "1000", "1000.1"},
                                {joint + "sensor_lsb_rad", "-1e-9", "0", "1", "1.001"},
                                {joint + "sensor_noise_rad", "-1e-9", "0", "1", "1.001"},
                                {coupled + "ratio", "-10.01", "-10", "10", "10.01"},
                                {coupled + "offset_deg", "-180.1", "-180", "180", "180.1"},
                                {motor + "arms_mm.index_mcp_flexion", "-100.1", "-100", "100", "100.1"},
                                {motor + "lag_ms", "-1e-9", "0", "1000", "1000.1"},
                                {motor + "force_limit_n", "0", "1e-9", "10000", "10000.1"},
                                {motor + "bias_n", "-1e-9", "0", "10000", "10000.1"},
                                {motor + "force_constant_n_per_a", "0", "1e-9", "1000000", "1000000.1"},
                                {motor + "mass_kg", "0", "1e-9", "1000", "1000.1"},
                                {motor + "damping_ns_per_m", "-1e-9", "0", "100000", "100000.1"},
                                {motor + "tendon_stiffness_n_per_mm", "0", "1e-9", "100000", "100000.1"},
                                {motor + "tendon_damping_ns_per_m", "-1e-9", "0", "1000000", "1000000.1"},
                                {motor + "backlash_mm", "-1e-9", "0", "100", "100.1"},
                                {motor + "friction_n", "-1e-9", "0", "10000", "10000.1"},
                                {motor + "static_ratio", "0.999", "1", "10", "10.01"},
                                {motor + "stribeck_mm_per_s", "0", "1e-9", "1000000", "1000000.1"},
                                {motor + "capstan", "-1e-9", "0", "10", "10.01"},
                                {"controller.rate_hz", "0.999", "1", "100000", "100000.1"},
                                {"controller.compute_delay_ms", "-1e-9", "0", "1000", "1000.1"},
                                {"controller.return_delay_ms", "-1e-9", "0", "1000", "1000.1"},
                                {"copy.middle.gain", "-1e-9", "0", "10", "10.01"},
                                {"scale.inertia", "0", "1e-9", "1000", "1000.1"},
                                {"scale.tendon_stiffness", "0", "1e-9", "1000", "1000.1"}};
  for (const char* name : {"damping", "joint_friction", "sheath_friction", "tendon_damping", "backlash",
                           "lag", "sensor_lsb", "sensor_noise", "compute_delay", "return_delay"})
    all.push_back({std::string("scale.") + name, "-1e-9", "0", "1000", "1000.1"});
  for (const KeyBounds& b : all) {
    for (const char* good : {b.least, b.most})
      EXPECT_NO_THROW(static_cast<void>(parse_text(text_with(b.key, good, others))))
          << b.key << " = " << good;
    for (const char* bad : {b.below, b.above})
      expect_refused(text_with(b.key, bad, others), {"d.toml:1: " + b.key + " = ", "must be"});
  }
}

TEST(DeviceFile, StandsOnAnother) {
  const Exoskeleton base = load_device_file("beihang");
  const Exoskeleton exo = parse_text(
      "base = \"beihang\"\n[motors.index_pip]\nfriction_n = 1\n[scale]\nlag = "
      "0.5\n[controller]\ncompute_delay_ms = 2\n");
  EXPECT_EQ(exo.motors.size(), base.motors.size());
  for (std::size_t m = 0; m < base.motors.size(); ++m) {
    const bool changed = base.motors[m].name == "index_pip";
    EXPECT_EQ(exo.motors[m].sheath.coulomb, changed ? 1.0 : base.motors[m].sheath.coulomb);
    EXPECT_EQ(exo.motors[m].lag, 0.5 * base.motors[m].lag);
  }
  EXPECT_DOUBLE_EQ(exo.controller.compute_delay, 0.002);
  EXPECT_EQ(exo.controller.return_delay, base.controller.return_delay);
  expect_refused("base = \"beihagn\"\n", {"d.toml:1: base: device \"beihagn\"", "did you mean \"beihang\"?"});
  expect_refused("base = 3\n", {"d.toml:1: base = 3", "a string"});
}

TEST(DeviceFile, TakesBackACopyOfItsBase) {
  const Exoskeleton exo = parse_text("base = \"beihang\"\n[copy]\nring.of = \"none\"\n");
  EXPECT_EQ(exo.controller.copy[2].of, 1);
  EXPECT_EQ(exo.controller.copy[3].of, -1);
  EXPECT_EQ(exo.controller.copy[4].of, 1);
}

// Scales multiply from file to file, so that a scene's scale counts from the device it names.
TEST(DeviceFile, MultipliesTheScalesOfItsBase) {
  const Exoskeleton heavy = load_device_file("heavy_viscous");
  const Exoskeleton twice = parse_text("base = \"heavy_viscous\"\n[scale]\ninertia = 2\n");
  EXPECT_EQ(twice.joints[0].inertia, 2.0 * heavy.joints[0].inertia);
  EXPECT_EQ(twice.joints[0].damping, heavy.joints[0].damping);
}

TEST(DeviceFile, ThatStandsOnItselfIsRefused) {
  const auto folder = std::filesystem::temp_directory_path() / "phalanx_device_circle";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "a.toml") << "base = \"b.toml\"\n";
  std::ofstream(folder / "b.toml") << "base = \"a.toml\"\n";
  expect_scene_error([&] { static_cast<void>(load_device_file("a.toml", folder)); },
                     {"base = ", "in a circle"});
  std::filesystem::remove_all(folder);
}

TEST(DeviceFile, MayStandOnEightOthersAndNoMore) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "d0.toml") << kJoint << kMotor;
  for (int i = 1; i <= 9; ++i)
    std::ofstream(folder / ("d" + std::to_string(i) + ".toml")) << "base = \"d" << i - 1 << ".toml\"\n";
  EXPECT_EQ(load_device_file("d8.toml", folder.path()).joints.size(), 1U);
  expect_scene_error([&] { static_cast<void>(load_device_file("d9.toml", folder.path())); },
                     {"d1.toml:1: base = ", "in a circle"});
}

TEST(DeviceFile, ThatShipsIsReadWhole) {
  for (const char* name : {"beihang", "light", "heavy_viscous", "frictionless"}) {
    SCOPED_TRACE(name);
    const Exoskeleton exo = load_device_file(name);
    EXPECT_EQ(exo.name, name);
    EXPECT_FALSE(exo.description.empty());
    EXPECT_EQ(exo.joints.size(), 8U);
    EXPECT_EQ(exo.motors.size(), 8U);
    for (const int digit : {2, 3, 4}) EXPECT_EQ(exo.controller.copy[static_cast<std::size_t>(digit)].of, 1);
  }
}

bool same_friction(const DryFriction& a, const DryFriction& b) {
  return a.coulomb == b.coulomb && a.static_ratio == b.static_ratio && a.stribeck_speed == b.stribeck_speed &&
         a.capstan == b.capstan;
}

// Joint by joint and motor by motor: what differs between the fingers is only which joint it is.
TEST(DeviceFile, FiveDigitsGivesEachFingerTheJointsAndMotorsOfTheIndexFinger) {
  const Exoskeleton exo = load_device_file("five_digits");
  const PatientParameters adult = load_patient_file("adult");
  const Exoskeleton beihang = load_device_file("beihang");
  ASSERT_EQ(exo.joints.size(), idx(kJoints));
  ASSERT_EQ(exo.motors.size(), idx(kJoints));
  for (const DigitCopy& copy : exo.controller.copy) EXPECT_EQ(copy.of, -1);
  const auto motor_of = [](const Exoskeleton& device, int joint) {
    return std::find_if(device.motors.begin(), device.motors.end(),
                        [joint](const ExoMotor& motor) { return motor.arm[idx(joint)] != 0.0; });
  };
  for (int j = 0; j < kJoints; ++j) {
    SCOPED_TRACE(joint_name(j));
    const int model = j < 2 * kJointsPerDigit ? j : joint_index(1, j % kJointsPerDigit);
    const ExoJoint& mine = exo.joints[idx(j)];
    const auto theirs = std::find_if(beihang.joints.begin(), beihang.joints.end(),
                                     [model](const ExoJoint& joint) { return joint.joint == model; });
    ASSERT_NE(theirs, beihang.joints.end());
    EXPECT_EQ(mine.joint, j);
    EXPECT_EQ(mine.inertia, theirs->inertia);
    EXPECT_EQ(mine.damping, theirs->damping);
    EXPECT_TRUE(same_friction(mine.friction, theirs->friction));
    EXPECT_EQ(mine.sensor_lsb, theirs->sensor_lsb);
    EXPECT_EQ(mine.sensor_noise, theirs->sensor_noise);
    const auto motor = motor_of(exo, j);
    const auto index = motor_of(beihang, model);
    ASSERT_NE(motor, exo.motors.end());
    ASSERT_NE(index, beihang.motors.end());
    EXPECT_EQ(motor->arm[idx(j)], index->arm[idx(model)]);
    EXPECT_EQ(motor->mass, index->mass);
    EXPECT_EQ(motor->damping, index->damping);
    EXPECT_EQ(motor->lag, index->lag);
    EXPECT_EQ(motor->force_limit, index->force_limit);
    EXPECT_TRUE(same_friction(motor->sheath, index->sheath));
    EXPECT_EQ(motor->tendon_stiffness, index->tendon_stiffness);
    EXPECT_EQ(motor->tendon_damping, index->tendon_damping);
    EXPECT_EQ(motor->backlash, index->backlash);
    EXPECT_EQ(adult.stiffness[idx(j)], adult.stiffness[idx(model)]);
    EXPECT_EQ(adult.damping[idx(j)], adult.damping[idx(model)]);
  }
}

// Whatever the bytes: a device that check_exoskeleton() accepts, or an error with a message.
TEST(DeviceFile, WithAnyBytesChangedIsReadOrRefused) {
  constexpr std::uint64_t kSeed = 11;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  Random random(kSeed);
  const std::string whole =
      "base = \"beihang\"\n" + kJoint + kMotor + "[scale]\nlag = 2\n[copy]\nring.of = \"index\"\n";
  constexpr std::string_view kBytes = "[]{}=.,\"'#\n 019-+einfa_\x00\xff";
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(random.uniform() * static_cast<double>(n));
  };
  int refused = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::string text = whole;
    for (int change = 0; change < 1 + trial % 3; ++change)
      text[below(text.size())] = kBytes[below(kBytes.size())];
    try {
      check_exoskeleton(parse_text(text));
    } catch (const SceneError& error) {
      ++refused;
      EXPECT_NE(error.what()[0], '\0');
    }
  }
  EXPECT_GT(refused, 100);
  EXPECT_LT(refused, 300);
}

TEST(DeviceText, IsTheSameForTheSameNumbersAndHoldsEachOfThem) {
  const std::string text = device_text(parse_text(kJoint + kMotor));
  // A line for each of the joint's 9 numbers, the motor's 14 and its one arm, the controller's 3 and
  // each digit's 2.
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 9 + 14 + 1 + 3 + 5 * 2);
  EXPECT_EQ(text, device_text(parse_text(kMotor + kJoint)));
  EXPECT_EQ(text, device_text(parse_text("description = \"another\"\n" + kJoint + kMotor)));
  for (const char* change : {"[scale]\ninertia = 1.0000000001\n", "[scale]\ntendon_stiffness = 2\n",
                             "[controller]\nrate_hz = 500\n", "[controller]\nreturn_delay_ms = 1\n",
                             "[copy]\nring = { of = \"index\" }\n",
                             "[coupled.index_pip_flexion]\nof = \"index_mcp_flexion\"\nratio = 1\n",
                             "[defaults.motor]\nlag_ms = 1\n", "[defaults.joint]\ntorque_sensor = true\n",
                             "[defaults.motor]\npull_only = true\n", "[defaults.motor]\nbacklash_mm = 1\n",
                             "[defaults.joint]\nstatic_ratio = 1.5\n"})
    EXPECT_NE(text, device_text(parse_text(kJoint + kMotor + change))) << change;
  const std::string range = kJoint + kLinkage + "range_deg = [0, 90]\n";
  const std::string line = device_text(parse_text(range + "arm_polynomial_mm = [10, 1]\n"));
  for (const char* change : {"arm_polynomial_mm = [10, 2]\n", "arm_polynomial_mm = [10, 1, 0.1]\n",
                             "arm_table_deg_mm = [[0, 10], [90, 11]]\n"})
    EXPECT_NE(line, device_text(parse_text(range + change))) << change;
}

TEST(DeviceText, ChangesWithEveryNumberOfADevice) {
  Exoskeleton exo = parse_text(kJoint + kMotor);
  exo.coupled.push_back({.joint = exo.joints[0].joint + 1, .of = exo.joints[0].joint});
  const std::string text = device_text(exo);
  ExoJoint& joint = exo.joints[0];
  ExoMotor& motor = exo.motors[0];
  ExoController& controller = exo.controller;
  for (double* number : {&joint.inertia,
                         &joint.damping,
                         &joint.friction.coulomb,
                         &joint.friction.static_ratio,
                         &joint.friction.stribeck_speed,
                         &joint.friction.capstan,
                         &joint.sensor_lsb,
                         &joint.sensor_noise,
                         &exo.coupled[0].ratio,
                         &exo.coupled[0].offset,
                         &motor.arm[idx(joint.joint)],
                         &motor.lag,
                         &motor.force_limit,
                         &motor.bias,
                         &motor.force_constant,
                         &motor.mass,
                         &motor.damping,
                         &motor.tendon_stiffness,
                         &motor.tendon_damping,
                         &motor.backlash,
                         &motor.sheath.coulomb,
                         &motor.sheath.static_ratio,
                         &motor.sheath.stribeck_speed,
                         &motor.sheath.capstan,
                         &controller.rate_hz,
                         &controller.compute_delay,
                         &controller.return_delay,
                         &controller.copy[3].gain}) {
    const double before = *number;
    *number += 0.125;
    EXPECT_NE(device_text(exo), text) << "the number that is " << before;
    *number = before;
  }
  for (bool* flag : {&joint.torque_sensor, &motor.pull_only}) {
    *flag = !*flag;
    EXPECT_NE(device_text(exo), text);
    *flag = !*flag;
  }
  controller.copy[3].of = 1;
  EXPECT_NE(device_text(exo), text);
}

}  // namespace
}  // namespace phalanx
