// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/build_model.h"

#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <stdexcept>

#include "phalanx/core/constants.h"
#include "phalanx/hand/hand_meshes.h"
#include "phalanx/mesh/import.h"
#include "phalanx/mesh/primitives.h"
#include "phalanx/scene/device_file.h"
#include "phalanx/scene/resolved_scene.h"
#include "phalanx/scene/scene_file.h"
#include "record/temporary_folder.h"
#include "scene/expect_error.h"
#include "support/opened_files.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

SceneDescription parse_objects(const std::string& text) {
  return parse_scene(text, "test.toml", PHALANX_SOURCE_DIR);
}

Vec3 extent(const TriangleMesh& mesh) {
  const Bounds box = bounds(mesh);
  return box.max - box.min;
}

TEST(BuildModel, MakesEveryKindInItsSize) {
  const auto size = [](const std::string& keys) {
    return extent(make_world_mesh(parse_objects("[[objects]]\n" + keys)));
  };
  EXPECT_NEAR(size("kind = \"teapot\"\nsize_mm = 110").x(), 0.110, 1e-9);
  EXPECT_NEAR(size("kind = \"sphere\"\ndiameter_mm = 40").z(), 0.040, 1e-9);
  EXPECT_TRUE(size("kind = \"box\"\nextent_mm = [10, 20, 30]").isApprox(Vec3(0.01, 0.02, 0.03), 1e-12));
  EXPECT_NEAR(size("kind = \"cylinder\"\nlength_mm = 70").z(), 0.070, 1e-9);
  EXPECT_NEAR(size("kind = \"torus\"\nring_diameter_mm = 80\ntube_diameter_mm = 20\ntriangles = 5000").x(),
              0.100, 1e-4);
  EXPECT_NEAR(size("kind = \"mug\"\nlength_mm = 95").z(), 0.095, 1e-9);
}

TEST(BuildModel, GivesEachObjectItsFriction) {
  const std::string box = "[[objects]]\nkind = \"box\"\ntriangles = 12\nposition_mm = [0, -300, 0]\n";
  const HapticModel model =
      build_model(parse_objects(box + "friction = 0.2\n" + box + box + "friction = 0\n"));
  const int triangles = model.object.triangle_count() / 3;
  ASSERT_EQ(3 * triangles, model.object.triangle_count());
  for (int i = 0; i < triangles; ++i) {
    EXPECT_EQ(model.object.friction(i, 0.7), 0.2);
    EXPECT_EQ(model.object.friction(triangles + i, 0.7), 0.7) << "not stated";
    EXPECT_EQ(model.object.friction(2 * triangles + i, 0.7), 0.0);
  }
  expect_scene_error([&] { static_cast<void>(parse_objects(box + "friction = 2.1\n")); },
                     {"objects.0.friction", "2.1", "2"});
}

TEST(BuildModel, RefusesMoreTrianglesThanOneSceneMayHave) {
  const std::string large = "[[objects]]\nkind = \"sphere\"\ntriangles = 2000000\n";
  expect_scene_error([&] { static_cast<void>(make_world_mesh(parse_objects(large + large + large))); },
                     {"objects[2]", "6000000", "4000000", "decimate_to"});
}

// Two spheres of 2,000,000 triangles reach the limit. The file's 12 triangles are counted when it is read,
// before any sphere is made.
TEST(BuildModel, CountsAFilesTrianglesWhenItIsRead) {
  const testing::TemporaryFolder folder;
  const fs::path file = folder / "box.obj";
  write_obj(make_box({1.0, 2.0, 4.0}, 12), file, "box");
  const std::string sphere = "[[objects]]\nkind = \"sphere\"\ntriangles = 2000000\n";
  const SceneDescription scene = parse_objects("[[objects]]\nkind = \"file\"\nsize_mm = 80\nfile = \"" +
                                               file.string() + "\"\n" + sphere + sphere);
  expect_scene_error([&] { static_cast<void>(make_world_mesh(scene)); },
                     {"objects[0]: with its 12 triangles", "4000012"});
}

TEST(BuildModel, ImportsAFileInItsSize) {
  const fs::path file =
      fs::temp_directory_path() / ("phalanx_build_model_" + std::to_string(getpid()) + ".obj");
  write_obj(make_box({1.0, 2.0, 4.0}, 12), file, "box");
  const SceneDescription scene =
      parse_objects("[[objects]]\nkind = \"file\"\nsize_mm = 80\nfile = \"" + file.string() + "\"");
  EXPECT_TRUE(extent(make_world_mesh(scene)).isApprox(Vec3(0.02, 0.04, 0.08), 1e-9));
  fs::remove(file);
}

