// SPDX-License-Identifier: Apache-2.0
// A scene's own keys over those of the device file that it names.
#include <filesystem>
#include <fstream>

#include "phalanx/scene/device_file.h"
#include "scene/expect_error.h"

namespace phalanx {
namespace {

SceneDescription scene(const std::string& text, const Overrides& overrides = {}) {
  return parse_scene(text, "s.toml", ".", overrides);
}

TEST(DeviceInAScene, IsTheShippedOneUnlessTheSceneNamesAnother) {
  EXPECT_EQ(load_device(scene("")).name, "beihang");
  EXPECT_EQ(load_device(scene("device.file = \"light\"")).name, "light");
  EXPECT_EQ(device_text(scene("")), device_text(load_device_file("beihang")));
}

TEST(DeviceInAScene, IsOverlaidByTheScenesOwnKeys) {
  const SceneDescription s = scene(
      "[device]\nfile = \"light\"\nscale.sheath_friction = 0\n[device.motors.index_pip]\nforce_limit_n = 5\n"
      "[device.motors.index_pip.arms_mm]\nindex_dip_flexion = -3\n",
      {{"device.controller.compute_delay_ms", "2"}, {"device.motors.index_mcp.lag_ms", "7.5"}});
  const Exoskeleton exo = load_device(s);
  EXPECT_DOUBLE_EQ(exo.controller.compute_delay, 0.002);
  for (const ExoMotor& motor : exo.motors) {
    EXPECT_EQ(motor.sheath.coulomb, 0.0);
    EXPECT_DOUBLE_EQ(motor.lag, motor.name == "index_mcp" ? 0.0075 : 0.004);
    if (motor.name != "index_pip") continue;
    EXPECT_EQ(motor.force_limit, 5.0);
    EXPECT_DOUBLE_EQ(motor.arm[7], -0.003);
    EXPECT_DOUBLE_EQ(motor.arm[6], -0.010);
  }
}

TEST(DeviceInAScene, IsCheckedWhenTheSceneIsRead) {
  const auto refused = [](const std::string& text, const Overrides& overrides,
                          const std::vector<std::string>& words) {
    SCOPED_TRACE(text);
    expect_scene_error([&] { static_cast<void>(scene(text, overrides)); }, words);
  };
  refused("\n[device]\nfile = \"beihagn\"", {}, {"s.toml:3: device.file = ", "did you mean \"beihang\"?"});
  refused(
      "\n[device]\nscale.sheeth_friction = 0", {},
      {"s.toml:3: device.scale.sheeth_friction = 0", "nearest known one is device.scale.sheath_friction"});
  refused("", {{"device.motors.index_pip.mass_kg", "-1"}},
          {"--set device.motors.index_pip.mass_kg=-1: device.motors.index_pip.mass_kg = -1: must be > 0"});
  refused("\n\ndevice.controller.rate_hz = \"fast\"", {},
          {"s.toml:3: device.controller.rate_hz", "write a number"});
  refused("\ndevice.motors.thumbs.mass_kg = 3", {}, {"s.toml:2: device.motors.thumbs", "is missing"});
  refused("\ndevice.joints = 3", {}, {"s.toml:2: device.joints = 3", "write a table"});
  refused("\ndevice.base = \"light\"", {}, {"s.toml:2: device.base", "device.file"});
  refused(
      "\n[device.motors.index_pip.arms_mm]\nindex_pip_flexion = 0", {},
      {"beihang.toml", "s.toml:3: device.motors.index_pip.arms_mm.index_pip_flexion = 0", "moves no joint"});
  refused("\ndevice.foo = {}", {}, {"s.toml:2: device.foo", "is not a known key"});
  refused("\ndevice.\"a b\" = 1", {}, {"s.toml:2: device", "a b"});
  refused("device = 3", {}, {"s.toml:1: device = 3", "is a table"});
  refused("device.file = 3", {}, {"s.toml:1: device.file = 3", "a string"});
  refused("device.file.x = 3", {}, {"s.toml:1: device.file", "a string"});
}

// The message names the statement, the device file and the options that remove every such copy. The scene's
// other keys are not in it.
TEST(DeviceInAScene, RefusesACopyOfADigitWithJointsAtTheStatementOfTheCopy) {
  const std::string text =
      "[device]\nfile = \"five_digits\"\nscale.lag = 0.7\n[device.copy]\n"
      "middle = { of = \"index\", gain = 1.32 }\nring = { of = \"index\" }\n";
  try {
    static_cast<void>(scene(text));
    FAIL() << "read";
  } catch (const SceneError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find("s.toml:5: device.copy.middle.of = "), 0U) << message;
    EXPECT_NE(message.find("five_digits.toml has joints of this digit"), std::string::npos) << message;
    EXPECT_NE(message.find("type --set device.copy.middle.of=none --set device.copy.ring.of=none"),
              std::string::npos)
        << message;
    EXPECT_EQ(message.find("scale"), std::string::npos) << message;
    EXPECT_EQ(message.find("gain"), std::string::npos) << message;
  }
  EXPECT_NO_THROW(
      static_cast<void>(scene(text, {{"device.copy.middle.of", "none"}, {"device.copy.ring.of", "none"}})));
  expect_scene_error([] { static_cast<void>(scene("device.copy.middle.of = \"ring\"")); },
                     {"s.toml:1: device.copy.middle.of = ", "has no joint of the ring", "\"none\""});
}

TEST(DeviceInAScene, NamesTheScenesNumbersAsTheyWereWritten) {
  expect_scene_error(
      [] {
        static_cast<void>(
            scene("device.scale.lag = 0.7\n[device.motors.index_pip.arms_mm]\nindex_pip_flexion = 0"));
      },
      {"moves no joint", "s.toml:1: device.scale.lag = 0.7)"});
}

// A path in a scene is relative to the scene's folder.
TEST(DeviceInAScene, MayBeAPathBesideTheScene) {
  const auto folder = std::filesystem::temp_directory_path() / "phalanx_device_beside";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "mine.toml") << "[joints.index_mcp_flexion]\ninertia_kg_m2 = 1e-3\n";
  const SceneDescription s = parse_scene("device.file = \"mine.toml\"", "s.toml", folder);
  EXPECT_EQ(load_device(s).joints.size(), 1U);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace phalanx
