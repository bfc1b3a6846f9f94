// SPDX-License-Identifier: Apache-2.0
#include <numbers>
#include <string>

#include "phalanx/scene/scene.h"
#include "scene/expect_error.h"

namespace phalanx {
namespace {

SceneDescription parse_keys(const std::string& text) { return parse_scene(text, "test.toml", "."); }

void expect_stabiliser_refused(const std::string& text, const std::vector<std::string>& words) {
  SCOPED_TRACE(text);
  expect_scene_error([&] { static_cast<void>(parse_keys(text)); }, words);
}

TEST(StabiliserKeys, KnowEveryMethodByName) {
  const std::vector<std::pair<std::string, Stabiliser>> methods = {
      {"none", Stabiliser::kNone},
      {"smoothing", Stabiliser::kSmoothing},
      {"rise_only", Stabiliser::kRiseOnly},
      {"direction", Stabiliser::kDirection},
      {"low_pass", Stabiliser::kLowPass},
      {"kelvin_voigt", Stabiliser::kKelvinVoigt},
      {"virtual_coupling", Stabiliser::kVirtualCoupling},
      {"passivity", Stabiliser::kPassivity},
      {"energy_bounding", Stabiliser::kEnergyBounding},
      {"local_wall", Stabiliser::kLocalWall}};
  for (const auto& [name, method] : methods)
    EXPECT_EQ(parse_keys("stabiliser.method = \"" + name + "\"").parameters.stabiliser.method, method)
        << name;
  EXPECT_EQ(parse_keys("").parameters.stabiliser.method, Stabiliser::kRiseOnly);
  expect_stabiliser_refused("stabiliser.method = \"smooth\"",
                            {"test.toml:1", "stabiliser.method", "did you mean \"smoothing\""});
}

// A key that a scene leaves out has the default of its parameter.
TEST(StabiliserKeys, HaveTheDefaultsOfTheStructs) {
  const SceneDescription scene = parse_keys("");
  const StabiliserParameters s;
  EXPECT_EQ(scene.parameters.stabiliser.method, s.method);
  EXPECT_DOUBLE_EQ(scene.parameters.stabiliser.lowpass_hz, s.lowpass_hz);
  EXPECT_DOUBLE_EQ(scene.parameters.stabiliser.damping, s.damping);
  EXPECT_DOUBLE_EQ(scene.parameters.stabiliser.turn_rate, s.turn_rate);
  EXPECT_DOUBLE_EQ(scene.parameters.stabiliser.coupling_stiffness, s.coupling_stiffness);
  EXPECT_DOUBLE_EQ(scene.parameters.stabiliser.coupling_damping, s.coupling_damping);
  EXPECT_DOUBLE_EQ(scene.parameters.stabiliser.passivity_damping_max, s.passivity_damping_max);
  EXPECT_DOUBLE_EQ(scene.parameters.stabiliser.device_damping, s.device_damping);
  EXPECT_DOUBLE_EQ(scene.parameters.stabiliser.wall_valid, s.wall_valid);
  EXPECT_DOUBLE_EQ(scene.parameters.oscillation.swing, OscillationParameters{}.swing);
  EXPECT_EQ(scene.parameters.oscillation.reaction, OscillationParameters{}.reaction);
}

TEST(StabiliserKeys, AreInSIUnitsInside) {
  const SceneDescription scene = parse_keys(R"(
hand.meshes = "capsules"
[stabiliser]
method = "virtual_coupling"
turn_deg_per_s = 180
lowpass_hz = 10
damping_ns_per_m = 8
coupling_stiffness_n_per_mm = 2
coupling_damping_ns_per_m = 5
passivity_damping_max_ns_per_m = 7
device_damping_ns_per_m = 0.8
wall_valid_ms = 20
[oscillation]
reaction = "halve"
swing_n = 0.3
)");
  EXPECT_EQ(scene.parameters.stabiliser.method, Stabiliser::kVirtualCoupling);
  EXPECT_DOUBLE_EQ(scene.parameters.stabiliser.turn_rate, std::numbers::pi);
  EXPECT_EQ(scene.parameters.stabiliser.lowpass_hz, 10.0);
  EXPECT_EQ(scene.parameters.stabiliser.damping, 8.0);
  EXPECT_DOUBLE_EQ(scene.parameters.stabiliser.coupling_stiffness, 2000.0);
  EXPECT_EQ(scene.parameters.stabiliser.coupling_damping, 5.0);
  EXPECT_EQ(scene.parameters.stabiliser.passivity_damping_max, 7.0);
  EXPECT_EQ(scene.parameters.stabiliser.device_damping, 0.8);
  EXPECT_DOUBLE_EQ(scene.parameters.stabiliser.wall_valid, 0.02);
  EXPECT_EQ(scene.parameters.oscillation.reaction, OscillationReaction::kHalve);
  EXPECT_EQ(scene.parameters.oscillation.swing, 0.3);
}

// The older form of the method "none" is gone, whatever it says and whatever else is stated.
TEST(StabiliserKeys, RefuseTheSwitchOfTheSmoothingAndNameWhatReplacesIt) {
  for (const char* text : {"smoothing.enabled = false", "smoothing.enabled = true", "smoothing.enabled = 3",
                           "smoothing.enabled = false\nstabiliser.method = \"none\""}) {
    const std::string stated(std::string_view(text).substr(0, std::string_view(text).find('\n')));
    expect_stabiliser_refused(text, {"test.toml:1: " + stated + ": ", "stabiliser.method replaces it",
                                     "remove it", "stabiliser.method = \"none\""});
  }
  EXPECT_THAT([] { (void)parse_scene("", "test.toml", "/", {{"smoothing.enabled", "false"}}); },
              ::testing::ThrowsMessage<SceneError>(
                  ::testing::HasSubstr("--set smoothing.enabled=false: smoothing.enabled = false: ")));
}

}  // namespace
}  // namespace phalanx