TEST(BuildModel, ImportsAFileInTheUnitOrRefusesItsSizeWithTheRemedy) {
  const fs::path file = fs::temp_directory_path() / ("phalanx_unit_" + std::to_string(getpid()) + ".obj");
  write_obj(make_box({20, 40, 80}, 1200), file, "box");
  const std::string object = "[[objects]]\nkind = \"file\"\nfile = \"" + file.string() + "\"\nsize_mm = 0\n";
  EXPECT_TRUE(extent(make_world_mesh(parse_objects(object + "unit = \"mm\"")))
                  .isApprox(Vec3(0.02, 0.04, 0.08), 1e-9));
  EXPECT_LE(make_world_mesh(parse_objects(object + "unit = \"mm\"\ndecimate_to = 100")).triangles.size(),
            100U);
  try {
    static_cast<void>(make_world_mesh(parse_objects(object)));
    ADD_FAILURE() << "80 m wide";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(),
                ::testing::AllOf(::testing::HasSubstr(file.string()), ::testing::HasSubstr("80 m wide"),
                                 ::testing::HasSubstr("\"mm\"")));
  }
  try {
    static_cast<void>(parse_objects("[[objects]]\nkind = \"file\"\nfile = \"" + file.string() +
                                    "\"\nsize_mm = 90\nunit = \"mm\""));
    ADD_FAILURE() << "a size and a unit";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("size_mm = 0"));
  }
  fs::remove(file);
}

TEST(BuildModel, NamesAMeshFileThatIsMissing) {
  const SceneDescription scene = parse_objects("[[objects]]\nkind = \"file\"\nfile = \"none.obj\"");
  try {
    static_cast<void>(build_model(scene));
    ADD_FAILURE() << "built";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("none.obj"));
  }
}

TEST(BuildModel, PutsObjectsWhereTheSceneSays) {
  const SceneDescription scene = parse_objects(R"(
    [[objects]]
    kind = "box"
    extent_mm = [10, 20, 30]
    position_mm = [100, 0, 0]
    rotation_deg = [0, 0, 90]
    [[objects]]
    kind = "sphere"
    diameter_mm = 2
    position_mm = [0, 0, 500])");
  const Bounds box = bounds(make_world_mesh(scene));
  EXPECT_NEAR(box.max.x(), 0.110, 1e-12) << "the box's y edge of 20 mm, turned to x";
  EXPECT_NEAR(box.max.z(), 0.501, 1e-12);
}

TEST(BuildModel, HasTheScenesHandAndObjectsBesideItsParameters) {
  const SceneDescription scene = parse_objects(R"(
    rate_hz = 500
    hand.side = "left"
    hand.position_mm = [0, 0, 7]
    force.stiffness_n_per_mm = 0.9
    limits.joint_torque_nm = 0.25
    stabiliser.method = "none"
    contact.margin_mm = 0.1
    [[objects]]
    kind = "sphere"
    position_mm = [0, 0, 900])");
  const HapticModel model = build_model(scene);
  EXPECT_EQ(scene.parameters.rate_hz, 500.0);
  EXPECT_EQ(model.hand.handedness(), Handedness::kLeft);
  EXPECT_EQ(model.hand.palm_pose().p, Vec3(0, 0, 0.007));
  EXPECT_DOUBLE_EQ(scene.parameters.force.stiffness, 900.0);
  EXPECT_EQ(scene.parameters.limits.joint_torque, 0.25);
  EXPECT_EQ(scene.parameters.stabiliser.method, Stabiliser::kNone);
  EXPECT_DOUBLE_EQ(scene.parameters.contact.margin, 1e-4);
  EXPECT_GT(model.object.triangle_count(), 500);
}

TEST(BuildModel, WorksWithoutAnyObject) {
  EXPECT_EQ(build_model(parse_objects("")).object.triangle_count(), 0);
}

TEST(BuildMotion, PlaysTheScriptUnlessThereIsAFile) {
  const SceneDescription script = parse_objects("motion.name = \"press\"\nmotion.hold_s = 2");
  EXPECT_DOUBLE_EQ(build_motion(script).duration(), 4.2);
  EXPECT_EQ(simulation_seconds(script, build_motion(script)), build_motion(script).duration());
  const SceneDescription file = parse_objects(R"(
    seconds = 0.5
    [motion]
    file = "assets/motions/glove_two_trials.csv"
    mapping = "cyberglove"
    trial = 1)");
  EXPECT_NEAR(build_motion(file).duration(), 1.5, 1e-3);
  EXPECT_EQ(simulation_seconds(file, build_motion(file)), 0.5);
}

TEST(BuildMotion, NamesAMotionFileThatIsMissing) {
  expect_scene_error([] { static_cast<void>(build_motion(parse_objects("motion.file = \"none.csv\""))); },
                     {"none.csv", "there is no file"});
}

/// The last tick of half the scene's motion.
Snapshot half_way(const SceneDescription& scene) {
  const auto model = std::make_unique<HapticModel>(build_model(scene));
  const Motion motion = build_motion(scene);
  HapticState state(*model, scene.parameters);
  const int ticks = static_cast<int>(0.5 * motion.duration() * scene.parameters.rate_hz);
  for (int n = 0; n <= ticks; ++n) {
    const double t = n / scene.parameters.rate_hz;
    step(*model, scene.parameters, Sample{t, motion.at(t)}, state);
  }
  return state.snapshot();
}

