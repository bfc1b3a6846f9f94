// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/scene.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace phalanx {
namespace {

SceneDescription parse(const std::string& text, const Overrides& overrides = {}) {
  return parse_scene(text, "test.toml", "/somewhere", overrides);
}

// The defaults that the key table states are those of the structs.
TEST(Scene, OfAnEmptyFileIsTheDefaultScene) {
  const SceneDescription scene = parse("");
  const SceneDescription expected;
  EXPECT_EQ(scene.name, "test");
  EXPECT_EQ(scene.parameters.rate_hz, expected.parameters.rate_hz);
  EXPECT_EQ(scene.seconds, expected.seconds);
  EXPECT_EQ(scene.seed, expected.seed);
  EXPECT_EQ(scene.hand.file, expected.hand.file);
  EXPECT_EQ(scene.hand.handedness, expected.hand.handedness);
  EXPECT_EQ(scene.hand.triangles, expected.hand.triangles);
  EXPECT_EQ(scene.hand.pose.R, expected.hand.pose.R);
  EXPECT_EQ(scene.hand.pose.p, expected.hand.pose.p);
  EXPECT_TRUE(scene.objects.empty());
  EXPECT_DOUBLE_EQ(scene.parameters.contact.margin, expected.parameters.contact.margin);
  EXPECT_DOUBLE_EQ(scene.parameters.contact.slid_distance, expected.parameters.contact.slid_distance);
  EXPECT_EQ(scene.parameters.contact.method, expected.parameters.contact.method);
  EXPECT_EQ(scene.parameters.contact.depth, expected.parameters.contact.depth);
  EXPECT_EQ(scene.parameters.contact.normal, expected.parameters.contact.normal);
  EXPECT_EQ(scene.parameters.force.law, expected.parameters.force.law);
  EXPECT_DOUBLE_EQ(scene.parameters.force.stiffness, expected.parameters.force.stiffness);
  EXPECT_DOUBLE_EQ(scene.parameters.force.damping, expected.parameters.force.damping);
  EXPECT_DOUBLE_EQ(scene.parameters.force.velocity_lowpass_hz, expected.parameters.force.velocity_lowpass_hz);
  EXPECT_DOUBLE_EQ(scene.parameters.force.hunt_crossley_exponent,
                   expected.parameters.force.hunt_crossley_exponent);
  EXPECT_DOUBLE_EQ(scene.parameters.force.hunt_crossley_damping,
                   expected.parameters.force.hunt_crossley_damping);
  EXPECT_DOUBLE_EQ(scene.parameters.force.cubic, expected.parameters.force.cubic);
  EXPECT_DOUBLE_EQ(scene.parameters.force.linear_depth, expected.parameters.force.linear_depth);
  EXPECT_EQ(scene.parameters.stabiliser.min_rate, expected.parameters.stabiliser.min_rate);
  EXPECT_EQ(scene.parameters.stabiliser.max_rate, expected.parameters.stabiliser.max_rate);
  EXPECT_TRUE(scene.parameters.limits.fingertip_force_enabled &&
              scene.parameters.limits.joint_torque_enabled && scene.parameters.limits.torque_rate_enabled);
  EXPECT_EQ(scene.parameters.limits.fingertip_force, expected.parameters.limits.fingertip_force);
  EXPECT_EQ(scene.parameters.limits.joint_torque, expected.parameters.limits.joint_torque);
  EXPECT_EQ(scene.parameters.limits.torque_rate, expected.parameters.limits.torque_rate);
  EXPECT_EQ(scene.parameters.limits.joint_speed, expected.parameters.limits.joint_speed);
  EXPECT_EQ(scene.motion.script.name, expected.motion.script.name);
  EXPECT_EQ(scene.motion.script.start_s, expected.motion.script.start_s);
  EXPECT_EQ(scene.motion.script.close_s, expected.motion.script.close_s);
  EXPECT_EQ(scene.motion.script.hold_s, expected.motion.script.hold_s);
  EXPECT_EQ(scene.motion.script.open_s, expected.motion.script.open_s);
  EXPECT_EQ(scene.motion.script.repeat, expected.motion.script.repeat);
  EXPECT_EQ(scene.motion.script.closure, expected.motion.script.closure);
  EXPECT_EQ(scene.motion.script.digit_closure, expected.motion.script.digit_closure);
  EXPECT_EQ(scene.motion.script.tremor_rad, expected.motion.script.tremor_rad);
  EXPECT_TRUE(scene.motion.file.empty());
  EXPECT_FALSE(scene.motion.trial.has_value());
}

TEST(Scene, OfAnObjectWithoutSizesHasTheDefaultOnes) {
  for (const char* kind : {"teapot", "sphere", "box", "cylinder", "torus", "mug"}) {
    const SceneDescription scene = parse("[[objects]]\nkind = \"" + std::string(kind) + "\"");
    ASSERT_EQ(scene.objects.size(), 1U);
    const ObjectDescription& object = scene.objects[0];
    const ObjectDescription expected;
    EXPECT_EQ(object.kind, kind);
    EXPECT_DOUBLE_EQ(object.size, expected.size);
    EXPECT_DOUBLE_EQ(object.diameter, expected.diameter);
    EXPECT_DOUBLE_EQ(object.length, expected.length);
    EXPECT_DOUBLE_EQ(object.ring_diameter, expected.ring_diameter);
    EXPECT_DOUBLE_EQ(object.tube_diameter, expected.tube_diameter);
    EXPECT_EQ(object.extent, expected.extent);
    EXPECT_EQ(object.triangles, expected.triangles);
  }
}

// Keys that exist for one kind of object only.
TEST(Scene, OfAnObjectWithoutItsOwnSizesHasTheStructs) {
  const auto object = [](const std::string& keys) {
    return parse("[[objects]]\nkind = " + keys).objects.at(0);
  };
  const ObjectDescription expected;
  EXPECT_DOUBLE_EQ(object("\"key\"").breadth, expected.breadth);
  EXPECT_DOUBLE_EQ(object("\"key\"").thickness, expected.thickness);
  EXPECT_DOUBLE_EQ(object("\"therapy_ball\"").bump, expected.bump);
  EXPECT_EQ(object("\"peg\"").head_diameter, expected.head_diameter);
  EXPECT_DOUBLE_EQ(object("\"jar\"").lid_diameter, expected.lid_diameter);
  const ObjectDescription file = object("\"file\"\nfile = \"m.obj\"");
  EXPECT_DOUBLE_EQ(file.size, expected.size);
  EXPECT_EQ(file.unit, expected.unit);
  EXPECT_EQ(file.decimate_to, expected.decimate_to);
}

TEST(Scene, ConvertsItsUnitsToSi) {
  const SceneDescription scene = parse(R"(
    [contact]
    margin_mm = 0.1
    [force]
    stiffness_n_per_mm = 0.9
    cubic_n_per_mm3 = 2
    [motion]
    tremor_deg = 9
    [[objects]]
    kind = "sphere"
    diameter_mm = 40
    position_mm = [1, -2.5, 3])");
  EXPECT_DOUBLE_EQ(scene.parameters.contact.margin, 1e-4);
  EXPECT_DOUBLE_EQ(scene.parameters.force.stiffness, 900.0);
  EXPECT_DOUBLE_EQ(scene.parameters.force.cubic, 2e9);
  EXPECT_DOUBLE_EQ(scene.motion.script.tremor_rad, std::numbers::pi / 20.0);
  EXPECT_DOUBLE_EQ(scene.objects[0].diameter, 0.04);
  EXPECT_TRUE(scene.objects[0].pose.p.isApprox(Vec3(0.001, -0.0025, 0.003), 1e-15));
}

// Times, closures, laws and limits: every number another.
TEST(Scene, KeepsEachNumberInItsOwnPlace) {
  const SceneDescription scene = parse(R"(
    seconds = 6.5
    contact.slid_mm = 7
    contact.mode = "sliding"
    contact.friction = 0.35
    contact.tangential_stiffness_ratio = 0.25
    contact.spin_radius_mm = 3
    contact.max_contacts = 2
    [motion]
    start_s = 0.125
    close_s = 2
    hold_s = 3
    open_s = 4
    repeat = 5
    closure = 0.75
    thumb = 0.5
    index = 1.5
    middle = 2.5
    ring = 3.5
    little = 4.5
    trial = 9
    [force]
    damping_ns_per_m = 3.25
    velocity_lowpass_hz = 40
    exponent = 1.25
    hunt_crossley_damping_s_per_m = 2.25
    linear_depth_mm = 8
    [smoothing]
    min_n_per_s = -30
    max_n_per_s = 50
    [limits]
    fingertip_force_n = 4.5
    joint_torque_nm = 0.25
    torque_rate_nm_per_s = 8.5
    joint_speed_rad_per_s = 35)");
  EXPECT_EQ(scene.seconds, 6.5);
  EXPECT_DOUBLE_EQ(scene.parameters.contact.slid_distance, 7e-3);
  EXPECT_EQ(scene.parameters.contact.mode, ContactMode::kSliding);
  EXPECT_EQ(scene.parameters.contact.friction, 0.35);
  EXPECT_EQ(scene.parameters.contact.tangential_stiffness_ratio, 0.25);
  EXPECT_DOUBLE_EQ(scene.parameters.contact.spin_radius, 3e-3);
  EXPECT_EQ(scene.parameters.contact.max_contacts, 2);
  EXPECT_EQ(scene.motion.script.start_s, 0.125);
  EXPECT_EQ(scene.motion.script.close_s, 2.0);
  EXPECT_EQ(scene.motion.script.hold_s, 3.0);
  EXPECT_EQ(scene.motion.script.open_s, 4.0);
  EXPECT_EQ(scene.motion.script.repeat, 5);
  EXPECT_EQ(scene.motion.script.closure, 0.75);
  EXPECT_EQ(scene.motion.script.digit_closure, (std::array<double, kDigits>{0.5, 1.5, 2.5, 3.5, 4.5}));
  EXPECT_EQ(scene.motion.trial, 9);
  EXPECT_EQ(scene.parameters.force.damping, 3.25);
  EXPECT_EQ(scene.parameters.force.velocity_lowpass_hz, 40.0);
  EXPECT_EQ(scene.parameters.force.hunt_crossley_exponent, 1.25);
  EXPECT_EQ(scene.parameters.force.hunt_crossley_damping, 2.25);
  EXPECT_DOUBLE_EQ(scene.parameters.force.linear_depth, 8e-3);
  EXPECT_EQ(scene.parameters.stabiliser.min_rate, -30.0);
  EXPECT_EQ(scene.parameters.stabiliser.max_rate, 50.0);
  EXPECT_EQ(scene.parameters.limits.fingertip_force, 4.5);
  EXPECT_EQ(scene.parameters.limits.joint_torque, 0.25);
  EXPECT_EQ(scene.parameters.limits.torque_rate, 8.5);
  EXPECT_EQ(scene.parameters.limits.joint_speed, 35.0);
}

TEST(Scene, KeepsEachSizeOfAnObjectInItsOwnPlace) {
  const auto object = [](const std::string& keys) { return parse("[[objects]]\n" + keys).objects.at(0); };
  const ObjectDescription key = object("kind = \"key\"\nlength_mm = 51\nbreadth_mm = 21\nthickness_mm = 3");
  EXPECT_DOUBLE_EQ(key.length, 0.051);
  EXPECT_DOUBLE_EQ(key.breadth, 0.021);
  EXPECT_DOUBLE_EQ(key.thickness, 0.003);
  const ObjectDescription ball = object("kind = \"therapy_ball\"\ndiameter_mm = 66\nbump_mm = 5");
  EXPECT_DOUBLE_EQ(ball.diameter, 0.066);
  EXPECT_DOUBLE_EQ(ball.bump, 0.005);
  EXPECT_DOUBLE_EQ(object("kind = \"peg\"\nhead_diameter_mm = 31").head_diameter, 0.031);
  EXPECT_DOUBLE_EQ(object("kind = \"jar\"\nlid_diameter_mm = 76").lid_diameter, 0.076);
  const ObjectDescription torus = object("kind = \"torus\"\nring_diameter_mm = 91\ntube_diameter_mm = 16");
  EXPECT_DOUBLE_EQ(torus.ring_diameter, 0.091);
  EXPECT_DOUBLE_EQ(torus.tube_diameter, 0.016);
  const ObjectDescription box = object("kind = \"box\"\nextent_mm = [41, 42, 43]\ntriangles = 99");
  EXPECT_TRUE(box.extent.isApprox(Vec3(0.041, 0.042, 0.043), 1e-15));
  EXPECT_EQ(box.triangles, 99);
  const ObjectDescription file =
      object("kind = \"file\"\nfile = \"m.obj\"\nsize_mm = 0\nunit = \"in\"\ndecimate_to = 77");
  EXPECT_EQ(file.size, 0.0);
  EXPECT_EQ(file.unit, 0.0254);
  EXPECT_EQ(file.decimate_to, 77);
}

// The table of docs/scenes.md: diameter and length [mm] of what has sizes of its own.
TEST(Scene, OfAnObjectWithoutSizesHasThoseOfItsKind) {
  struct KindSizes {
    const char* kind;
    double diameter, length;
  };
  for (const KindSizes& sizes : {KindSizes{"bottle", 65, 205},
                                 {"cup", 75, 90},
                                 {"pen", 10, 140},
                                 {"peg", 9, 32},
                                 {"jar", 80, 110},
                                 {"tap_handle", 60, 50}}) {
    const ObjectDescription object =
        parse("[[objects]]\nkind = \"" + std::string(sizes.kind) + "\"").objects.at(0);
    EXPECT_DOUBLE_EQ(object.diameter, 1e-3 * sizes.diameter) << sizes.kind;
    EXPECT_DOUBLE_EQ(object.length, 1e-3 * sizes.length) << sizes.kind;
  }
  EXPECT_DOUBLE_EQ(parse("[[objects]]\nkind = \"therapy_ball\"").objects.at(0).diameter, 0.07);
  EXPECT_DOUBLE_EQ(parse("[[objects]]\nkind = \"key\"").objects.at(0).length, 0.057);
  EXPECT_TRUE(parse("[[objects]]\nkind = \"putty_bar\"")
                  .objects.at(0)
                  .extent.isApprox(Vec3(0.1, 0.035, 0.03), 1e-15));
}

// Rz(90) Ry(90) Rx(90): x goes by Rx to x, by Ry to -z, by Rz to -z; y goes to z, to x, to y.
TEST(Scene, TurnsByRollThenPitchThenYaw) {
  const SceneDescription scene = parse("hand.rotation_deg = [90, 90, 90]");
  const Mat3& R = scene.hand.pose.R;
  EXPECT_TRUE((R * Vec3::UnitX()).isApprox(-Vec3::UnitZ(), 1e-12));
  EXPECT_TRUE((R * Vec3::UnitY()).isApprox(Vec3::UnitY(), 1e-12));
}

TEST(Scene, ReadsEveryChoice) {
  const SceneDescription scene = parse(R"(
    hand.side = "left"
    gdp.method = "trajectory"
    force.law = "linear_then_cubic"
    force.depth = "s1"
    force.normal = "contact")");
  EXPECT_EQ(scene.hand.handedness, Handedness::kLeft);
  EXPECT_EQ(scene.parameters.contact.method, GdpMethod::kTrajectory);
  EXPECT_EQ(scene.parameters.force.law, ForceLaw::kLinearThenCubic);
  EXPECT_EQ(scene.parameters.contact.depth, DepthOrigin::kS1);
  EXPECT_EQ(scene.parameters.contact.normal, ForceNormal::kContact);
  EXPECT_EQ(parse("force.law = \"kelvin_voigt\"").parameters.force.law, ForceLaw::kKelvinVoigt);
  EXPECT_EQ(parse("force.law = \"hunt_crossley\"").parameters.force.law, ForceLaw::kHuntCrossley);
  EXPECT_EQ(parse("force.law = \"duffing\"").parameters.force.law, ForceLaw::kDuffing);
}

// S2: [-0.05, 0.05] N a step; at 400 Hz that is 20 N/s.
TEST(Scene, TurnsSmoothingBoundsPerStepIntoBoundsPerSecond) {
  const SceneDescription scene = parse("smoothing.max_n = 0.05\nsmoothing.min_n = -0.1\nrate_hz = 400");
  EXPECT_DOUBLE_EQ(scene.parameters.stabiliser.max_rate, 20.0);
  EXPECT_DOUBLE_EQ(scene.parameters.stabiliser.min_rate, -40.0);
}

TEST(Scene, AllowsRiseOnlySmoothing) {
  const double minus_infinity = -std::numeric_limits<double>::infinity();
  EXPECT_EQ(parse("smoothing.min_n = -inf").parameters.stabiliser.min_rate, minus_infinity);
  EXPECT_EQ(parse("smoothing.min_n_per_s = -inf").parameters.stabiliser.min_rate, minus_infinity);
}

TEST(Scene, TurnsALimitOffOnlyByName) {
  const SceneDescription scene = parse("limits.torque_rate_nm_per_s = \"off\"");
  EXPECT_FALSE(scene.parameters.limits.torque_rate_enabled);
  EXPECT_TRUE(scene.parameters.limits.fingertip_force_enabled);
  EXPECT_TRUE(scene.parameters.limits.joint_torque_enabled);
  EXPECT_FALSE(parse("limits.fingertip_force_n = \"off\"").parameters.limits.fingertip_force_enabled);
  EXPECT_FALSE(parse("limits.joint_torque_nm = \"off\"").parameters.limits.joint_torque_enabled);
  EXPECT_TRUE(std::isinf(parse("limits.joint_speed_rad_per_s = \"off\"").parameters.limits.joint_speed));
}

TEST(Scene, ResolvesFilesAgainstItsOwnFolder) {
  const SceneDescription scene = parse(R"(
    motion.file = "a/b.csv"
    motion.mapping = "cyberglove"
    hand.file = "hands/me.toml"
    [[objects]]
    kind = "file"
    file = "mesh.obj")");
  EXPECT_EQ(scene.motion.file, "/somewhere/a/b.csv");
  EXPECT_EQ(scene.motion.mapping, "cyberglove") << "a bare name is no path";
  EXPECT_EQ(scene.hand.file, "/somewhere/hands/me.toml");
  EXPECT_EQ(scene.objects[0].file, "/somewhere/mesh.obj");
}

TEST(Scene, GivesItsSeedToTheTremor) { EXPECT_EQ(parse("seed = 7").motion.script.seed, 7U); }

}  // namespace
}  // namespace phalanx
