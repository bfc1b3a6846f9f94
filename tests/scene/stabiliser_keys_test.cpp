// SPDX-License-Identifier: Apache-2.0
#include <numbers>
#include <string>

#include "expect_error.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/scene.h"

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
    EXPECT_EQ(parse_keys("stabiliser.method = \"" + name + "\"").stabiliser.method, method) << name;
  EXPECT_EQ(parse_keys("").stabiliser.method, Stabiliser::kSmoothing);
  expect_stabiliser_refused("stabiliser.method = \"smooth\"",
                            {"test.toml:1", "stabiliser.method", "did you mean \"smoothing\""});
}

// What a scene does not state is what a model has by itself.
TEST(StabiliserKeys, HaveTheDefaultsOfTheStructs) {
  const SceneDescription scene = parse_keys("");
  const StabiliserParameters s;
  EXPECT_DOUBLE_EQ(scene.stabiliser.lowpass_hz, s.lowpass_hz);
  EXPECT_DOUBLE_EQ(scene.stabiliser.damping, s.damping);
  EXPECT_DOUBLE_EQ(scene.stabiliser.turn_rate, s.turn_rate);
  EXPECT_DOUBLE_EQ(scene.stabiliser.coupling_stiffness, s.coupling_stiffness);
  EXPECT_DOUBLE_EQ(scene.stabiliser.coupling_damping, s.coupling_damping);
  EXPECT_DOUBLE_EQ(scene.stabiliser.passivity_damping_max, s.passivity_damping_max);
  EXPECT_DOUBLE_EQ(scene.stabiliser.device_damping, s.device_damping);
  EXPECT_DOUBLE_EQ(scene.stabiliser.wall_valid, s.wall_valid);
  EXPECT_DOUBLE_EQ(scene.oscillation.swing, OscillationParameters{}.swing);
  EXPECT_EQ(scene.oscillation.reaction, OscillationParameters{}.reaction);
}

TEST(StabiliserKeys, AreInSIUnitsInsideAndReachTheModel) {
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
  const HapticModel model = build_model(scene);
  EXPECT_EQ(model.stabiliser.method, Stabiliser::kVirtualCoupling);
  EXPECT_DOUBLE_EQ(model.stabiliser.turn_rate, std::numbers::pi);
  EXPECT_EQ(model.stabiliser.lowpass_hz, 10.0);
  EXPECT_EQ(model.stabiliser.damping, 8.0);
  EXPECT_DOUBLE_EQ(model.stabiliser.coupling_stiffness, 2000.0);
  EXPECT_EQ(model.stabiliser.coupling_damping, 5.0);
  EXPECT_EQ(model.stabiliser.passivity_damping_max, 7.0);
  EXPECT_EQ(model.stabiliser.device_damping, 0.8);
  EXPECT_DOUBLE_EQ(model.stabiliser.wall_valid, 0.02);
  EXPECT_EQ(model.oscillation.reaction, OscillationReaction::kHalve);
  EXPECT_EQ(model.oscillation.swing, 0.3);
}

TEST(StabiliserKeys, TakeTheOlderFormWhereItSaysTheSame) {
  for (const char* text :
       {"smoothing.enabled = false", "smoothing.enabled = false\nstabiliser.method = \"none\"",
        "smoothing.enabled = false\nstabiliser.method = \"smoothing\""}) {
    const SceneDescription scene = parse_keys(text);
    EXPECT_TRUE(!scene.smoothing.enabled || scene.stabiliser.method == Stabiliser::kNone) << text;
  }
  EXPECT_EQ(parse_keys("smoothing.enabled = true\nstabiliser.method = \"low_pass\"").stabiliser.method,
            Stabiliser::kLowPass);
  expect_stabiliser_refused("smoothing.enabled = false\nstabiliser.method = \"low_pass\"",
                            {"test.toml:1", "smoothing.enabled", "stabiliser.method", "low_pass", "remove"});
  expect_stabiliser_refused("smoothing.enabled = true\nstabiliser.method = \"none\"",
                            {"test.toml:1", "smoothing.enabled", "stabiliser.method", "none", "remove"});
  expect_stabiliser_refused("smoothing.enabled = 3\nstabiliser.method = \"none\"", {"true or false"});
}

}  // namespace
}  // namespace phalanx
