// SPDX-License-Identifier: Apache-2.0
#include "phalanx/study/picture.h"

#include <gmock/gmock.h>
#include <png.h>

#include "phalanx/mesh/primitives.h"
#include "phalanx/scene/hand_file.h"
#include "record/temporary_folder.h"
#include "study/picture/render_mesh.h"

namespace phalanx {
namespace {

using testing::TemporaryFolder;

/// The open hand over a ball that the index finger's tip touches from above with 2 N.
struct Scene {
  Scene() : hand(make_hand_model(load_hand_file("adult"), Handedness::kRight, {}, 1000)) {
    HandPoses poses;
    hand.poses(hand.parameters().open_angle, poses);
    for (int s = 0; s < kPalm; ++s) {
      const Pose& X = poses.digit[static_cast<std::size_t>(digit_of_segment(s))]
                          .segment[static_cast<std::size_t>(s % kSegmentsPerDigit)];
      snapshot.gdp_pose[static_cast<std::size_t>(s)] = snapshot.hcp_pose[static_cast<std::size_t>(s)] = X;
    }
    const std::size_t tip = 5;
    const Vec3 below = snapshot.gdp_pose[tip].p - 0.04 * Vec3::UnitY();
    append(object, make_sphere(0.05, 500), Pose{Mat3::Identity(), below});
    snapshot.segment[tip] = {.contact = true,
                             .depth = 4e-3,
                             .force_raw = 2.0,
                             .force = 2.0,
                             .point = below + 0.025 * Vec3::UnitY(),
                             .normal = Vec3::UnitY()};
    snapshot.hcp_pose[tip].p -= 4e-3 * Vec3::UnitY();
  }
  HandModel hand;
  TriangleMesh object;
  Snapshot snapshot;
};

constexpr PictureOptions kSmall{.width = 160, .height = 120, .samples = 2};

/// Pixels for which `is` holds.
template <class Is>
int count(const Image& image, Is is) {
  int n = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3)
    n += is(image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]) ? 1 : 0;
  return n;
}
bool teal(int r, int g, int b) { return r + 25 < g && r + 25 < b && b < g + 30; }
bool bone(int r, int g, int b) { return r > g && g > b && r > b + 8 && r < b + 60; }
bool hot(int r, int g, int b) { return r > g + 60 && r > b + 60; }

TEST(Picture, ShowsHandObjectAndForce) {
  const Scene scene;
  const Image image = render_picture(scene.hand.meshes(), scene.object, scene.snapshot, kSmall);
  ASSERT_EQ(image.rgb.size(), 160U * 120U * 3U);
  EXPECT_GT(count(image, teal), 100);
  EXPECT_GT(count(image, bone), 500);
  EXPECT_GT(count(image, hot), 20);
}

TEST(Picture, OfNoObjectShowsTheHandAlone) {
  Scene scene;
  scene.snapshot.segment = {};
  scene.snapshot.hcp_pose = scene.snapshot.gdp_pose;
  const Image image = render_picture(scene.hand.meshes(), {}, scene.snapshot, kSmall);
  EXPECT_EQ(count(image, teal), 0);
  EXPECT_EQ(count(image, hot), 0);
  EXPECT_GT(count(image, bone), 500);
}

TEST(Picture, IsTheSameEveryTime) {
  const Scene scene;
  EXPECT_EQ(render_picture(scene.hand.meshes(), scene.object, scene.snapshot, kSmall).rgb,
            render_picture(scene.hand.meshes(), scene.object, scene.snapshot, kSmall).rgb);
}

TEST(Picture, IsWrittenAsAPngThatReadsBack) {
  Image image{.width = 16, .height = 17, .rgb = {}};
  for (int i = 0; i < 16 * 17 * 3; ++i) image.rgb.push_back(static_cast<std::uint8_t>(i % 251));
  const TemporaryFolder folder;
  const auto file = folder / "a.png";
  write_png(image, file);
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&png, file.c_str()), 0) << png.message;
  EXPECT_EQ(png.width, 16U);
  EXPECT_EQ(png.height, 17U);
  png.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(png));
  ASSERT_NE(png_image_finish_read(&png, nullptr, rgb.data(), 0, nullptr), 0) << png.message;
  EXPECT_EQ(rgb, image.rgb);
}

TEST(Picture, SaysWhichFileCannotBeWritten) {
  const Image image{.width = 1, .height = 1, .rgb = {0, 0, 0}};
  try {
    write_png(image, "/no/such/folder/a.png");
    FAIL() << "written";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("/no/such/folder/a.png"));
  }
}

TEST(Picture, RefusesASizeThatMakesNoSense) {
  const Scene scene;
  EXPECT_THROW((void)render_picture(scene.hand.meshes(), scene.object, scene.snapshot, {.width = 0}),
               std::invalid_argument);
  EXPECT_THROW((void)render_picture(scene.hand.meshes(), scene.object, scene.snapshot, {.samples = 0}),
               std::invalid_argument);
}

// A sphere's patches come nearer to the sphere than its flat triangles do; their corners stay.
TEST(AppendCurved, RoundsASphere) {
  const TriangleMesh sphere = make_sphere(2.0, 300);
  picture::RenderMesh flat, curved;
  append_curved(flat, sphere, {}, 0, 1);
  append_curved(curved, sphere, {}, 0, 4);
  EXPECT_EQ(flat.triangles.size(), sphere.triangles.size());
  EXPECT_EQ(curved.triangles.size(), 16 * sphere.triangles.size());
  const auto worst = [](const picture::RenderMesh& mesh) {
    float error = 0.0F;
    for (const auto& t : mesh.triangles) {
      const picture::Vec3f centre = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0F;
      error = std::max(error, std::abs(centre.norm() - 1.0F));
    }
    return error;
  };
  EXPECT_LT(worst(curved), 0.25F * worst(flat));
}

// A box has creases only: nothing bulges.
TEST(AppendCurved, KeepsABoxABox) {
  picture::RenderMesh mesh;
  append_curved(mesh, make_box(Vec3(2, 2, 2), 12), {}, 0, 4);
  for (const auto& v : mesh.vertices) EXPECT_NEAR(v.cwiseAbs().maxCoeff(), 1.0F, 1e-6F);
}

}  // namespace
}  // namespace phalanx