// Whoever grasps with the left hand what stands mirrored feels the same. The search meets the triangles in
// another order, so that sums differ in their last digits.
TEST(BuildModel, MirrorsHandAndObjectsTogether) {
  const Snapshot right = half_way(load_scene("grasp_mug"));
  const SceneDescription scene = load_scene("grasp_mug", {{"mirror", "true"}});
  EXPECT_EQ(scene.hand.handedness, Handedness::kLeft);
  const Snapshot left = half_way(scene);
  int contacts = 0;
  for (std::size_t s = 0; s < kSegments; ++s) {
    contacts += right.segment[s].contact ? 1 : 0;
    EXPECT_EQ(left.segment[s].contact, right.segment[s].contact);
    EXPECT_NEAR(left.segment[s].force, right.segment[s].force, 1e-6);
    const Vec3 mirrored(-right.segment[s].normal.x(), right.segment[s].normal.y(),
                        right.segment[s].normal.z());
    EXPECT_LT((left.segment[s].normal - mirrored).norm(), 1e-6) << segment_name(static_cast<int>(s));
  }
  EXPECT_GE(contacts, 3);
}

// In the mirror x = 0 a turn about x stays, and one about y or z goes the other way round.
TEST(BuildModel, MirrorsTheHandsPose) {
  struct Turn {
    const char* degrees;
    Vec3 axis;
    double angle;  ///< in the mirror [deg]
  };
  for (const Turn& turn : {Turn{"[30, 0, 0]", Vec3::UnitX(), 30.0}, Turn{"[0, 30, 0]", Vec3::UnitY(), -30.0},
                           Turn{"[0, 0, 30]", Vec3::UnitZ(), -30.0}}) {
    const SceneDescription scene = parse_objects(
        std::string("mirror = true\n[hand]\nmeshes = \"capsules\"\nposition_mm = [10, 20, 30]\n") +
        "rotation_deg = " + turn.degrees);
    const Pose pose = build_model(scene).hand.palm_pose();
    EXPECT_LT((pose.p - Vec3(-0.01, 0.02, 0.03)).norm(), 1e-15);
    EXPECT_LT((pose.R - rotation_about(turn.axis, turn.angle * kDeg)).norm(), 1e-14) << turn.degrees;
  }
}

TEST(BuildModel, MirrorsTheSceneForTheProfileOfALeftHand) {
  const SceneDescription scene =
      load_scene("grasp_mug", {{"hand.profile", "large-man"}, {"grasp.type", "none"}});
  const HapticModel model = build_model(scene);
  EXPECT_EQ(model.hand.handedness(), Handedness::kLeft);
  EXPECT_EQ(model.hand.palm_pose().p.x(), -scene.hand.pose.p.x());
  TriangleMesh expected = make_world_mesh(load_scene("grasp_mug"));
  mirror(expected);
  EXPECT_EQ(model.object.mesh().vertices, expected.vertices);
  EXPECT_EQ(model.object.mesh().triangles, expected.triangles);
}

TEST(Resolve, OpensEachFileOnceAndWhatIsMadeOfItNone) {
  const testing::TemporaryFolder folder;
  const SceneFile file(test::write_first_touch(folder.path()));
  std::ofstream(folder / "profile.toml") << "name = \"own\"\nhand = \"hand.toml\"\nhandedness = \"left\"\n";
  const test::OpenedFiles opened(folder.path());
  SceneDescription scene = file.scene({});
  EXPECT_THAT(opened.take(), ::testing::IsEmpty());
  scene.hand.profile = folder / "profile.toml";
  const ResolvedScene resolved = resolve(scene, {.hand = HandDetail::kAll, .device = true, .motion = true});
  const std::map<std::string, int> once = {
      {"device.toml", 1}, {"hand.toml", 1}, {"patient.toml", 1}, {"profile.toml", 1}};
  EXPECT_EQ(opened.take(), once);
  EXPECT_EQ(build_model(resolved).hand.handedness(), Handedness::kLeft);
  EXPECT_THAT(opened.take(), ::testing::IsEmpty());
  EXPECT_EQ(resolved.exoskeleton->motors.size(), load_device(scene).motors.size());
  EXPECT_EQ(resolved.motion->duration(), build_motion(scene).duration());
}

TEST(Resolve, ReadsOnlyWhatIsAskedFor) {
  SceneDescription scene = parse_objects("hand.meshes = \"capsules\"");
  scene.device.file = "none";
  scene.motion.file = "none.csv";
  EXPECT_FALSE(resolve(scene, {}).motion.has_value());
  EXPECT_THROW(static_cast<void>(resolve(scene, {.device = true})), SceneError);
  EXPECT_THROW(static_cast<void>(resolve(scene, {.motion = true})), std::invalid_argument);
}

}  // namespace
}  // namespace phalanx
